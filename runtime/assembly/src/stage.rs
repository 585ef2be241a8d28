//! The scene on its way to a picture: lowered once, built for a strategy when an action needs it.

use std::cell::RefCell;
use std::sync::Arc;

use arsc_accel::{BuildOptions, Csg, Scene, SceneGeometry, Solid, Strategy};
use arsc_geometry::{Aabb, DVec3, Placed};
use arsc_ir::{Ir, WavelengthRange};
use arsc_render::{Camera, LightSource, World};

use crate::{AssemblyError, Host, Settings, camera, geometry, lights, materials};

/// Stack of a rendering thread, bytes: Boolean trees recurse.
const STACK: usize = 64 << 20;

pub struct Stage<'a> {
    ir: &'a Ir,
    settings: &'a Settings,
    host: &'a dyn Host,
    geometry: SceneGeometry,
    /// The threads that build and render.
    pub pool: rayon::ThreadPool,
    /// The last world that was built.
    built: RefCell<Option<Built>>,
}

#[derive(Clone)]
struct Built {
    strategy: Strategy,
    world: Arc<World>,
    /// For which its lights are weighed.
    range: WavelengthRange,
    seconds: f64,
}

impl<'a> Stage<'a> {
    pub fn new(ir: &'a Ir, settings: &'a Settings, host: &'a dyn Host) -> Result<Stage<'a>, AssemblyError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(settings.threads.unwrap_or(0))
            .stack_size(STACK)
            .build()
            .map_err(|error| AssemblyError::Settings(format!("cannot start the threads: {error}")))?;
        let geometry = geometry::lower(ir)?;
        Ok(Stage { ir, settings, host, geometry, pool, built: RefCell::new(None) })
    }

    /// The scene built for a strategy, its lights weighed for the wavelengths of a render.
    pub fn world_for(&self, strategy: Strategy, range: &WavelengthRange) -> Result<Arc<World>, AssemblyError> {
        drop(self.world(strategy)?);
        let mut built = self.built.borrow_mut();
        if let Some(built) = built.as_mut().filter(|built| built.range != *range)
            && let Some(world) = Arc::get_mut(&mut built.world)
        {
            world.weigh_lights(range);
            built.range = *range;
        }
        drop(built);
        self.world(strategy)
    }

    /// The scene built for a strategy.
    pub fn world(&self, strategy: Strategy) -> Result<Arc<World>, AssemblyError> {
        if let Some(built) = self.built.borrow().as_ref().filter(|built| built.strategy == strategy) {
            return Ok(built.world.clone());
        }
        let start = self.host.seconds();
        let materials = materials::lower(self.ir)?;
        let (lights, environments) = lights::lower(self.ir)?;
        let media = materials::lower_media(self.ir)?;
        let geometry = self.geometry.clone();
        let scene = self.pool.install(|| build(geometry, BuildOptions { strategy, budget: self.settings.budget }))?;
        let world = Arc::new(self.pool.install(|| World::with_media(scene, materials, lights, environments, media)));
        let seconds = self.host.seconds() - start;
        *self.built.borrow_mut() =
            Some(Built { strategy, world: world.clone(), range: WavelengthRange::VISIBLE, seconds });
        Ok(world)
    }

    /// Seconds that the last build took.
    pub fn build_seconds(&self) -> f64 {
        self.built.borrow().as_ref().map_or(0.0, |built| built.seconds)
    }

    /// The script's camera, or one that frames the bounds of the scene, and the pixels x0, y0, x1, y1 to render if not
    /// all.
    pub fn camera(&self, strategy: Strategy) -> Result<(Camera, Option<[u32; 4]>), AssemblyError> {
        let resolution = self.settings.resolution;
        let (camera, crop) = match &self.ir.camera {
            Some(camera) => {
                let bounds = if camera::needs_bounds(camera) {
                    self.world(strategy)?.geometry.bounded_parts()
                } else {
                    Aabb::EMPTY
                };
                camera::lower(camera, resolution, &bounds)
            }
            None => {
                let bounds = self.world(strategy)?.geometry.bounds();
                camera::lower(&camera::framing(&bounds), resolution, &bounds)
            }
        };
        Ok((camera, self.settings.crop.or(crop)))
    }

    /// Prints the bounds of the scene.
    pub fn say_bounds(&self, strategy: Strategy) -> Result<(), AssemblyError> {
        let world = self.world(strategy)?;
        let bounds = world.geometry.bounds();
        self.host.say(&format!("bounds of the scene: {}", words(&bounds)));
        for (i, solid) in self.geometry.solids.iter().enumerate() {
            let bounds = solid_bounds(&solid.tree, solid);
            self.host.say(&format!("  solid {i}, {} leaves: {}", solid.leaves.len(), words(&bounds)));
        }
        Ok(())
    }

    /// Prints the light sources and their powers over the visible range.
    pub fn say_lights(&self, strategy: Strategy) -> Result<(), AssemblyError> {
        let world = self.world_for(strategy, &WavelengthRange::VISIBLE)?;
        let sources: Vec<_> = world.light_sources().collect();
        self.host.say(&format!("light sources: {}", sources.len()));
        for (source, power) in sources {
            let name = match source {
                LightSource::Part { part, material } => format!("part {}, material {material}", part.0),
                LightSource::Light(light) => format!("light {light}"),
                LightSource::Environment(environment) => format!("environment {environment}"),
            };
            self.host.say(&format!("  {name}: {power:.4e} W"));
        }
        Ok(())
    }
}

/// The scene of `geometry` for tracing.
pub fn build(geometry: SceneGeometry, options: BuildOptions) -> Result<Scene, AssemblyError> {
    Scene::build(geometry, options).map_err(|source| AssemblyError::Accel(Box::new(source)))
}

/// Bounds of a Boolean tree from those of its leaves: not the tightest, never too tight.
fn solid_bounds(tree: &Csg, solid: &Solid) -> Aabb {
    let of = |tree: &Csg| solid_bounds(tree, solid);
    match tree {
        Csg::Leaf(leaf) => {
            let leaf = &solid.leaves[*leaf as usize];
            Placed::new(leaf.shape.clone(), leaf.world_from_object).map_or(Aabb::EVERYTHING, |placed| *placed.bounds())
        }
        Csg::Union(operands) => operands.iter().map(of).fold(Aabb::EMPTY, |hull, b| hull.union(&b)),
        Csg::Intersection(operands) => operands.iter().map(of).fold(Aabb::EVERYTHING, |hull, b| hull.intersection(&b)),
        Csg::Difference(first, _) => of(first),
    }
}

/// Six digits, and zero for what is nothing beside the largest coordinate.
fn words(bounds: &Aabb) -> String {
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let rounded = |c: f64| if c.abs() < 1e-9 * largest { 0.0 } else { format!("{c:.5e}").parse().unwrap_or(c) };
    let corner = |p: DVec3| DVec3::from_array(p.to_array().map(rounded));
    if bounds.is_empty() { "empty".into() } else { format!("{} to {}", corner(bounds.min), corner(bounds.max)) }
}

pub fn accel_strategy(strategy: arsc_ir::Strategy) -> Strategy {
    match strategy {
        arsc_ir::Strategy::Local => Strategy::Local,
        arsc_ir::Strategy::Native => Strategy::Native,
        arsc_ir::Strategy::Collect => Strategy::Collect,
        arsc_ir::Strategy::Tree => Strategy::Tree,
        arsc_ir::Strategy::Kd => Strategy::Kd,
        arsc_ir::Strategy::Hybrid => Strategy::Hybrid,
        arsc_ir::Strategy::Incremental => Strategy::Incremental,
    }
}
