//! The text form of lights and environments: written and read back.

use std::fmt::{self, Display, Formatter};
use std::sync::Arc;

use arsc_spectral::PhotometricWeb;

use crate::args::{Args, float, float_list, index};
use crate::print::{Quoted, Text};
use crate::read::{Contents, spectrum};
use crate::term::Fault;
use crate::write::{Call, Floats};
use crate::{Environment, Ir, Light, Sky, SkyModel};

impl Display for Text<'_, Light> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Light::Point { intensity } => Call::new(f, "point_light")?.arg("intensity", Text(intensity))?.end(),
            Light::Spot { intensity, exponent, angle } => Call::new(f, "spot_light")?
                .arg("intensity", Text(intensity))?
                .float("exponent", *exponent)?
                .float("angle", *angle)?
                .end(),
            Light::Photometric { web, spectrum } => Call::new(f, "photometric_light")?
                .arg("vertical", Floats(web.vertical()))?
                .arg("horizontal", Floats(web.horizontal()))?
                .arg("candela", Floats(web.candela()))?
                .arg("spectrum", Text(spectrum))?
                .end(),
            Light::Distant { irradiance, direction } => Call::new(f, "distant_light")?
                .arg("irradiance", Text(irradiance))?
                .point("direction", *direction)?
                .end(),
        }
    }
}

impl Display for Text<'_, Environment> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Environment::Constant { radiance } => {
                Call::new(f, "constant_environment")?.arg("radiance", Text(radiance))?.end()
            }
            Environment::Medium { medium } => Call::new(f, "atmosphere")?.index("medium", "v", Some(*medium))?.end(),
            Environment::Image { path, scale, .. } => {
                Call::new(f, "image_environment")?.arg("path", Quoted(path))?.float("scale", *scale)?.end()
            }
            Environment::Sky(sky) => {
                let call = Call::new(f, sky.model.name())?
                    .float("turbidity", sky.turbidity)?
                    .float("ground_albedo", sky.ground_albedo)?
                    .point("sun", sky.sun)?
                    .arg("solar_disc", sky.solar_disc)?
                    .float("scale", sky.scale)?;
                let call = match sky.star_temperature {
                    None => call,
                    Some(kelvin) => call.float("star_temperature", kelvin)?,
                };
                call.float("star_intensity", sky.star_intensity)?.arg("polarised", sky.polarised)?.end()
            }
        }
    }
}

/// `None` for what is no light.
pub(crate) fn light(args: &mut Args) -> Result<Option<Light>, Fault> {
    Ok(Some(match args.name {
        "point_light" => Light::Point { intensity: spectrum(args.take("intensity")?)? },
        "spot_light" => Light::Spot {
            intensity: spectrum(args.take("intensity")?)?,
            exponent: args.float("exponent")?,
            angle: args.float("angle")?,
        },
        "photometric_light" => {
            let offset = args.offset;
            let (vertical, horizontal) = (float_list(&args.take("vertical")?)?, float_list(&args.take("horizontal")?)?);
            let web = PhotometricWeb::new(vertical, horizontal, float_list(&args.take("candela")?)?)
                .map_err(|error| (offset, error.to_string()))?;
            Light::Photometric { web: Arc::new(web), spectrum: spectrum(args.take("spectrum")?)? }
        }
        "distant_light" => {
            Light::Distant { irradiance: spectrum(args.take("irradiance")?)?, direction: args.point("direction")? }
        }
        _ => return Ok(None),
    }))
}

/// `None` for what is no environment.
pub(crate) fn environment(args: &mut Args, ir: &Ir, contents: &dyn Contents) -> Result<Option<Environment>, Fault> {
    Ok(Some(match args.name {
        "constant_environment" => Environment::Constant { radiance: spectrum(args.take("radiance")?)? },
        "atmosphere" => Environment::Medium { medium: index(&args.take("medium")?, 'v', ir.media.len())? },
        "image_environment" => {
            let path: Arc<str> = args.text("path")?.into();
            let image = contents.image(&path).ok_or_else(|| (args.offset, format!("there is no image `{path}`")))?;
            Environment::Image { path, image, scale: args.float("scale")? }
        }
        name => match SkyModel::ALL.into_iter().find(|model| model.name() == name) {
            Some(model) => Environment::Sky(sky(args, model)?),
            None => return Ok(None),
        },
    }))
}

fn sky(args: &mut Args, model: SkyModel) -> Result<Sky, Fault> {
    Ok(Sky {
        model,
        turbidity: args.float("turbidity")?,
        ground_albedo: args.float("ground_albedo")?,
        sun: args.point("sun")?,
        solar_disc: args.boolean("solar_disc")?,
        scale: args.float("scale")?,
        star_temperature: args.optional("star_temperature").map(|term| float(&term)).transpose()?,
        star_intensity: args.float("star_intensity")?,
        polarised: args.boolean("polarised")?,
    })
}
