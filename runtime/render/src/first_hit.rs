//! What the camera sees first, and how it reflects: for previews, occlusion and features.

use arsc_accel::Hit;
use arsc_geometry::Ray;
use arsc_spectral::{SampledSpectrum, SampledWavelengths};
use glam::DVec3;

use crate::bsdf::Bsdf;
use crate::frame::Frame;
use crate::polarisation::{Mueller, Unpolarised};
use crate::world::World;

/// Walls without a bsdf that a ray goes through at most.
const MOST_WALLS: u32 = 64;

/// The first surface along a ray that has a bsdf.
pub(crate) fn first_hit(world: &World, mut ray: Ray) -> Option<Hit> {
    for _ in 0..MOST_WALLS {
        let hit = world.geometry.intersect(&ray)?;
        if !matches!(world.material(&hit).bsdf, Bsdf::Inert) {
            return Some(hit);
        }
        let t_max = ray.t_max - hit.t;
        ray = hit.spawn(ray.dir);
        ray.t_max = t_max;
    }
    None
}

/// The shading normal at a hit on the side that is seen.
pub(crate) fn seen_normal(hit: &Hit, wo: DVec3) -> DVec3 {
    let normal = if wo.dot(hit.ng) * wo.dot(hit.ns) > 0.0 { hit.ns } else { hit.ng };
    if wo.dot(normal) < 0.0 { -normal } else { normal }
}

/// An estimate of the share of light from the viewer's direction that is scattered into any direction, in [0, 1] per
/// wavelength: exact for diffuse and smooth surfaces. The hit gets the shading normal that belongs to it.
pub(crate) fn albedo(
    world: &World,
    hit: &mut Hit,
    wo: DVec3,
    u: [f64; 2],
    mut u_lobe: f64,
    wavelengths: &SampledWavelengths,
) -> SampledSpectrum {
    let mut owned = None;
    let bsdf = world.bsdf(hit, &mut u_lobe, wavelengths, &mut owned);
    let normal = if wo.dot(hit.ng) * wo.dot(hit.ns) > 0.0 { hit.ns } else { hit.ng };
    let frame = if bsdf.needs_tangent() {
        Frame::with_tangent(normal, world.geometry.parametrize(hit).dpdu)
    } else {
        Frame::new(normal)
    };
    let Some(sample) = bsdf.sample::<Unpolarised>(frame.to_local(wo), u, u_lobe, wavelengths) else {
        return SampledSpectrum::ZERO;
    };
    let weight = sample.weight.intensity();
    // Where dispersion separates the wavelengths, the hero speaks for all.
    let separated = sample.path_pdf.map(|pdf| if pdf > 0.0 { 0.0 } else { 1.0 }).max() > 0.0;
    let share = if separated { SampledSpectrum::splat(weight.hero()) } else { weight * (1.0 / sample.path_pdf.mean()) };
    // Refraction shrinks radiance by the square of the index, not the share of the light.
    (share * (sample.eta * sample.eta) as f32).map(|s| if s > 0.0 { s.min(1.0) } else { 0.0 })
}
