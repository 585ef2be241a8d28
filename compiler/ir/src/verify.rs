//! The verifier: every invariant of the IR that its types do not carry.
//!
//! It runs between passes in debug and test builds, and on text that is read. A scene that analysis accepted verifies;
//! a violation is a bug of the stage before (or a hand-written text).

use std::f64::consts::PI;
use std::fmt;

use arsc_geometry::{DVec3, invert};
use arsc_spectral::Spectrum;

use crate::image_action::is_valid_tone_map;
use crate::{
    Action, Attributes, Bsdf, Camera, CutRule, Density, Dye, Environment, Facets, Fluorescence, Focus, Ir, Leaf, Light,
    Material, MaterialId, Medium, NodeId, NodeKind, Parameter, PhaseFunction, Projection, Surface, Varying,
};

/// Spectra nest at most this deep, so that everybody may recurse into them.
const MAX_SPECTRUM_DEPTH: usize = 128;

/// A broken invariant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// `%3`, `b0`, `camera` …
    pub place: String,
    pub message: &'static str,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// Everything that is wrong with an IR, in the order of its tables.
///
/// # Errors
/// At least one violation; at most a hundred are listed.
pub fn verify(ir: &Ir) -> Result<(), Vec<Violation>> {
    let mut found = Found(Vec::new());
    for (id, bsdf) in ir.bsdfs.iter().enumerate() {
        found.check(check_bsdf(bsdf), || format!("b{id}"));
    }
    for (id, emitter) in ir.emitters.iter().enumerate() {
        found.check(check_spectrum(&emitter.radiance), || format!("e{id}"));
    }
    for (id, medium) in ir.media.iter().enumerate() {
        found.check(check_medium(medium), || format!("v{id}"));
    }
    for (id, material) in ir.materials.iter().enumerate() {
        let known = check_attributes(ir, material.bsdf, material.emitter, material.medium)
            .and_then(|()| check_attributes(ir, material.inside, None, None))
            .and_then(|()| check_faces(ir, id, material));
        found.check(known, || format!("m{id}"));
    }
    let mut contents: Vec<Contents> = Vec::with_capacity(ir.nodes.len());
    for id in 0..ir.nodes.len() {
        let content = check_node(ir, id, &contents);
        contents.push(*content.as_ref().unwrap_or(&Contents::default()));
        found.check(content.map(|_| ()), || format!("%{id}"));
    }
    if ir.root.index() >= ir.nodes.len() {
        found.check(Err("there is no such node"), || format!("root %{}", ir.root.0));
    }
    for (i, at) in ir.actions.iter().enumerate() {
        found.check(check_action(&at.action), || format!("action {i}"));
    }
    if let Some(camera) = &ir.camera {
        found.check(check_camera(camera), || "camera".to_owned());
    }
    if found.0.is_empty() { Ok(()) } else { Err(found.0) }
}

type Check<T = ()> = Result<T, &'static str>;

struct Found(Vec<Violation>);

impl Found {
    fn check(&mut self, result: Check, place: impl FnOnce() -> String) {
        if let Err(message) = result
            && self.0.len() < 100
        {
            self.0.push(Violation { place: place(), message });
        }
    }
}

fn require(condition: bool, message: &'static str) -> Check {
    if condition { Ok(()) } else { Err(message) }
}

/// What is below a node.
#[derive(Clone, Copy, Default)]
struct Contents {
    /// A solid, or the empty set: something that a Boolean operator works on.
    solid: bool,
    /// A surface or a group: nothing that a Boolean operator could work on.
    open: bool,
}

fn check_node(ir: &Ir, id: usize, contents: &[Contents]) -> Check<Contents> {
    let kind = &ir.nodes[id].kind;
    let children = kind.children();
    require(children.iter().all(|child| child.index() < id), "a child does not come before its parent")?;
    let below = children.iter().fold(Contents::default(), |sum, child| {
        let NodeId(child) = *child;
        let child = contents[child as usize];
        Contents { solid: sum.solid | child.solid, open: sum.open | child.open }
    });
    let all_solid = children.iter().all(|child| contents[child.index()].solid);
    match kind {
        NodeKind::Leaf(leaf) => check_leaf(ir, leaf),
        NodeKind::Union(_) => Ok(Contents { solid: below.solid || children.is_empty(), ..below }),
        NodeKind::Intersection(_) | NodeKind::Difference(_) => {
            require(!children.is_empty(), "a Boolean node has no operands")?;
            require(all_solid, "an operand is no solid")?;
            require(!below.open, "an operand holds an open surface or a group")?;
            Ok(below)
        }
        NodeKind::Group(_) => Ok(Contents { open: true, ..below }),
        NodeKind::Transform { parent_from_child, .. } => {
            require(invert(parent_from_child).is_some(), "the map is not finite and invertible")?;
            Ok(below)
        }
        NodeKind::Attributes { attributes: Attributes { bsdf, emitter, medium, cut, face: _ }, .. } => {
            check_attributes(ir, *bsdf, *emitter, *medium)?;
            if let Some(CutRule::Bsdf(bsdf)) = cut {
                check_attributes(ir, Some(*bsdf), None, None)?;
            }
            Ok(below)
        }
        NodeKind::Light(light) => check_light(light).map(|()| below),
        NodeKind::Environment(environment) => check_environment(ir, environment).map(|()| below),
    }
}

fn check_attributes(ir: &Ir, bsdf: Option<u32>, emitter: Option<u32>, medium: Option<u32>) -> Check {
    require(medium.is_none_or(|id| (id as usize) < ir.media.len()), "there is no such medium")?;
    require(bsdf.is_none_or(|id| (id as usize) < ir.bsdfs.len()), "there is no such bsdf")?;
    require(emitter.is_none_or(|id| (id as usize) < ir.emitters.len()), "there is no such emitter")
}

fn check_faces(ir: &Ir, id: usize, material: &Material) -> Check {
    let plain = |other: &MaterialId| (other.0 as usize) < id && ir.materials[other.0 as usize].faces.is_empty();
    require(material.faces.iter().all(|(_, other)| plain(other)), "a face has no material of its own from before")?;
    require(material.faces.is_sorted_by(|a, b| a.0 < b.0), "the faces do not ascend")
}

fn check_leaf(ir: &Ir, leaf: &Leaf) -> Check<Contents> {
    let (Leaf::Solid { parent_from_object, material, .. } | Leaf::Surface { parent_from_object, material, .. }) = leaf;
    require(invert(parent_from_object).is_some(), "the map is not finite and invertible")?;
    let known = |MaterialId(id)| (id as usize) < ir.materials.len();
    require(material.is_none_or(known), "there is no such material")?;
    match leaf {
        Leaf::Solid { shape, .. } => {
            require(shape.is_valid(), "a size is not positive and finite")?;
            Ok(Contents { solid: true, open: false })
        }
        Leaf::Surface { surface, .. } => {
            check_surface(surface)?;
            Ok(Contents { solid: false, open: true })
        }
    }
}

fn check_surface(surface: &Surface) -> Check {
    let finite = |points: &[DVec3]| points.iter().all(|p| p.is_finite());
    match surface {
        Surface::Triangle(points) => require(finite(points), "a corner is not finite"),
        Surface::Quad(points) => require(finite(points), "a corner is not finite"),
        Surface::Rectangle { width, depth } => {
            require(positive(*width) && positive(*depth), "a size is not positive and finite")
        }
        Surface::Disk { radius } => require(positive(*radius), "a size is not positive and finite"),
        Surface::Plane => Ok(()),
        Surface::Mesh { path, mesh } => {
            require(!path.is_empty(), "the path is empty")?;
            require(mesh.is_valid(), "the mesh has an index or a coordinate out of range")
        }
    }
}

fn positive(x: f64) -> bool {
    x > 0.0 && x.is_finite()
}

fn is_unit(v: DVec3) -> bool {
    (v.length() - 1.0).abs() < 1e-6
}

fn check_light(light: &Light) -> Check {
    match light {
        Light::Point { intensity } => check_spectrum(intensity),
        Light::Spot { intensity, exponent, angle } => {
            require(*exponent >= 0.0 && exponent.is_finite(), "an exponent is negative or not finite")?;
            require(*angle > 0.0 && *angle <= std::f64::consts::FRAC_PI_2, "the angle is not in (0, pi / 2]")?;
            check_spectrum(intensity)
        }
        Light::Photometric { spectrum, .. } => check_spectrum(spectrum),
        Light::Distant { irradiance, direction } => {
            require(is_unit(*direction), "the direction is not a unit vector")?;
            check_spectrum(irradiance)
        }
    }
}

fn check_environment(ir: &Ir, environment: &Environment) -> Check {
    match environment {
        Environment::Constant { radiance } => check_spectrum(radiance),
        Environment::Medium { medium } => check_attributes(ir, None, None, Some(*medium)),
        Environment::Image { scale, .. } => {
            require(*scale >= 0.0 && scale.is_finite(), "the scale is negative or not finite")
        }
        Environment::Sky(sky) => {
            require(is_unit(sky.sun), "the sun's direction is not a unit vector")?;
            require((1.0..=10.0).contains(&sky.turbidity), "the turbidity is not in 1..=10")?;
            require((0.0..=1.0).contains(&sky.ground_albedo), "the albedo is not in 0..=1")?;
            require(sky.scale >= 0.0 && sky.scale.is_finite(), "the scale is negative or not finite")?;
            let star = sky.star_temperature.is_none_or(|kelvin| kelvin > 0.0 && kelvin.is_finite());
            require(star, "the temperature of the star is not positive")?;
            require(sky.star_intensity >= 0.0 && sky.star_intensity.is_finite(), "the star's intensity is negative")
        }
    }
}

fn check_bsdf(bsdf: &Bsdf) -> Check {
    match bsdf {
        Bsdf::Varying(varying) => check_varying(varying),
        Bsdf::Lambert { reflectance } | Bsdf::Mirror { reflectance } => check_spectrum(reflectance),
        Bsdf::OrenNayar { reflectance, sigma } => {
            require(*sigma >= 0.0 && sigma.is_finite(), "sigma is negative or not finite")?;
            check_spectrum(reflectance)
        }
        Bsdf::Dielectric { ior } => check_spectrum(ior),
        Bsdf::Conductor { eta, k } => check_spectrum(eta).and(check_spectrum(k)),
        Bsdf::Inert | Bsdf::Measured { .. } => Ok(()),
        Bsdf::ThinDielectric { ior } => check_spectrum(ior),
        Bsdf::Phong { reflectance, exponent } => {
            require(*exponent >= 0.0 && exponent.is_finite(), "an exponent is negative or not finite")?;
            check_spectrum(reflectance)
        }
        Bsdf::RoughConductor { eta, k, facets } => {
            check_facets(facets)?;
            check_spectrum(eta).and(check_spectrum(k))
        }
        Bsdf::RoughDielectric { ior, facets } => check_facets(facets).and(check_spectrum(ior)),
        Bsdf::Polariser { transmittance, angle } => {
            require(angle.is_finite(), "an angle is not finite")?;
            check_spectrum(transmittance)
        }
        Bsdf::Retarder { retardance, angle } => {
            require(retardance.is_finite() && angle.is_finite(), "an angle is not finite")
        }
        Bsdf::Depolariser { transmittance } => check_spectrum(transmittance),
        Bsdf::Layered { coat, base, absorption, thickness } => {
            require(coat.is_coat(), "what lies on top is no coat")?;
            require(base.is_base(), "what lies under a coat is no base")?;
            require(*thickness >= 0.0 && thickness.is_finite(), "a thickness is negative or not finite")?;
            check_bsdf(coat).and_then(|()| check_bsdf(base)).and_then(|()| check_spectrum(absorption))
        }
        Bsdf::Fluorescent { reradiation, sigma } => {
            require(*sigma >= 0.0 && sigma.is_finite(), "sigma is negative or not finite")?;
            check_spectrum(&reradiation.reflectance)?;
            check_fluorescence(&reradiation.fluorescence)
        }
    }
}

/// Expressions are sound by construction.
fn check_varying(varying: &Varying) -> Check {
    require(!varying.parts.is_empty(), "a varying bsdf has no parts")?;
    require(invert(&varying.texture_from_object).is_some(), "the map is not finite and invertible")?;
    for part in &varying.parts {
        require(!matches!(part.bsdf, Bsdf::Varying(_)), "a part of a varying bsdf varies itself")?;
        check_bsdf(&part.bsdf)?;
        for parameter in &part.parameters {
            let fits = match parameter {
                Parameter::Reflectance(texture) => {
                    texture.terms.iter().try_for_each(|term| check_spectrum(&term.spectrum))?;
                    matches!(
                        part.bsdf,
                        Bsdf::Lambert { .. } | Bsdf::OrenNayar { .. } | Bsdf::Phong { .. } | Bsdf::Mirror { .. }
                    )
                }
                Parameter::Sigma(_) => matches!(part.bsdf, Bsdf::OrenNayar { .. }),
                Parameter::Exponent(_) => matches!(part.bsdf, Bsdf::Phong { .. }),
                Parameter::Height(_) | Parameter::Normal(_) => true,
                Parameter::Roughness(_) => {
                    matches!(part.bsdf, Bsdf::RoughConductor { .. } | Bsdf::RoughDielectric { .. })
                }
            };
            require(fits, "a bsdf has no such parameter")?;
        }
    }
    Ok(())
}

fn check_fluorescence(fluorescence: &Fluorescence) -> Check {
    match fluorescence {
        Fluorescence::Dye(dye) => check_dye(dye),
        Fluorescence::Matrix(matrix) => {
            let regular = |[start, step]: [f64; 2]| positive(start) && positive(step);
            let wavelengths = regular(matrix.excitation_nm) && regular(matrix.emission_nm);
            require(wavelengths, "a wavelength of a matrix is not positive and finite")?;
            let whole = matrix.columns > 0 && matrix.rows() > 0 && matrix.entries.len() % matrix.columns == 0;
            require(whole, "a matrix has rows of unlike length")?;
            require(matrix.entries.iter().all(|x| *x >= 0.0 && x.is_finite()), "a matrix is negative or not finite")
        }
    }
}

fn check_dye(dye: &Dye) -> Check {
    require((0.0..=1.0).contains(&dye.quantum_yield), "a quantum yield is not in 0..=1")?;
    check_spectrum(&dye.absorption)?;
    check_spectrum(&dye.emission)
}

fn check_medium(medium: &Medium) -> Check {
    check_spectrum(&medium.absorption)?;
    check_spectrum(&medium.scattering)?;
    check_spectrum(&medium.emission)?;
    medium.dyes.iter().try_for_each(check_dye)?;
    match medium.phase {
        PhaseFunction::Isotropic => {}
        PhaseFunction::HenyeyGreenstein { g } => require(g.abs() < 1.0, "the mean cosine is not in (-1, 1)")?,
        PhaseFunction::Rayleigh { depolarisation } => {
            require((0.0..=0.5).contains(&depolarisation), "the depolarisation is not in 0..=1/2")?;
        }
    }
    match &medium.density {
        Density::Uniform => Ok(()),
        Density::Gaussian { center, sigma } => {
            require(center.is_finite(), "a position is not finite")?;
            require(positive(*sigma), "a size is not positive and finite")
        }
        Density::Exponential { ground, height } => {
            require(ground.is_finite(), "a position is not finite")?;
            require(positive(*height), "a size is not positive and finite")
        }
    }
}

fn check_facets(facets: &Facets) -> Check {
    require(facets.alpha.iter().all(|alpha| (0.0..=1.0).contains(alpha)), "a roughness is not in 0..=1")
}

fn check_spectrum(spectrum: &Spectrum) -> Check {
    check_spectrum_at(spectrum, 0)
}

fn check_spectrum_at(spectrum: &Spectrum, depth: usize) -> Check {
    require(depth < MAX_SPECTRUM_DEPTH, "a spectrum nests too deeply")?;
    let finite = |values: &[f64]| require(values.iter().all(|x| x.is_finite()), "a spectrum is not finite");
    match spectrum {
        Spectrum::Constant(value) => finite(&[*value]),
        Spectrum::Tabulated { lambda_nm, values } => {
            require(!values.is_empty(), "a tabulated spectrum has no knots")?;
            require(lambda_nm.len() == values.len(), "a tabulated spectrum has columns of unlike length")?;
            require(lambda_nm.windows(2).all(|w| w[0] < w[1]), "the wavelengths of a spectrum do not increase")?;
            finite(lambda_nm).and(finite(values))
        }
        Spectrum::Blackbody { kelvin } => require(positive(*kelvin), "a temperature is not positive and finite"),
        Spectrum::Gaussian { center_nm, sigma_nm, peak } => {
            require(*sigma_nm > 0.0, "the width of a spectrum is not positive")?;
            finite(&[*center_nm, *sigma_nm, *peak])
        }
        Spectrum::Sellmeier { a, b, c_um2 } => {
            require(b.len() == c_um2.len(), "a Sellmeier formula has columns of unlike length")?;
            finite(&[*a]).and(finite(b)).and(finite(c_um2))
        }
        Spectrum::Cauchy { a, b_um2, c_um4 } => finite(&[*a, *b_um2, *c_um4]),
        // Infinite coefficients stand for black and white.
        Spectrum::Sigmoid { coefficients } => {
            require(coefficients.iter().all(|x| !x.is_nan()), "a spectrum is not a number")
        }
        Spectrum::Absorbance { transmission, thickness } => {
            require(positive(*thickness), "the thickness of an absorbance is not positive and finite")?;
            check_spectrum_at(transmission, depth + 1)
        }
        Spectrum::Scaled { factor, spectrum } => finite(&[*factor]).and(check_spectrum_at(spectrum, depth + 1)),
        Spectrum::Product(a, b) | Spectrum::Sum(a, b) => {
            check_spectrum_at(a, depth + 1).and_then(|()| check_spectrum_at(b, depth + 1))
        }
    }
}

fn check_action(action: &Action) -> Check {
    let sampling = match action {
        Action::PathTrace(trace) => {
            require(positive(trace.band_nm), "the width of the bands is not positive and finite")?;
            &trace.sampling
        }
        Action::AmbientOcclusion { distance, sampling } => {
            require(*distance > 0.0, "the distance is not positive")?;
            sampling
        }
        Action::Preview { sampling, .. } => sampling,
        Action::ToneMap { tone, slice_nm } => {
            return require(is_valid_tone_map(tone, *slice_nm), "a number is outside of what is allowed");
        }
        Action::Image(action) => return require(action.is_valid(), "a number is outside of what is allowed"),
        _ => return Ok(()),
    };
    let limits = [sampling.noise, sampling.time_limit];
    require(limits.into_iter().flatten().all(positive), "a limit of samples is not positive and finite")
}

fn check_camera(camera: &Camera) -> Check {
    let Camera { projection, eye, target, up, twist, fit, resolution, pixel_aspect, crop, .. } = camera;
    let point = target.unwrap_or(*eye + up.any_orthogonal_vector());
    require(eye.is_finite() && point.is_finite() && up.is_finite(), "a position is not finite")?;
    require((point - *eye).cross(*up).length_squared() > 0.0, "the view direction and up do not span a plane")?;
    require(resolution.iter().all(|&pixels| pixels > 0), "the image has no pixels")?;
    require(twist.is_finite(), "the twist is not finite")?;
    require(positive(*pixel_aspect), "the shape of pixels is not positive and finite")?;
    require(fit.is_none_or(|margin| (0.0..1.0).contains(&margin)), "the margin is not in [0, 1)")?;
    let within = |[left, top, right, bottom]: [f64; 4]| {
        0.0 <= left && left < right && right <= 1.0 && 0.0 <= top && top < bottom && bottom <= 1.0
    };
    require(crop.is_none_or(within), "the crop is not within the picture")?;
    let flat = |fov: f64| require(fov > 0.0 && fov < PI, "the field of view is not in (0, pi)");
    match projection {
        Projection::Perspective { fov, .. } => flat(*fov),
        Projection::ThinLens { fov, lens, .. } => {
            flat(*fov)?;
            require(lens.radius >= 0.0 && lens.radius.is_finite(), "the radius of the lens is negative or not finite")?;
            match lens.focus {
                Focus::Distance(distance) => require(positive(distance), "the focus is not positive and finite"),
                Focus::Point(point) => require(point.is_finite(), "the focus is not finite"),
                Focus::Target => Ok(()),
            }
        }
        Projection::Orthographic { extent, .. } => require(positive(*extent), "the extent is not positive and finite"),
        Projection::Fisheye { fov, .. } => {
            require(*fov > 0.0 && *fov <= 2.0 * PI, "the field of view is not in (0, 2 pi]")
        }
        Projection::Panorama => require(fit.is_none(), "a panorama shows all directions"),
    }
}

#[cfg(test)]
mod tests {
    use crate::{read, verify};

    fn violations(statements: &str) -> Vec<String> {
        let text = format!("ir 1\nbsdf b0 = lambert(reflectance: constant(0.5))\n{statements}");
        let ir = read(&text).unwrap_or_else(|error| panic!("{error} in\n{text}"));
        verify(&ir).err().unwrap_or_default().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_sound_scene_verifies() {
        let text = "%0 = sphere(radius: 1.0) @0:0..1\n%1 = point_light(intensity: constant(1.0)) @0:0..1\n\
                    %2 = union(%0, %1) @0:0..1\n%3 = half_space() @0:0..1\n%4 = intersection(%2, %3) @0:0..1\nroot %4";
        assert_eq!(violations(text), Vec::<String>::new());
    }

    #[test]
    fn each_broken_invariant_is_named() {
        let cases = [
            ("%0 = sphere(radius: -1.0) @0:0..1\nroot %0", "%0: a size is not positive and finite"),
            ("%0 = sphere(radius: NaN) @0:0..1\nroot %0", "%0: a size is not positive and finite"),
            (
                "%0 = box(min: [0.0, 0.0, 0.0], max: [1.0, 0.0, 1.0]) @0:0..1\nroot %0",
                "%0: a size is not positive and finite",
            ),
            (
                "%0 = half_space(map: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) @0:0..1\nroot %0",
                "%0: the map is not finite and invertible",
            ),
            ("%0 = plane(at: [inf, 0.0, 0.0]) @0:0..1\nroot %0", "%0: the map is not finite and invertible"),
            ("%0 = plane() @0:0..1\n%1 = difference(%0) @0:0..1\nroot %1", "%1: an operand is no solid"),
            (
                "%0 = half_space() @0:0..1\n%1 = plane() @0:0..1\n%2 = union(%0, %1) @0:0..1\n\
                 %3 = intersection(%2, %0) @0:0..1\nroot %3",
                "%3: an operand holds an open surface or a group",
            ),
            ("%0 = intersection() @0:0..1\nroot %0", "%0: a Boolean node has no operands"),
            (
                "bsdf b1 = mirror(reflectance: tabulated(lambda_nm: [2.0, 1.0], values: [0.0, 0.0]))\n\
                 %0 = half_space() @0:0..1\nroot %0",
                "b1: the wavelengths of a spectrum do not increase",
            ),
            (
                "%0 = half_space() @0:0..1\nroot %0\ncamera fisheye(mapping: equal_area, fov: 6.3, eye: [0.0, 0.0, 0.0], \
                 up: [0.0, 0.0, 1.0], resolution: [1, 1], filter: box(radius: 0.5))",
                "camera: the field of view is not in (0, 2 pi]",
            ),
            (
                "%0 = half_space() @0:0..1\nroot %0\ncamera panorama(eye: [0.0, 0.0, 0.0], up: [0.0, 0.0, 1.0], \
                 resolution: [1, 1], crop: [0.5, 0.0, 0.5, 1.0], filter: box(radius: 0.5))",
                "camera: the crop is not within the picture",
            ),
            (
                "%0 = half_space() @0:0..1\nroot %0\naction preview(samples: 1, seed: 0, noise: 0.0) @0:0..1",
                "action 0: a limit of samples is not positive and finite",
            ),
            (
                "%0 = distant_light(irradiance: constant(1.0), direction: [0.0, 0.0, 2.0]) @0:0..1\nroot %0",
                "%0: the direction is not a unit vector",
            ),
        ];
        let medium =
            "medium v0 = medium(absorption: constant(0.0), scattering: constant(1.0), emission: constant(0.0), ";
        let media = [
            ("phase: henyey_greenstein(g: 1.0), density: uniform())", "v0: the mean cosine is not in (-1, 1)"),
            (
                "phase: isotropic(), density: exponential(ground: 0.0, height: -1.0))",
                "v0: a size is not positive and finite",
            ),
        ];
        for (text, expected) in media {
            let text = format!("{medium}{text}\n%0 = half_space() @0:0..1\nroot %0");
            assert_eq!(violations(&text), [expected], "{text}");
        }
        for (text, expected) in cases {
            assert_eq!(violations(text), [expected], "{text}");
        }
    }
}
