//! Lights and environments of the IR's normal form → the renderer's.

use arsc_ir::{Ir, NodeKind};
use arsc_render::{Environment, Light, SkySettings};
use glam::{DAffine3, DVec3};

use crate::AssemblyError;
use crate::geometry::{members, node};

/// Point and distant lights, and environments, in the order of the root's members. Emissive geometry is found by
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

/// Where the first point light is.
pub fn first_point(ir: &Ir) -> Result<Option<DVec3>, AssemblyError> {
    for &member in members(ir)? {
        let (origin, kind) = match &node(ir, member)?.kind {
            NodeKind::Transform { parent_from_child, child } => {
                (parent_from_child.translation, &node(ir, *child)?.kind)
            }
            kind => (DVec3::ZERO, kind),
        };
        if matches!(kind, NodeKind::Light(light) if matches!(**light, arsc_ir::Light::Point { .. })) {
            return Ok(Some(origin));
        }
    }
    Ok(None)
}

fn lower_light(light: &arsc_ir::Light, world_from_local: &DAffine3) -> Light {
    match light {
        arsc_ir::Light::Point { intensity } => Light::point(world_from_local.translation, intensity),
        arsc_ir::Light::Distant { irradiance, direction } => {
            Light::distant(world_from_local.transform_vector3(*direction), irradiance)
        }
    }
}

fn lower_environment(
    environment: &arsc_ir::Environment,
    world_from_local: &DAffine3,
) -> Result<Environment, AssemblyError> {
    match environment {
        arsc_ir::Environment::Medium { .. } => Err(AssemblyError::NotNormal("a medium is no light")),
        arsc_ir::Environment::Constant { radiance } => Ok(Environment::constant(radiance)),
        arsc_ir::Environment::HosekWilkie { turbidity, ground_albedo, sun, solar_disc, scale } => {
            // The model is symmetric about the vertical plane through the sun, so that turning and mirroring it about
            // the z axis is moving the sun. Tilted, it would have no ground.
            let up = world_from_local.transform_vector3(DVec3::Z).normalize_or_zero();
            if !up.abs_diff_eq(DVec3::Z, UP_TOLERANCE) {
                return Err(AssemblyError::Settings("a sky can be turned about the z axis, but not tilted".into()));
            }
            let sun = world_from_local.transform_vector3(*sun);
            let (turbidity, ground_albedo, solar_disc, scale) = (*turbidity, *ground_albedo, *solar_disc, *scale);
            Ok(Environment::hosek_wilkie(&SkySettings { turbidity, ground_albedo, sun, solar_disc, scale }))
        }
    }
}

/// Rounding of a rotation about z, in units of the vertical.
const UP_TOLERANCE: f64 = 1e-9;
