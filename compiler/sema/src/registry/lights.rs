//! Lights that are no geometry, and environments. Emitting geometry is `with(emitter(…))`.

use arsc_ir::{Environment, Light, NodeKind};

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
        Builtin::new("sky", "A clear sky with its sun; z is up.")
            .param(
                Param::new("model", Type::SkyModel, "`hosek_wilkie` (Hosek and Wilkie 2012, 2013)")
                    .default_value("hosek_wilkie", Value::Only),
            )
            .param(Param::new("turbidity", Float, "haze: 2 very clear, 10 hazy").float(3.0).within(1.0, 10.0))
            .param(Param::new("sun", Direction, "towards the sun"))
            .param(Param::new("ground_albedo", Float, "reflectance of the ground").float(0.2).within(0.0, 1.0))
            .param(Param::new("solar_disc", Bool, "whether the sun itself is in the sky").bool(true))
            .param(Param::new("scale", Float, "factor on the radiance").float(1.0).non_negative())
            .runs(Type::Environment, |m, args, site| {
                m.lint_sun(&args[2], site, 2);
                let environment = Environment::HosekWilkie {
                    turbidity: args[1].as_float(),
                    sun: args[2].as_vec3(),
                    ground_albedo: args[3].as_float(),
                    solar_disc: args[4].as_bool(),
                    scale: args[5].as_float(),
                };
                m.node(NodeKind::Environment(Box::new(environment)), site.span).map(Value::Node)
            }),
        Builtin::new("environment_map", "An infinite sphere with an image on it.")
            .param(Param::new("path", Type::Str, "image file, relative to the script"))
            .later(Type::Environment, "the environment map"),
        Builtin::new("spot_light", "A point that shines into a cone.")
            .param(Param::new("intensity", Spectrum(Emission), "W sr^-1 nm^-1"))
            .param(Param::new("angle", Type::Angle, "half angle of the cone").degrees(30.0).degrees_between(0.0, 90.0))
            .later(Type::Light, "the spot light"),
    ]
}
