//! Small scenes and the means of their pictures.

use arsc_accel::{
    BuildOptions, Csg, CsgLeaf, FaceMaterial, MaterialIndex, Scene, SceneGeometry, Shape, Solid, Surface, SurfaceShape,
};
use arsc_image::SpectralImage;
use arsc_render::{
    AreaEmitter, Bsdf, Camera, Environment, FilterShape, Light, Material, Media, PathTraceSettings,
    ReconstructionFilter, Sampling, World, path_trace,
};
use arsc_spectral::Spectrum;
use glam::{DAffine3, DMat3, DVec3};

/// A scene under construction: one material per object.
#[derive(Default)]
pub struct Stage {
    geometry: SceneGeometry,
    materials: Vec<Material>,
    pub lights: Vec<Light>,
    pub environments: Vec<Environment>,
    pub media: Media,
}

impl Stage {
    fn add_material(&mut self, material: Material) -> MaterialIndex {
        self.materials.push(material);
        MaterialIndex(self.materials.len() as u32 - 1)
    }

    pub fn solid(&mut self, shape: Shape, world_from_object: DAffine3, material: Material) -> &mut Stage {
        let material = self.add_material(material);
        let leaves = vec![CsgLeaf { shape, world_from_object, material }];
        self.geometry.solids.push(Solid { tree: Csg::Leaf(0), leaves });
        self
    }

    /// One solid with other materials on some faces.
    pub fn faces(
        &mut self,
        shape: Shape,
        place: DAffine3,
        whole: Material,
        others: Vec<(u32, Material)>,
    ) -> &mut Stage {
        self.solid(shape, place, whole);
        let base = MaterialIndex(self.materials.len() as u32 - 1);
        for (face, material) in others {
            let material = self.add_material(material);
            self.geometry.faces.push(FaceMaterial { base, face, material });
        }
        self
    }

    /// The first shape cut by the second, with a material each.
    pub fn difference(&mut self, operands: [(Shape, DAffine3, Material); 2]) -> &mut Stage {
        let leaves = operands.map(|(shape, world_from_object, material)| {
            let material = self.add_material(material);
            CsgLeaf { shape, world_from_object, material }
        });
        let tree = Csg::Difference(Box::new(Csg::Leaf(0)), Box::new(Csg::Leaf(1)));
        self.geometry.solids.push(Solid { tree, leaves: leaves.to_vec() });
        self
    }

    pub fn sphere(&mut self, center: DVec3, radius: f64, material: Material) -> &mut Stage {
        self.solid(Shape::Sphere { radius }, DAffine3::from_translation(center), material)
    }

    pub fn surface(&mut self, shape: SurfaceShape, place: DAffine3, material: Material) -> &mut Stage {
        let material = self.add_material(material);
        self.geometry.surfaces.push(Surface { shape, world_from_object: place, material });
        self
    }

    pub fn build(self) -> World {
        let scene = Scene::build(self.geometry, BuildOptions::default()).expect("valid geometry");
        World::with_media(scene, self.materials, self.lights, self.environments, self.media)
    }
}

pub fn constant(value: f64) -> Spectrum {
    Spectrum::Constant(value)
}

pub fn lambert(reflectance: f64) -> Material {
    Material { bsdf: Bsdf::lambert(&constant(reflectance)), ..Material::default() }
}

/// Emits towards its normal and scatters nothing.
pub fn emitter(radiance: Spectrum) -> Material {
    Material {
        bsdf: Bsdf::lambert(&constant(0.0)),
        emitter: Some(AreaEmitter::new(&radiance, false)),
        ..Material::default()
    }
}

/// At a height, with the normal downwards.
pub fn facing_down(center: DVec3) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_rotation_x(std::f64::consts::PI), translation: center }
}

/// A square picture.
pub fn camera(eye: DVec3, target: DVec3, fov: f64, pixels: u32) -> Camera {
    let filter = ReconstructionFilter::new(FilterShape::Box { radius: 0.5 });
    Camera::perspective(eye, target, DVec3::Z, fov, [pixels; 2], filter)
}

/// Looks at a point so closely that all pixels see the same.
pub fn spot_camera(eye: DVec3, target: DVec3) -> Camera {
    camera(eye, target, 1e-4, 8)
}

pub fn settings(samples: u32, max_depth: u32) -> PathTraceSettings {
    let sampling = Sampling { samples, ..Sampling::default() };
    PathTraceSettings { sampling, max_depth, ..PathTraceSettings::default() }
}

pub fn render(world: &World, camera: &Camera, samples: u32, max_depth: u32) -> SpectralImage {
    let film = path_trace(world, camera, &settings(samples, max_depth), &());
    assert_eq!(film.rejected(), 0, "samples that are not finite or negative");
    film.to_image()
}

/// Mean over pixels and bands of S0 to S3.
pub fn stokes(world: &World, camera: &Camera, samples: u32, max_depth: u32) -> [f64; 4] {
    let settings = PathTraceSettings { polarised: true, ..settings(samples, max_depth) };
    let film = path_trace(world, camera, &settings, &());
    assert_eq!(film.rejected(), 0, "samples that are not finite or negative");
    let image = film.to_image();
    let n = image.radiance.len() as f64;
    let mean = |of: &dyn Fn(usize) -> f32| (0..image.radiance.len()).map(|i| f64::from(of(i))).sum::<f64>() / n;
    let stokes = image.stokes.as_ref().expect("a polarised image");
    [mean(&|i| image.radiance[i]), mean(&|i| stokes[i][0]), mean(&|i| stokes[i][1]), mean(&|i| stokes[i][2])]
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

/// Mean over pixels, of the mean over bands, and its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub mean: f64,
    pub standard_error: f64,
}

pub fn estimate(image: &SpectralImage) -> Estimate {
    estimate_bands(image, 0..image.band_edges_nm.len() - 1)
}

pub fn estimate_bands(image: &SpectralImage, group: std::ops::Range<usize>) -> Estimate {
    let bands = image.band_edges_nm.len() - 1;
    let of_group = |pixel: &[f32]| pixel[group.clone()].iter().map(|r| f64::from(*r)).sum::<f64>();
    let pixel_mean = |pixel: &[f32]| of_group(pixel) / group.len() as f64;
    let values: Vec<f64> = image.radiance.chunks(bands).map(pixel_mean).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    Estimate { mean, standard_error: (variance / n).sqrt() }
}

impl Estimate {
    /// Five standard errors (and a millionth, for single precision), each at most `power` of the value.
    pub fn assert_is(&self, exact: f64, power: f64) {
        let Estimate { mean, standard_error } = *self;
        assert!(standard_error <= power * exact, "no power: {self:?} for {exact}");
        let bound = 5.0 * standard_error + 1e-6 * exact;
        assert!((mean - exact).abs() <= bound, "{self:?} instead of {exact}: {:.2e}", mean / exact - 1.0);
    }
}
