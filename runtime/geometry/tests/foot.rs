//! The short way to a surface point is the long way's point and normal, whatever the map.

use arsc_geometry::{DAffine3, DMat3, DVec3, Placed, Shape};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn vector(rng: &mut Pcg64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)))
}

#[test]
fn foot_is_surface() {
    let mut rng = Pcg64::seed_from_u64(5);
    let shapes = [
        Shape::Sphere { radius: 0.7 },
        Shape::Box { min: DVec3::NEG_ONE, max: DVec3::new(0.5, 1.0, 2.0) },
        Shape::Cylinder { radius: 0.4, height: 1.2 },
        Shape::InfiniteCylinder { radius: 0.5 },
        Shape::Cone { base_radius: 1.0, top_radius: 0.3, height: 1.5 },
        Shape::Torus { major: 1.0, minor: 0.3 },
        Shape::Torus { major: 0.5, minor: 0.8 },
        Shape::HalfSpace,
    ];
    let mut compared = 0;
    for shape in &shapes {
        for kind in 0..30 {
            let turn = DMat3::from_axis_angle(vector(&mut rng).normalize(), rng.random_range(0.0..6.0));
            let matrix = match kind % 3 {
                0 => DMat3::from_diagonal(DVec3::splat(2.0)),
                1 => turn * DMat3::from_diagonal(DVec3::splat(0.01)),
                _ => turn * DMat3::from_diagonal(DVec3::new(-1.0, 0.4, 1.7)),
            };
            let placed =
                Placed::new(shape.clone(), DAffine3 { matrix3: matrix, translation: vector(&mut rng) }).unwrap();
            for _ in 0..100 {
                let origin = vector(&mut rng) * 3.0;
                let inside = placed.world_from_object().transform_point3(vector(&mut rng) * 0.9);
                let dir = (inside - origin).normalize();
                for (t, face) in placed.crossings(origin, dir).iter().filter(|(t, _)| t.abs() < 100.0) {
                    let p = origin + dir * t;
                    let (long, short) = (placed.surface(p, face), placed.foot(p, face));
                    assert!((long.p - short.p).length() <= long.p_error, "{shape:?}: {} {}", long.p, short.p);
                    assert!((long.n - short.n).length() < 1e-12, "{shape:?}: {} {}", long.n, short.n);
                    assert!((short.n.length() - 1.0).abs() < 1e-14);
                    assert!(short.p_error <= 1.001 * long.p_error && short.p_error >= 0.999 * long.p_error);
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 20_000, "only {compared}");
}
