//! Small scenes with answers known by hand.

use std::f64::consts::PI;
use std::sync::Arc;

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, Instance, MaterialIndex, PartId, Ray, Scene, SceneGeometry, Shape, Solid, Strategy,
    Surface, SurfaceShape,
};
use glam::{DAffine3, DVec2, DVec3};

fn leaf(shape: Shape, at: DVec3, material: u32) -> CsgLeaf {
    CsgLeaf { shape, world_from_object: DAffine3::from_translation(at), material: MaterialIndex(material) }
}

fn sphere(at: DVec3, radius: f64, material: u32) -> CsgLeaf {
    leaf(Shape::Sphere { radius }, at, material)
}

fn cube(min: DVec3, max: DVec3, material: u32) -> CsgLeaf {
    leaf(Shape::Box { min, max }, DVec3::ZERO, material)
}

fn minus(a: Csg, b: Csg) -> Csg {
    Csg::Difference(Box::new(a), Box::new(b))
}

/// The scene under every strategy.
fn scenes(geometry: SceneGeometry) -> Vec<Scene> {
    let build = |strategy: &Strategy| Scene::build(geometry.clone(), BuildOptions::from(*strategy)).unwrap();
    Strategy::ALL.iter().chain(&[Strategy::Oracle]).map(build).collect()
}

fn solid(tree: Csg, leaves: Vec<CsgLeaf>) -> SceneGeometry {
    SceneGeometry { solids: vec![Solid { tree, leaves }], ..SceneGeometry::default() }
}

fn close(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-12
}

#[test]
fn sphere_is_hit_from_outside_and_inside() {
    for scene in scenes(solid(Csg::Leaf(0), vec![sphere(DVec3::ZERO, 1.0, 7)])) {
        let hit = scene.intersect(&Ray::new(DVec3::new(-3.0, 0.0, 0.0), DVec3::X)).unwrap();
        assert!((hit.t - 2.0).abs() < 1e-14 && close(hit.p, DVec3::NEG_X) && close(hit.ng, DVec3::NEG_X));
        assert_eq!((hit.material, hit.part, hit.closed), (MaterialIndex(7), PartId(0), true));
        let out = scene.intersect(&hit.spawn(DVec3::X)).unwrap();
        assert!((out.t - 2.0).abs() < 1e-9 && close(out.ng, DVec3::X));
        assert!(scene.intersect(&hit.spawn(DVec3::NEG_X)).is_none());
        assert!(!scene.occluded(&Ray { origin: DVec3::ZERO, dir: DVec3::Z, t_max: 0.99 }));
        assert!(scene.occluded(&Ray { origin: DVec3::ZERO, dir: DVec3::Z, t_max: 1.01 }));
    }
}

/// Operands that the tree does not use, and trees that are nothing or everything.
#[test]
fn constant_trees_meet_nothing() {
    let leaves = vec![sphere(DVec3::ZERO, 1.0, 0), sphere(DVec3::X, 1.0, 1)];
    let everything = || Csg::Intersection(vec![]);
    let trees = [
        Csg::Union(vec![]),
        everything(),
        minus(Csg::Union(vec![]), Csg::Leaf(0)),
        Csg::Union(vec![everything(), Csg::Leaf(1)]),
    ];
    let ray = Ray::new(DVec3::new(-3.0, 0.0, 0.0), DVec3::X);
    for tree in trees {
        for scene in scenes(solid(tree.clone(), leaves.clone())) {
            assert!(scene.intersect(&ray).is_none() && !scene.occluded(&ray), "{tree:?}");
        }
    }
    for scene in scenes(solid(minus(everything(), Csg::Leaf(0)), leaves)) {
        let hit = scene.intersect(&ray).expect("the void");
        assert!((hit.t - 2.0).abs() < 1e-14 && close(hit.ng, DVec3::X), "{hit:?}");
        assert_eq!(scene.intervals(&ray).len(), 2);
    }
}

/// No cut separates the shells, so one cell holds hundreds of leaves, all of which a ray from within crosses.
#[test]
fn many_crossings_in_one_cell() {
    const N: u32 = 400;
    let shells: Vec<CsgLeaf> = (0..N).map(|i| sphere(DVec3::ZERO, 10.0 + 1e-4 * f64::from(i), i)).collect();
    let mut leaves = shells.clone();
    leaves.push(sphere(DVec3::ZERO, 9.0, N));
    let all = Csg::Union((0..N).map(Csg::Leaf).collect());
    let none = Csg::Intersection((0..N).map(Csg::Leaf).collect());
    let outermost = 10.0 + 1e-4 * f64::from(N - 1);
    for (tree, t, material) in [(all.clone(), outermost, N - 1), (none, 10.0, 0), (minus(all, Csg::Leaf(N)), 9.0, N)] {
        for scene in scenes(solid(tree, leaves.clone())) {
            for dir in [DVec3::X, DVec3::new(1.0, 2.0, -2.0) / 3.0] {
                let ray = Ray { origin: DVec3::ZERO, dir, t_max: f64::INFINITY };
                let hit = scene.intersect(&ray).expect("the way out");
                assert!((hit.t - t).abs() < 1e-9 && hit.material.0 == material, "{} {:?}", hit.t, hit.material);
            }
        }
    }
}

#[test]
fn walls_show_the_subtrahend_and_face_outwards() {
    let leaves = vec![sphere(DVec3::ZERO, 1.0, 0), sphere(DVec3::new(-1.0, 0.0, 0.0), 0.5, 1)];
    for scene in scenes(solid(minus(Csg::Leaf(0), Csg::Leaf(1)), leaves)) {
        let ray = Ray::new(DVec3::new(-3.0, 0.0, 0.0), DVec3::X);
        let hit = scene.intersect(&ray).unwrap();
        assert!((hit.t - 2.5).abs() < 1e-14 && close(hit.ng, DVec3::NEG_X));
        assert_eq!((hit.material, hit.part), (MaterialIndex(1), PartId(1)));
        let intervals = scene.intervals(&ray);
        assert_eq!(intervals.len(), 1);
        assert!((intervals[0].t_enter - 2.5).abs() < 1e-14 && (intervals[0].t_exit - 4.0).abs() < 1e-14);
        assert_eq!(intervals[0].enter.map(|hit| hit.part), Some(PartId(1)));
        // From inside: no entry.
        let inside = scene.intervals(&Ray { origin: DVec3::ZERO, dir: DVec3::X, t_max: 0.5 });
        assert_eq!((inside[0].t_enter, inside[0].t_exit), (0.0, 0.5));
        assert!(inside[0].enter.is_none() && inside[0].exit.is_none());
    }
}

#[test]
fn coincident_faces_belong_to_the_first_operand_and_leave_no_skin() {
    let leaves = vec![cube(DVec3::ZERO, DVec3::ONE, 0), cube(DVec3::new(0.2, 0.2, 0.5), DVec3::new(0.8, 0.8, 1.0), 1)];
    for scene in scenes(solid(minus(Csg::Leaf(0), Csg::Leaf(1)), leaves.clone())) {
        let hit = scene.intersect(&Ray::new(DVec3::new(0.5, 0.4, 3.0), DVec3::NEG_Z)).unwrap();
        assert!((hit.p.z - 0.5).abs() < 1e-14, "skin at {}", hit.p);
        assert_eq!(hit.part, PartId(1));
    }
    for scene in scenes(solid(Csg::Union(vec![Csg::Leaf(0), Csg::Leaf(1)]), leaves)) {
        for (origin, dir) in [(DVec3::new(0.5, 0.4, 3.0), DVec3::NEG_Z), (DVec3::new(0.5, 0.4, -3.0), DVec3::Z)] {
            let intervals = scene.intervals(&Ray::new(origin, dir));
            assert_eq!(intervals.len(), 1);
            assert_eq!(intervals[0].enter.map(|hit| hit.part), Some(PartId(0)));
            assert_eq!(intervals[0].exit.map(|hit| hit.part), Some(PartId(0)));
        }
    }
}

#[test]
fn unbounded_solids_are_hit_and_open() {
    let half = leaf(Shape::HalfSpace, DVec3::ZERO, 3);
    let ball = sphere(DVec3::ZERO, 1.0, 4);
    for scene in scenes(solid(minus(Csg::Leaf(0), Csg::Leaf(1)), vec![half, ball])) {
        let down = scene.intersect(&Ray::new(DVec3::new(0.0, 0.0, 5.0), DVec3::NEG_Z)).unwrap();
        assert!((down.t - 6.0).abs() < 1e-13 && close(down.ng, DVec3::Z));
        let far = scene.intersect(&Ray::new(DVec3::new(1e5, 0.0, 5.0), DVec3::NEG_Z)).unwrap();
        assert_eq!((far.t, far.material), (5.0, MaterialIndex(3)));
        let open = scene.intervals(&Ray::new(DVec3::new(0.0, 0.0, 5.0), DVec3::NEG_Z));
        assert_eq!(open.len(), 1);
        assert!(open[0].t_exit.is_infinite() && open[0].exit.is_none());
    }
}

#[test]
fn solids_without_bounded_leaves_are_hit() {
    let half = leaf(Shape::HalfSpace, DVec3::Z, 0);
    let pole = leaf(Shape::InfiniteCylinder { radius: 1.0 }, DVec3::X * 5.0, 1);
    let both = Csg::Union(vec![Csg::Leaf(0), Csg::Leaf(1)]);
    for (tree, parts) in [(Csg::Leaf(0), [Some(0), None]), (Csg::Leaf(1), [None, Some(1)]), (both, [Some(0), Some(1)])]
    {
        for scene in scenes(solid(tree, vec![half.clone(), pole.clone()])) {
            let down = scene.intersect(&Ray::new(DVec3::new(0.0, 0.0, 4.0), DVec3::NEG_Z));
            let across = scene.intersect(&Ray::new(DVec3::new(0.0, 0.0, 4.0), DVec3::X));
            assert_eq!([down, across].map(|hit| hit.map(|hit| hit.part.0)), parts);
            assert!(down.is_none_or(|hit| hit.t == 3.0) && across.is_none_or(|hit| (hit.t - 4.0).abs() < 1e-12));
        }
    }
}

#[test]
fn instances_may_be_empty_or_unbounded() {
    let nothing = Csg::Intersection(vec![Csg::Leaf(0), Csg::Leaf(1)]);
    let empty = Solid { tree: nothing, leaves: vec![sphere(DVec3::ZERO, 1.0, 0), sphere(DVec3::X * 3.0, 1.0, 0)] };
    let half = Solid { tree: Csg::Leaf(0), leaves: vec![leaf(Shape::HalfSpace, DVec3::ZERO, 0)] };
    let place = |solid: &Solid| Instance {
        solid: Arc::new(solid.clone()),
        world_from_object: DAffine3::from_translation(DVec3::Z) * DAffine3::from_scale(DVec3::splat(3.0)),
    };
    let geometry = SceneGeometry { instances: vec![place(&empty), place(&half)], ..SceneGeometry::default() };
    for scene in scenes(geometry) {
        let ray = Ray::new(DVec3::new(0.2, 0.0, 5.0), DVec3::NEG_Z);
        let hit = scene.intersect(&ray).unwrap();
        assert!((hit.t - 4.0).abs() < 1e-14 && close(hit.ng, DVec3::Z) && hit.part == PartId(2));
        let intervals = scene.intervals(&ray);
        assert!(intervals.len() == 1 && intervals[0].solid == 1 && intervals[0].t_exit.is_infinite());
        let within = scene.intervals(&Ray::new(DVec3::NEG_Z, DVec3::X));
        assert!(within.len() == 1 && within[0].enter.is_none() && within[0].exit.is_none());
    }
}

#[test]
fn surfaces_and_mirrored_surfaces_keep_their_side() {
    let mirrored = DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0)) * DAffine3::from_translation(DVec3::Z);
    let quad = SurfaceShape::Quad([DVec3::ZERO, DVec3::X, DVec3::ONE.with_z(0.0), DVec3::Y]);
    for shape in [
        quad,
        SurfaceShape::Rectangle { size: DVec2::splat(4.0) },
        SurfaceShape::Disk { radius: 3.0 },
        SurfaceShape::Plane,
    ] {
        for (map, z, normal) in [(DAffine3::IDENTITY, 0.0, DVec3::Z), (mirrored, -1.0, DVec3::NEG_Z)] {
            let surface = Surface { shape: shape.clone(), world_from_object: map, material: MaterialIndex(5) };
            for scene in scenes(SceneGeometry { surfaces: vec![surface], ..SceneGeometry::default() }) {
                let hit = scene.intersect(&Ray::new(DVec3::new(0.3, 0.4, 2.0), DVec3::NEG_Z)).unwrap();
                assert!((hit.t - (2.0 - z)).abs() < 1e-14 && close(hit.ng, normal), "{shape:?} {hit:?}");
                assert!(!hit.closed);
                assert!(scene.intersect(&hit.spawn(DVec3::Z)).is_none());
                assert!(scene.intervals(&Ray::new(DVec3::new(0.3, 0.4, 2.0), DVec3::NEG_Z)).is_empty());
            }
        }
    }
}

#[test]
fn instances_are_placed_copies() {
    let inner = Arc::new(Solid { tree: Csg::Leaf(0), leaves: vec![sphere(DVec3::X, 1.0, 2)] });
    let place = |x: f64| Instance {
        solid: inner.clone(),
        world_from_object: DAffine3::from_scale(DVec3::new(-2.0, 2.0, 1.0)) * DAffine3::from_translation(DVec3::X * x),
    };
    let geometry = SceneGeometry { instances: vec![place(0.0), place(10.0)], ..SceneGeometry::default() };
    for scene in scenes(geometry) {
        // The first spans x = -4 to 0, the second -24 to -20.
        let hit = scene.intersect(&Ray::new(DVec3::new(5.0, 0.0, 0.0), DVec3::NEG_X)).unwrap();
        assert!((hit.t - 5.0).abs() < 1e-13 && close(hit.ng, DVec3::X) && hit.part == PartId(0));
        let list = scene.intervals(&Ray::new(DVec3::new(5.0, 0.0, 0.0), DVec3::NEG_X));
        assert_eq!(list.iter().map(|i| i.solid).collect::<Vec<_>>(), [0, 1]);
        assert!((list[1].t_enter - 25.0).abs() < 1e-12 && (list[1].t_exit - 29.0).abs() < 1e-12);
        assert_eq!(list[1].enter.map(|hit| hit.part), Some(PartId(1)));
    }
}

/// The visible area of a sphere with a bite, from samples: 20 000, bound above six standard errors.
#[test]
fn sampling_a_cut_part_is_unbiased() {
    let leaves = vec![sphere(DVec3::ZERO, 1.0, 0), cube(DVec3::new(-2.0, -2.0, 0.0), DVec3::splat(2.0), 1)];
    for scene in scenes(solid(minus(Csg::Leaf(0), Csg::Leaf(1)), leaves)) {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut area = [0.0; 2];
        let n = 20_000;
        for (part, sum) in area.iter_mut().enumerate() {
            for _ in 0..n {
                if let Some(sample) = scene.sample_part(PartId(part as u32), random(), [random(), random()]) {
                    assert!(sample.p.z < 1e-12);
                    assert_eq!(sample.ng.z > 0.0, part == 1);
                    *sum += 1.0 / sample.pdf_area / f64::from(n);
                }
            }
        }
        assert!((area[0] - 2.0 * PI).abs() < 0.3, "hemisphere {}", area[0]);
        // The box's face is 16 of an area of 64 and shows a disc.
        assert!((area[1] - PI).abs() < 0.6, "disc {}", area[1]);
    }
}

/// u and v at the equator of a sphere, plain and as an instance, and on a quad.
#[test]
fn surface_coordinates_on_demand() {
    let ball = Solid { tree: Csg::Leaf(0), leaves: vec![sphere(DVec3::ZERO, 1.0, 0)] };
    let shift = DAffine3::from_translation(DVec3::new(10.0, 0.0, 0.0));
    let instance = Instance { solid: Arc::new(ball.clone()), world_from_object: shift };
    let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y].map(|p| p + DVec3::X * 20.0);
    let quad = Surface {
        shape: SurfaceShape::Quad(corners),
        world_from_object: DAffine3::IDENTITY,
        material: MaterialIndex(0),
    };
    for scene in
        scenes(SceneGeometry { solids: vec![ball], instances: vec![instance], surfaces: vec![quad], faces: vec![] })
    {
        for x in [0.0, 10.0] {
            let hit = scene.intersect(&Ray::new(DVec3::new(x, 3.0, 0.0), DVec3::NEG_Y)).unwrap();
            let at = scene.parametrize(&hit);
            assert!((at.uv - DVec2::new(0.25, 0.5)).length() < 1e-12, "{at:?}");
            assert!((at.dpdu - DVec3::NEG_X).length() < 1e-12, "{at:?}");
        }
        let hit = scene.intersect(&Ray::new(DVec3::new(20.25, 0.75, 1.0), DVec3::NEG_Z)).unwrap();
        let at = scene.parametrize(&hit);
        assert!((at.uv - DVec2::new(0.25, 0.75)).length() < 1e-6, "{at:?}");
        assert!((at.dpdu - DVec3::X).length() < 1e-12, "{at:?}");
    }
}

#[test]
fn rays_that_are_not_finite_meet_nothing() {
    for scene in scenes(solid(Csg::Leaf(0), vec![sphere(DVec3::ZERO, 1.0, 0)])) {
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(scene.intersect(&Ray::new(DVec3::splat(bad), DVec3::X)).is_none());
            assert!(scene.intersect(&Ray::new(DVec3::ZERO, DVec3::splat(bad))).is_none());
        }
        assert!(!scene.occluded(&Ray::new(DVec3::ZERO, DVec3::ZERO)));
        assert!(!scene.occluded(&Ray { origin: DVec3::ZERO, dir: DVec3::X, t_max: f64::NAN }));
    }
}

#[test]
fn bad_geometry_is_an_error() {
    let build = |geometry| Scene::build(geometry, BuildOptions::default());
    assert!(build(solid(Csg::Leaf(1), vec![sphere(DVec3::ZERO, 1.0, 0)])).is_err());
    assert!(build(solid(Csg::Leaf(0), vec![sphere(DVec3::ZERO, -1.0, 0)])).is_err());
    let nan = Surface {
        shape: SurfaceShape::Triangle([DVec3::NAN, DVec3::X, DVec3::Y]),
        world_from_object: DAffine3::IDENTITY,
        material: MaterialIndex(0),
    };
    assert!(build(SceneGeometry { surfaces: vec![nan], ..SceneGeometry::default() }).is_err());
    assert!(build(SceneGeometry::default()).unwrap().intersect(&Ray::new(DVec3::ZERO, DVec3::X)).is_none());
}

/// Two thousand spheres that all touch in one point, alternately added and taken away: no cut separates them there. The
/// build stays within its budget, and rays past the point are right.
#[test]
fn inseparable_operands_are_bounded_in_cost() {
    let count = 2000;
    let leaves: Vec<CsgLeaf> = (0..count)
        .map(|i| {
            let radius = 1.0 - 0.5 * f64::from(i) / f64::from(count);
            let angle = f64::from(i) * 2.4;
            sphere(DVec3::new(angle.cos() * 0.3, angle.sin() * 0.3, 0.95).normalize() * radius, radius, i)
        })
        .collect();
    let tree = (1..count).fold(Csg::Leaf(0), |tree, i| {
        if i % 2 == 0 { Csg::Union(vec![tree, Csg::Leaf(i)]) } else { minus(tree, Csg::Leaf(i)) }
    });
    let scenes = scenes(solid(tree, leaves));
    let (oracle, others) = scenes.split_last().unwrap();
    for scene in others {
        assert!(scene.stats().cells < 100 * count as usize, "{:?}", scene.stats());
    }
    for i in 0..200 {
        let at = f64::from(i) * 0.01 - 1.0;
        let ray = Ray::new(DVec3::new(at, 3.0, 0.4 + 0.5 * at), DVec3::new(0.1, -1.0, 0.05).normalize());
        let expected = oracle.intersect(&ray).map(|hit| hit.part);
        for scene in others {
            assert_eq!(scene.intersect(&ray).map(|hit| hit.part), expected);
        }
    }
}
