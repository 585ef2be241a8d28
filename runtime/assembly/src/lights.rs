//! Lights and environments of the IR's normal form → the renderer's.

use arsc_ir::{Ir, NodeKind};
use arsc_render::{Environment, Light, SkyModel, SkySettings};
use arsc_spectral::Star;
use glam::{DAffine3, DMat3, DVec3};

use crate::AssemblyError;
use crate::geometry::{members, node};

/// Lights without extent, and environments, in the order of the root's members. Emissive geometry is found by
/// `World::new`.
pub fn lower(ir: &Ir) -> Result<(Vec<Light>, Vec<Environment>), AssemblyError> {
    let (mut lights, mut environments) = (Vec::new(), Vec::new());
    for &member in members(ir)? {
        let (world_from_local, kind) = match &node(ir, member)?.kind {
            NodeKind::Transform { parent_from_child, child } => (**parent_from_child, &node(ir, *child)?.kind),
            kind => (DAffine3::IDENTITY, kind),
        };
        match kind {
            NodeKind::Light(light) => lights.push(lower_light(light, &world_from_local)),
            NodeKind::Environment(environment) if matches!(**environment, arsc_ir::Environment::Medium { .. }) => {}
            NodeKind::Environment(environment) => {
                environments.push(lower_environment(environment, &world_from_local)?);
            }
            _ => {}
        }
    }
    Ok((lights, environments))
}

/// Where the first light is that shines from a point.
pub fn first_point(ir: &Ir) -> Result<Option<DVec3>, AssemblyError> {
    for &member in members(ir)? {
        let (origin, kind) = match &node(ir, member)?.kind {
            NodeKind::Transform { parent_from_child, child } => {
                (parent_from_child.translation, &node(ir, *child)?.kind)
            }
            kind => (DVec3::ZERO, kind),
        };
        if matches!(kind, NodeKind::Light(light) if light.is_point()) {
            return Ok(Some(origin));
        }
    }
    Ok(None)
}

fn lower_light(light: &arsc_ir::Light, world_from_local: &DAffine3) -> Light {
    let position = world_from_local.translation;
    match light {
        arsc_ir::Light::Point { intensity } => Light::point(position, intensity),
        arsc_ir::Light::Spot { intensity, exponent, angle } => {
            let axis = world_from_local.transform_vector3(DVec3::Z);
            Light::spot(position, axis, intensity, *exponent, *angle)
        }
        arsc_ir::Light::Photometric { web, spectrum } => {
            Light::photometric(position, directions(world_from_local), web.clone(), spectrum)
        }
        arsc_ir::Light::Distant { irradiance, direction } => {
            Light::distant(world_from_local.transform_vector3(*direction), irradiance)
        }
    }
}

/// What a map does to directions once its scales and shears are left out: orthonormal, mirrored if the map is. The axis z keeps
/// its direction, x the plane that it makes with z.
fn directions(map: &DAffine3) -> DMat3 {
    let z = map.matrix3.z_axis.normalize_or(DVec3::Z);
    let x = (map.matrix3.x_axis - z * z.dot(map.matrix3.x_axis)).normalize_or(z.any_orthonormal_vector());
    let y = z.cross(x) * 1f64.copysign(map.matrix3.determinant());
    DMat3::from_cols(x, y, z)
}

fn lower_environment(
    environment: &arsc_ir::Environment,
    world_from_local: &DAffine3,
) -> Result<Environment, AssemblyError> {
    match environment {
        arsc_ir::Environment::Medium { .. } => Err(AssemblyError::NotNormal("a medium is no light")),
        arsc_ir::Environment::Constant { radiance } => Ok(Environment::constant(radiance)),
        arsc_ir::Environment::Image { image, scale, .. } => {
            Ok(Environment::image(image.clone(), directions(world_from_local), *scale))
        }
        arsc_ir::Environment::Sky(sky) => lower_sky(sky, world_from_local).map(|settings| Environment::sky(&settings)),
    }
}

fn lower_sky(sky: &arsc_ir::Sky, world_from_local: &DAffine3) -> Result<SkySettings, AssemblyError> {
    // The models are symmetric about the vertical plane through the sun, so that turning and mirroring one about
    // the z axis is moving the sun. Tilted, it would have no ground.
    let up = world_from_local.transform_vector3(DVec3::Z).normalize_or_zero();
    if !up.abs_diff_eq(DVec3::Z, UP_TOLERANCE) {
        return Err(AssemblyError::Settings("a sky can be turned about the z axis, but not tilted".into()));
    }
    let model = match sky.model {
        arsc_ir::SkyModel::HosekWilkie => SkyModel::HosekWilkie,
        arsc_ir::SkyModel::Preetham => SkyModel::Preetham,
    };
    let kelvin = sky.star_temperature.unwrap_or(Star::SUN.kelvin);
    Ok(SkySettings {
        model,
        turbidity: sky.turbidity,
        ground_albedo: sky.ground_albedo,
        sun: world_from_local.transform_vector3(sky.sun),
        solar_disc: sky.solar_disc,
        scale: sky.scale,
        star: Star { kelvin, intensity: sky.star_intensity },
        polarised: sky.polarised,
    })
}

/// Rounding of a rotation about z, in units of the vertical.
const UP_TOLERANCE: f64 = 1e-9;
