//! Lights that are no geometry, and environments. Emitting geometry is `with(emitter(…))`.

use arsc_ir::{Environment, Light, NodeKind, Sky, SkyModel};

use super::{Builtin, Param};
use crate::types::SpectrumKind::Emission;
use crate::types::Type::{self, Bool, Direction, Float, Spectrum};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    vec![
        Builtin::new("point_light", "A point at the origin that shines in all directions.")
            .param(Param::new("intensity", Spectrum(Emission), "W sr^-1 nm^-1"))
            .runs(Type::Light, |m, args, site| {
                m.lint_emission(&args[0], site, 0);
                let intensity = args[0].as_spectrum().as_ref().clone();
                m.node(NodeKind::Light(Box::new(Light::Point { intensity })), site.span).map(Value::Node)
            }),
        Builtin::new("distant_light", "Parallel light from infinitely far.")
            .param(Param::new("irradiance", Spectrum(Emission), "across the beam, W m^-2 nm^-1"))
            .param(Param::new("direction", Direction, "in which the light travels"))
            .runs(Type::Light, |m, args, site| {
                m.lint_emission(&args[0], site, 0);
                let light =
                    Light::Distant { irradiance: args[0].as_spectrum().as_ref().clone(), direction: args[1].as_vec3() };
                m.node(NodeKind::Light(Box::new(light)), site.span).map(Value::Node)
            }),
        Builtin::new("environment", "An infinite sphere of constant radiance.")
            .param(Param::new("radiance", Spectrum(Emission), "W m^-2 sr^-1 nm^-1"))
            .runs(Type::Environment, |m, args, site| {
                m.lint_emission(&args[0], site, 0);
                let environment = Environment::Constant { radiance: args[0].as_spectrum().as_ref().clone() };
                m.node(NodeKind::Environment(Box::new(environment)), site.span).map(Value::Node)
            }),
        sky(),
        Builtin::new(
            "environment_map",
            "An infinite sphere with a picture in latitude and longitude on it; its top is at +z, its middle at +x.",
        )
        .param(Param::new(
            "path",
            Type::Str,
            "PNG, TIFF, HDR or EXR file of colours, or EXR file of spectra, relative to the script",
        ))
        .param(Param::new("scale", Float, "factor on the radiance").float(1.0).non_negative())
        .runs(Type::Environment, |m, args, site| {
            let (path, image) = m.picture(args[0].as_str(), site)?;
            let environment = Environment::Image { path, image, scale: args[1].as_float() };
            m.node(NodeKind::Environment(Box::new(environment)), site.span).map(Value::Node)
        }),
        Builtin::new("spot_light", "A point at the origin that shines along +z into a cone; `look_at` aims it.")
            .param(Param::new("intensity", Spectrum(Emission), "along the axis, W sr^-1 nm^-1"))
            .param(Param::new("angle", Type::Angle, "half angle of the cone").degrees(30.0).degrees_between(0.0, 90.0))
            .param(
                Param::new("exponent", Float, "of the cosine with which it falls from the axis")
                    .float(0.0)
                    .within(0.0, 1e6),
            )
            .runs(Type::Light, |m, args, site| {
                m.lint_emission(&args[0], site, 0);
                let intensity = args[0].as_spectrum().as_ref().clone();
                let light = Light::Spot { intensity, angle: args[1].as_float(), exponent: args[2].as_float() };
                m.node(NodeKind::Light(Box::new(light)), site.span).map(Value::Node)
            }),
        Builtin::new("ies_light", "A lamp at the origin with a measured distribution of light; its nadir is -z.")
            .param(Param::new("path", Type::Str, "IES LM-63 file of type C, relative to the script"))
            .param(
                Param::new("spectrum", Spectrum(Emission), "colour of its light, of any scale").default_value(
                    "blackbody(2856K)",
                    Value::spectrum(arsc_ir::Spectrum::Blackbody { kelvin: 2856.0 }),
                ),
            )
            .param(Param::new("scale", Float, "factor on its intensity").float(1.0).non_negative())
            .runs(Type::Light, |m, args, site| {
                m.lint_emission(&args[1], site, 1);
                let web = m.photometric_web(args[0].as_str(), args[2].as_float(), site)?;
                let light = Light::Photometric { web, spectrum: args[1].as_spectrum().as_ref().clone() };
                m.node(NodeKind::Light(Box::new(light)), site.span).map(Value::Node)
            }),
    ]
}

fn sky() -> Builtin {
    Builtin::new("sky", "A clear sky with its sun; z is up. Several of them make a sky with several suns.")
        .param(
            Param::new(
                "model",
                Type::SkyModel,
                "`hosek_wilkie` (Hosek and Wilkie 2012, 2013) or `preetham` (Preetham and others 1999)",
            )
            .default_value("hosek_wilkie", Value::SkyModel(SkyModel::HosekWilkie)),
        )
        .param(Param::new("turbidity", Float, "haze: 2 very clear, 10 hazy").float(3.0).within(1.0, 10.0))
        .param(Param::new("sun", Direction, "towards the sun"))
        .param(
            Param::new("ground_albedo", Float, "reflectance of the ground; `preetham` knows none")
                .float(0.2)
                .within(0.0, 1.0),
        )
        .param(Param::new("solar_disc", Bool, "whether the sun itself is in the sky").bool(true))
        .param(Param::new("scale", Float, "factor on the radiance").float(1.0).non_negative())
        .param(
            Param::new("star_temperature", Float, "kelvin, of a star in the sun's place; else the sun")
                .optional()
                .within(2000.0, 50_000.0),
        )
        .param(
            Param::new("star_intensity", Float, "irradiance beyond the air, relative to the sun's")
                .float(1.0)
                .within(0.0, 100.0),
        )
        .param(Param::new("polarised", Bool, "skylight is polarised, in polarised renders").bool(false))
        .runs(Type::Environment, |m, args, site| {
            m.lint_sun(&args[2], site, 2);
            let sky = Sky {
                model: args[0].as_sky_model(),
                turbidity: args[1].as_float(),
                sun: args[2].as_vec3(),
                ground_albedo: args[3].as_float(),
                solar_disc: args[4].as_bool(),
                scale: args[5].as_float(),
                star_temperature: args[6].is_given().then(|| args[6].as_float()),
                star_intensity: args[7].as_float(),
                polarised: args[8].as_bool(),
            };
            m.node(NodeKind::Environment(Box::new(Environment::Sky(sky))), site.span).map(Value::Node)
        })
}
