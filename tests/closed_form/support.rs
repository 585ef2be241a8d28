//! Small scenes and the means of their pictures.

use arsc_accel::{BuildOptions, Csg, CsgLeaf, MaterialIndex, Scene, SceneGeometry, Shape, Solid};
use arsc_image::SpectralImage;
use arsc_render::{
    Camera, Environment, Film, FilterShape, Light, Material, PathTraceSettings, ReconstructionFilter, World, path_trace,
};
use glam::{DAffine3, DVec3};

/// A world of solids that consist of one leaf each; materials in the order of the solids.
pub fn world(
    shapes: &[(Shape, DAffine3)],
    materials: Vec<Material>,
    lights: Vec<Light>,
    environments: Vec<Environment>,
) -> World {
    let solid = |(i, (shape, place)): (usize, &(Shape, DAffine3))| Solid {
        tree: Csg::Leaf(0),
        leaves: vec![CsgLeaf { shape: *shape, world_from_object: *place, material: MaterialIndex(i as u32) }],
    };
    let solids = shapes.iter().enumerate().map(solid).collect();
    let geometry = SceneGeometry { solids, ..SceneGeometry::default() };
    let scene = Scene::build(geometry, BuildOptions::default()).expect("valid geometry");
    World::new(scene, materials, lights, environments)
}

pub fn sphere(center: DVec3, radius: f64) -> (Shape, DAffine3) {
    (Shape::Sphere { radius }, DAffine3::from_translation(center))
}

/// A square picture of `pixels`² seen from `eye`.
pub fn camera(eye: DVec3, target: DVec3, fov: f64, pixels: u32) -> Camera {
    let filter = ReconstructionFilter::new(FilterShape::Box { radius: 0.5 });
    Camera::perspective(eye, target, DVec3::Z, fov, [pixels; 2], filter)
}

pub fn render(world: &World, camera: &Camera, samples: u32, max_depth: u32) -> Film {
    let settings = PathTraceSettings { samples, max_depth, ..PathTraceSettings::default() };
    path_trace(world, camera, &settings, &())
}

/// Mean over pixels of every band.
pub fn band_means(image: &SpectralImage) -> Vec<f64> {
    let bands = image.band_edges_nm.len() - 1;
    let mut sums = vec![0.0; bands];
    for pixel in image.radiance.chunks(bands) {
        sums.iter_mut().zip(pixel).for_each(|(sum, r)| *sum += f64::from(*r));
    }
    sums.iter().map(|sum| sum * bands as f64 / image.radiance.len() as f64).collect()
}

/// Mean over pixels and bands.
pub fn mean(image: &SpectralImage) -> f64 {
    let means = band_means(image);
    means.iter().sum::<f64>() / means.len() as f64
}
