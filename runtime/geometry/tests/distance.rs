//! Distance functions: the sign is membership, and they change no faster than the point moves.

use arsc_geometry::{DVec3, Shape};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

#[test]
fn distances_bound_the_way_to_the_surface() {
    let mut rng = Pcg64::seed_from_u64(6);
    let mut point = |reach: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-reach..reach)));
    for (major, minor) in [(1.0, 0.06), (1.0, 0.9), (1.0, 1.0), (0.6, 1.1)] {
        let shape = Shape::Torus { major, minor };
        let mut inside = 0;
        for _ in 0..20_000 {
            let (p, step) = (point(2.0), point(0.3));
            let (a, b) = (shape.distance(p).unwrap(), shape.distance(p + step).unwrap());
            assert!((a - b).abs() <= step.length() * (1.0 + 1e-12) + 1e-15, "{shape:?} at {p}: {a}, {b}");
            assert_eq!(a <= 0.0, shape.contains(p), "{shape:?} at {p}");
            inside += u32::from(a <= 0.0);
        }
        assert!(inside > 10, "{shape:?}: {inside}");
    }
}
