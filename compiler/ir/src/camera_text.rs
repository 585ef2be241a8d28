//! The text form of cameras and filters. Arguments that have their usual value are left out.

use std::fmt::{self, Display, Formatter};

use crate::args::{Args, float, floats, integer, named};
use crate::print::Text;
use crate::term::{Fault, Term, TermKind};
use crate::write::{Call, Floats};
use crate::{Across, Camera, Filter, FisheyeMapping, Focus, Lens, Projection};

fn print_across<'a, 'b>(call: Call<'a, 'b>, across: Across) -> Result<Call<'a, 'b>, fmt::Error> {
    match across {
        Across::Shorter => Ok(call),
        other => call.arg("across", other.name()),
    }
}

impl Display for Text<'_, Camera> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let camera = self.0;
        let mut call = match camera.projection {
            Projection::Perspective { fov, across } => {
                print_across(Call::new(f, "perspective")?.float("fov", fov)?, across)?
            }
            Projection::ThinLens { fov, across, lens } => {
                print_across(Call::new(f, "thin_lens")?.float("fov", fov)?, across)?.arg("lens", Text(&lens))?
            }
            Projection::Orthographic { extent, across } => {
                print_across(Call::new(f, "orthographic")?.float("extent", extent)?, across)?
            }
            Projection::Fisheye { mapping, fov, across } => {
                print_across(Call::new(f, "fisheye")?.arg("mapping", mapping.name())?.float("fov", fov)?, across)?
            }
            Projection::Panorama => Call::new(f, "panorama")?,
        };
        call = call.point("eye", camera.eye)?;
        if let Some(target) = camera.target {
            call = call.point("target", target)?;
        }
        call = call.point("up", camera.up)?;
        if camera.twist != 0.0 {
            call = call.float("twist", camera.twist)?;
        }
        if let Some(margin) = camera.fit {
            call = call.float("fit", margin)?;
        }
        let [width, height] = camera.resolution;
        call = call.arg("resolution", format_args!("[{width}, {height}]"))?;
        if camera.pixel_aspect != 1.0 {
            call = call.float("pixel_aspect", camera.pixel_aspect)?;
        }
        if let Some(crop) = &camera.crop {
            call = call.arg("crop", Floats(crop))?;
        }
        call.arg("filter", Text(&camera.filter))?.end()
    }
}

impl Display for Text<'_, Lens> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Lens { radius, blades, rotation, focus } = *self.0;
        let call = Call::new(f, "lens")?.float("radius", radius)?.arg("blades", blades)?.float("rotation", rotation)?;
        match focus {
            Focus::Distance(distance) => call.float("focus", distance)?.end(),
            Focus::Point(point) => call.point("focus_on", point)?.end(),
            Focus::Target => call.end(),
        }
    }
}

impl Display for Text<'_, Filter> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self.0 {
            Filter::Box { radius } => Call::new(f, "box")?.float("radius", radius)?.end(),
            Filter::Tent { radius } => Call::new(f, "tent")?.float("radius", radius)?.end(),
            Filter::Gaussian { radius, sigma } => {
                Call::new(f, "gaussian")?.float("radius", radius)?.float("sigma", sigma)?.end()
            }
            Filter::Mitchell { radius, b, c } => {
                Call::new(f, "mitchell")?.float("radius", radius)?.float("b", b)?.float("c", c)?.end()
            }
            Filter::Lanczos { radius } => Call::new(f, "lanczos")?.float("radius", radius)?.end(),
        }
    }
}

pub(crate) fn read_camera(term: Term) -> Result<Camera, Fault> {
    let mut args = Args::new(term)?;
    let projection = match args.name {
        "perspective" => Projection::Perspective { fov: args.float("fov")?, across: across(&mut args)? },
        "thin_lens" => Projection::ThinLens {
            fov: args.float("fov")?,
            across: across(&mut args)?,
            lens: read_lens(args.take("lens")?)?,
        },
        "orthographic" => Projection::Orthographic { extent: args.float("extent")?, across: across(&mut args)? },
        "fisheye" => {
            let mapping = args.take("mapping")?;
            Projection::Fisheye {
                mapping: named(&mapping, &FisheyeMapping::ALL, FisheyeMapping::name)?,
                fov: args.float("fov")?,
                across: across(&mut args)?,
            }
        }
        "panorama" => Projection::Panorama,
        _ => return args.unknown("camera"),
    };
    let resolution = args.take("resolution")?;
    let camera = Camera {
        projection,
        eye: args.point("eye")?,
        target: args.optional("target").map(|target| floats(&target)).transpose()?.map(Into::into),
        up: args.point("up")?,
        twist: optional_float(&mut args, "twist")?.unwrap_or(0.0),
        fit: optional_float(&mut args, "fit")?,
        resolution: match &resolution.kind {
            TermKind::List(items) if items.len() == 2 => [integer(&items[0])?, integer(&items[1])?],
            _ => return Err((resolution.offset, "expected `[width, height]`".to_owned())),
        },
        pixel_aspect: optional_float(&mut args, "pixel_aspect")?.unwrap_or(1.0),
        crop: args.optional("crop").map(|crop| floats(&crop)).transpose()?,
        filter: read_filter(args.take("filter")?)?,
    };
    args.end()?;
    Ok(camera)
}

fn optional_float(args: &mut Args, name: &str) -> Result<Option<f64>, Fault> {
    args.optional(name).map(|term| float(&term)).transpose()
}

fn across(args: &mut Args) -> Result<Across, Fault> {
    args.optional("across").map_or(Ok(Across::Shorter), |term| named(&term, &Across::ALL, Across::name))
}

fn read_lens(term: Term) -> Result<Lens, Fault> {
    let mut args = Args::new(term)?;
    if args.name != "lens" {
        return args.unknown("lens");
    }
    let focus = match (optional_float(&mut args, "focus")?, args.optional("focus_on")) {
        (Some(distance), _) => Focus::Distance(distance),
        (None, Some(point)) => Focus::Point(floats(&point)?.into()),
        (None, None) => Focus::Target,
    };
    let lens = Lens {
        radius: args.float("radius")?,
        blades: args.integer("blades")?,
        rotation: args.float("rotation")?,
        focus,
    };
    args.end()?;
    Ok(lens)
}

fn read_filter(term: Term) -> Result<Filter, Fault> {
    let mut args = Args::new(term)?;
    let radius = args.float("radius")?;
    let filter = match args.name {
        "box" => Filter::Box { radius },
        "tent" => Filter::Tent { radius },
        "gaussian" => Filter::Gaussian { radius, sigma: args.float("sigma")? },
        "mitchell" => Filter::Mitchell { radius, b: args.float("b")?, c: args.float("c")? },
        "lanczos" => Filter::Lanczos { radius },
        _ => return args.unknown("filter"),
    };
    args.end()?;
    Ok(filter)
}
