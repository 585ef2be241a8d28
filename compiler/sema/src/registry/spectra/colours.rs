//! Smooth spectra that have a colour: sigmoids of a quadratic in wavelength (Jakob and Hanika 2019), solved here.
//!
//! The eye is the CIE 1931 observer's. Emissions are such a sigmoid times the spectrum of D65, scaled to twice the largest
//! component or more, so that the sigmoid need not be steep.

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::Spectrum;
use arsc_spectral::{colour, d65, srgb, uplift_rgb, uplift_xyz, xyz_of_reflectance};
use glam::DVec3;

use super::super::{Builtin, Param};
use super::kind;
use crate::code::Site;
use crate::eval::Eval;
use crate::types::SpectrumKind::{Emission, Reflectance, Transmission};
use crate::types::Type::{self, Float};
use crate::value::Value;

/// Errors of X, Y or Z relative to white above this are reported; the uplift keeps 1/2000 away from 0 and 1.
const LARGEST_ERROR: f64 = 0.003;

/// Reflectances of the brightest sample of a colour that emissions try, in turn.
const HEADROOM: [f64; 4] = [0.5, 0.2, 0.05, 0.01];

pub fn builtins() -> Vec<Builtin> {
    let component = |name| Param::new(name, Float, "linear sRGB component").within(0.0, 1.0);
    let rgb = |name, doc| Builtin::new(name, doc).param(component("r")).param(component("g")).param(component("b"));
    let brightness = |name| Param::new(name, Float, "linear sRGB component").non_negative();
    vec![
        rgb("rgb", "A smooth reflectance with this linear sRGB colour under D65 (Jakob and Hanika 2019).")
            .runs(kind(Reflectance), |_, args, _| of_rgb(args)),
        rgb("rgb_transmission", "A smooth transmission with this linear sRGB colour in the light of D65.")
            .runs(kind(Transmission), |_, args, _| of_rgb(args)),
        Builtin::new("rgb_emission", "A smooth emission with this linear sRGB colour; (1, 1, 1) is `d65`.")
            .param(brightness("r"))
            .param(brightness("g"))
            .param(brightness("b"))
            .runs(kind(Emission), |_, args, site| {
                let rgb = DVec3::from_array(triple(args));
                emission((srgb::xyz_from_rgb() * rgb).to_array(), site)
            }),
        colour_of("xyz", "A smooth reflectance with these tristimulus values; the perfect diffuser has y = 1.", XYZ)
            .runs(kind(Reflectance), |_, args, site| reflectance(triple(args), args, site)),
        colour_of("xyy", "A smooth reflectance of this chromaticity and luminance factor.", XYY)
            .runs(kind(Reflectance), |_, args, site| reflectance(from_xyy(args, site)?, args, site)),
        colour_of("lab", "A smooth reflectance with this CIE L*a*b* colour; white is that of the illuminant.", LAB)
            .runs(kind(Reflectance), |_, args, site| {
                let white = xyz_of_reflectance(&Spectrum::Constant(1.0), args[3].as_spectrum());
                reflectance(colour::xyz_from_lab(triple(args), white), args, site)
            }),
        components(
            "xyz_emission",
            "A smooth emission with these tristimulus values; the luminance of `d65` is 1.",
            XYZ,
        )
        .runs(kind(Emission), |_, args, site| emission(triple(args), site)),
        components("xyy_emission", "A smooth emission of this chromaticity; the luminance of `d65` is 1.", XYY)
            .runs(kind(Emission), |_, args, site| emission(from_xyy(args, site)?, site)),
    ]
}

type Components = [(&'static str, &'static str); 3];

const XYZ: Components = [("x", "CIE X"), ("y", "CIE Y"), ("z", "CIE Z")];
const XYY: Components = [("x", "chromaticity x"), ("y", "chromaticity y"), ("luminance", "CIE Y")];
const LAB: Components = [("l", "lightness, 0 to 100"), ("a", "green to red"), ("b", "blue to yellow")];

fn components(name: &'static str, doc: &'static str, components: Components) -> Builtin {
    components.into_iter().fold(Builtin::new(name, doc), |builtin, (name, doc)| {
        let param = Param::new(name, Float, doc);
        builtin.param(if matches!(name, "a" | "b") { param } else { param.non_negative() })
    })
}

/// With the illuminant under which the colour is seen.
fn colour_of(name: &'static str, doc: &'static str, of: Components) -> Builtin {
    let d65 = Value::spectrum(d65().clone());
    let light = Param::new("illuminant", Type::Spectrum(Emission), "in whose light the colour is seen");
    components(name, doc, of).param(light.default_value("d65", d65))
}

fn triple(args: &[Value]) -> [f64; 3] {
    std::array::from_fn(|i| args[i].as_float())
}

fn from_xyy(args: &[Value], site: &Site) -> Eval<[f64; 3]> {
    let [x, y, luminance] = triple(args);
    if y > 0.0 && x + y <= 1.0 {
        return Ok(colour::xyz_from_xyy([x, y, luminance]));
    }
    let message = format!("no light has the chromaticity x = {x}, y = {y}");
    Err(site.fail_arg(1, codes::OUT_OF_RANGE, message, "y must be positive, and x + y at most 1"))
}

fn of_rgb(args: &[Value]) -> Eval {
    Ok(Value::spectrum(Spectrum::Sigmoid { coefficients: uplift_rgb(triple(args)) }))
}

fn reflectance(xyz: [f64; 3], args: &[Value], site: &Site) -> Eval {
    let (coefficients, error) = uplift_xyz(xyz, args[3].as_spectrum());
    if error <= LARGEST_ERROR {
        return Ok(Value::spectrum(Spectrum::Sigmoid { coefficients }));
    }
    let failure = site.fail(codes::OUT_OF_RANGE, "no smooth reflectance has this colour");
    Err(Box::new(failure.help("so saturated a colour must be darker")))
}

fn emission(xyz: [f64; 3], site: &Site) -> Eval {
    let white = xyz_of_reflectance(&Spectrum::Constant(1.0), d65());
    let largest = (0..3).map(|c| xyz[c] / white[c]).fold(0.0, f64::max);
    if largest == 0.0 {
        return Ok(Value::spectrum(Spectrum::Constant(0.0)));
    }
    for headroom in HEADROOM {
        let scale = largest / headroom;
        let (coefficients, error) = uplift_xyz(xyz.map(|c| c / scale), d65());
        if error <= LARGEST_ERROR * headroom {
            let (shape, d65) = (Spectrum::Sigmoid { coefficients }, d65().clone());
            let product = Spectrum::Product(shape.into(), d65.into());
            return Ok(Value::spectrum(Spectrum::Scaled { factor: scale, spectrum: product.into() }));
        }
    }
    let failure = site.fail(codes::OUT_OF_RANGE, "no smooth emission has this colour");
    Err(Box::new(failure.help("it lies too close to, or beyond, the colours of single wavelengths")))
}
