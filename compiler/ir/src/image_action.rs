//! Actions on pictures, and their text form.

use std::fmt::{self, Display, Formatter};

use arsc_spectral::adaptation::Adaptation;
use arsc_spectral::colour_space::ColourSpace;
use arsc_spectral::pictures::{Metric, Overlay, Quantity, Question, View};
use arsc_spectral::tone::{Calibration, Curve, Exposure, Gamut, ToneMap};

use crate::args::{Args, float, floats, integer};
use crate::print::{Quoted, Text};
use crate::term::{Fault, Term, TermKind};
use crate::write::{Call, Float, Floats};

#[derive(Clone, Debug, PartialEq)]
pub enum ImageAction {
    /// `image<spectral> → image<spectral>`: radians from the horizontal, strength from 0 to 1.
    LinearPolariser { angle: f64, strength: f64 },
    /// `image<spectral> → image<spectral>`: radiances times a positive factor.
    Multiply { factor: f64 },
    /// `image<spectral> → image<spectral>`: pixels x0, y0, x1, y1, the end excluded.
    Crop { rectangle: [u32; 4] },
    /// `image<spectral> → image<spectral>`: means of squares of pixels.
    Downscale { factor: u32 },
    /// `image<spectral> image<spectral> → image<spectral>`
    Add,
    /// `image<spectral> image<spectral> → image<spectral>`: the mean by samples.
    Merge,
    /// `image<spectral> → image<spectral>`
    Denoise,
    /// `image<spectral> → image<display>`: prints statistics; the difference `most` has the last colour.
    DifferenceTo { path: String, question: Question, most: Option<f64> },
    /// `image<spectral> → image<display>`
    VisualisePolarisation(View),
}

impl ImageAction {
    /// As scripts call it.
    pub const fn name(&self) -> &'static str {
        match self {
            ImageAction::LinearPolariser { .. } => "linear_polariser",
            ImageAction::Multiply { .. } => "multiply",
            ImageAction::Crop { .. } => "crop",
            ImageAction::Downscale { .. } => "downscale",
            ImageAction::Add => "add",
            ImageAction::Merge => "merge",
            ImageAction::Denoise => "denoise",
            ImageAction::DifferenceTo { .. } => "difference_to",
            ImageAction::VisualisePolarisation(_) => "visualise_polarisation",
        }
    }

    /// Whether the numbers are such as the renderer works with.
    pub(crate) fn is_valid(&self) -> bool {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        match self {
            ImageAction::LinearPolariser { angle, strength } => angle.is_finite() && (0.0..=1.0).contains(strength),
            ImageAction::Multiply { factor } => positive(*factor),
            ImageAction::Crop { rectangle: [x0, y0, x1, y1] } => x0 < x1 && y0 < y1,
            ImageAction::Downscale { factor } => *factor > 0,
            ImageAction::Add | ImageAction::Merge | ImageAction::Denoise => true,
            ImageAction::DifferenceTo { question, most, .. } => {
                question.wavelength_nm.is_none_or(positive) && most.is_none_or(positive)
            }
            ImageAction::VisualisePolarisation(view) => view.wavelength_nm.is_none_or(positive) && positive(view.most),
        }
    }
}

impl Display for Text<'_, ImageAction> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let call = Call::new(f, self.0.name())?;
        match self.0 {
            ImageAction::Add | ImageAction::Merge | ImageAction::Denoise => call.end(),
            ImageAction::LinearPolariser { angle, strength } => {
                call.float("angle", *angle)?.float("strength", *strength)?.end()
            }
            ImageAction::Multiply { factor } => call.float("factor", *factor)?.end(),
            ImageAction::Crop { rectangle: [x0, y0, x1, y1] } => {
                call.arg("x0", x0)?.arg("y0", y0)?.arg("x1", x1)?.arg("y1", y1)?.end()
            }
            ImageAction::Downscale { factor } => call.arg("factor", factor)?.end(),
            ImageAction::DifferenceTo { path, question, most } => {
                let call = call.arg("path", Quoted(path))?.arg("metric", question.metric.name())?;
                let call = optional(call, "wavelength_nm", question.wavelength_nm)?;
                let call = match &question.exposure {
                    Some(exposure) => call.arg("exposure", Text(exposure))?,
                    None => call,
                };
                optional(call, "most", *most)?.end()
            }
            ImageAction::VisualisePolarisation(view) => {
                let call = call.arg("quantity", view.quantity.name())?;
                let call = optional(call, "wavelength_nm", view.wavelength_nm)?.float("most", view.most)?;
                call.arg("overlay", view.overlay.name())?.arg("legend", view.legend)?.end()
            }
        }
    }
}

fn optional<'a, 'b>(call: Call<'a, 'b>, name: &str, value: Option<f64>) -> Result<Call<'a, 'b>, fmt::Error> {
    match value {
        Some(value) => call.float(name, value),
        None => Ok(call),
    }
}

/// The action that the call names, if it is one on pictures.
pub(crate) fn image_action(args: &mut Args<'_>) -> Result<Option<ImageAction>, Fault> {
    Ok(Some(match args.name {
        "linear_polariser" => {
            ImageAction::LinearPolariser { angle: args.float("angle")?, strength: args.float("strength")? }
        }
        "multiply" => ImageAction::Multiply { factor: args.float("factor")? },
        "crop" => {
            let rectangle = [args.integer("x0")?, args.integer("y0")?, args.integer("x1")?, args.integer("y1")?];
            ImageAction::Crop { rectangle }
        }
        "downscale" => ImageAction::Downscale { factor: integer(&args.take("factor")?)? },
        "add" => ImageAction::Add,
        "merge" => ImageAction::Merge,
        "denoise" => ImageAction::Denoise,
        "difference_to" => ImageAction::DifferenceTo {
            path: args.text("path")?,
            question: Question {
                metric: named(&args.take("metric")?, &Metric::ALL, Metric::name)?,
                wavelength_nm: number(args, "wavelength_nm")?,
                exposure: args.optional("exposure").map(exposure).transpose()?,
            },
            most: number(args, "most")?,
        },
        "visualise_polarisation" => ImageAction::VisualisePolarisation(View {
            quantity: named(&args.take("quantity")?, &Quantity::ALL, Quantity::name)?,
            wavelength_nm: number(args, "wavelength_nm")?,
            most: args.float("most")?,
            overlay: named(&args.take("overlay")?, &Overlay::ALL, Overlay::name)?,
            legend: args.boolean("legend")?,
        }),
        _ => return Ok(None),
    }))
}

fn number(args: &mut Args<'_>, name: &str) -> Result<Option<f64>, Fault> {
    args.optional(name).map(|term| float(&term)).transpose()
}

fn named<T: Copy>(term: &Term<'_>, all: &[T], name: fn(T) -> &'static str) -> Result<T, Fault> {
    let found = match term.kind {
        TermKind::Word(word) => all.iter().copied().find(|value| name(*value) == word),
        _ => None,
    };
    found.ok_or_else(|| {
        let names: Vec<String> = all.iter().map(|value| format!("`{}`", name(*value))).collect();
        (term.offset, format!("expected one of {}", names.join(", ")))
    })
}

/// The arguments of `tone_map`; what is as by default is left out.
pub(crate) fn print_tone_map(f: &mut Formatter<'_>, tone: &ToneMap, slice_nm: Option<f64>) -> fmt::Result {
    let usual = ToneMap::default();
    let mut call = Call::new(f, "tone_map")?.arg("exposure", Text(&tone.exposure))?;
    if tone.curve != usual.curve {
        call = call.arg("curve", Text(&tone.curve))?;
    }
    if let Some(white) = tone.white {
        call = call.arg("white", Floats(&white))?;
    }
    if tone.adaptation != usual.adaptation {
        call = call.arg("adaptation", tone.adaptation.name())?;
    }
    call = optional(call, "white_lightness", tone.white_lightness)?;
    if tone.gamut != usual.gamut {
        call = call.arg("gamut", tone.gamut.name())?;
    }
    if tone.space != usual.space {
        call = call.arg("space", tone.space.name())?;
    }
    optional(call, "slice_nm", slice_nm)?.end()
}

pub(crate) fn tone_map(args: &mut Args<'_>) -> Result<(ToneMap, Option<f64>), Fault> {
    let usual = ToneMap::default();
    let tone = ToneMap {
        exposure: exposure(args.take("exposure")?)?,
        curve: args.optional("curve").map_or(Ok(usual.curve), curve)?,
        white: args.optional("white").map(|white| floats(&white)).transpose()?,
        adaptation: args
            .optional("adaptation")
            .map_or(Ok(usual.adaptation), |term| named(&term, &Adaptation::ALL, Adaptation::name))?,
        white_lightness: number(args, "white_lightness")?,
        gamut: args.optional("gamut").map_or(Ok(usual.gamut), |term| named(&term, &Gamut::ALL, Gamut::name))?,
        space: args
            .optional("space")
            .map_or(Ok(usual.space), |term| named(&term, &ColourSpace::ALL, ColourSpace::name))?,
    };
    Ok((tone, number(args, "slice_nm")?))
}

/// Whether the numbers are such as the renderer works with.
pub(crate) fn is_valid_tone_map(tone: &ToneMap, slice_nm: Option<f64>) -> bool {
    let positive = |x: f64| x.is_finite() && x > 0.0;
    let exposure = match tone.exposure {
        Exposure::Auto => true,
        Exposure::Key(key) => positive(key),
        Exposure::Percentile(percent) => positive(percent) && percent <= 100.0,
        Exposure::Ev(ev) => ev.is_finite(),
    };
    let curve = match tone.curve {
        Curve::Exponential { target: Some(target) } => positive(target) && target < 1.0,
        Curve::Calibrated(Calibration { aperture, contrast, line }) => {
            aperture.is_finite() && positive(contrast) && line.is_none_or(|line| line.iter().all(|n| n.is_finite()))
        }
        _ => true,
    };
    let white = tone.white.is_none_or(|[x, y]| x > 0.0 && y > 0.0 && x + y < 1.0);
    let lightness = tone.white_lightness.is_none_or(|l| l.is_finite() && l >= 100.0);
    exposure && curve && white && lightness && slice_nm.is_none_or(positive)
}

impl Display for Text<'_, Curve> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Curve::Exponential { target: Some(target) } => Call::new(f, "exponential")?.float("target", *target)?.end(),
            Curve::Calibrated(calibration) => {
                let call = Call::new(f, "calibrated")?;
                let call = call.float("aperture", calibration.aperture)?.float("contrast", calibration.contrast)?;
                match calibration.line {
                    Some(line) => call.arg("line", Floats(&line))?.end(),
                    None => call.end(),
                }
            }
            curve => f.write_str(curve.name()),
        }
    }
}

fn curve(term: Term<'_>) -> Result<Curve, Fault> {
    const PLAIN: [Curve; 5] =
        [Curve::Shoulder, Curve::Linear, Curve::Exponential { target: None }, Curve::Aces, Curve::Agx];
    if let TermKind::Word(_) = term.kind {
        return named(&term, &PLAIN, Curve::name);
    }
    let mut args = Args::new(term)?;
    let curve = match args.name {
        "exponential" => Curve::Exponential { target: Some(args.float("target")?) },
        "calibrated" => Curve::Calibrated(Calibration {
            aperture: args.float("aperture")?,
            contrast: args.float("contrast")?,
            line: args.optional("line").map(|line| floats(&line)).transpose()?,
        }),
        _ => return args.unknown("curve"),
    };
    args.end()?;
    Ok(curve)
}

impl Display for Text<'_, Exposure> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self.0 {
            Exposure::Auto => f.write_str("auto"),
            Exposure::Ev(ev) => write!(f, "{}", Float(ev)),
            Exposure::Key(key) => Call::new(f, "key")?.value(Float(key))?.end(),
            Exposure::Percentile(percent) => Call::new(f, "percentile")?.value(Float(percent))?.end(),
        }
    }
}

fn exposure(term: Term<'_>) -> Result<Exposure, Fault> {
    match term.kind {
        TermKind::Word("auto") => return Ok(Exposure::Auto),
        TermKind::Number(_) | TermKind::Word(_) => return float(&term).map(Exposure::Ev),
        _ => {}
    }
    let mut args = Args::new(term)?;
    let exposure = match args.name {
        "key" => Exposure::Key(float(&args.next()?)?),
        "percentile" => Exposure::Percentile(float(&args.next()?)?),
        _ => return args.unknown("exposure"),
    };
    args.end()?;
    Ok(exposure)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Action, ActionAt, Builder, read, verify};

    fn actions() -> Vec<Action> {
        let image = |action: ImageAction| Action::Image(action);
        let tone = |tone: ToneMap| Action::ToneMap { tone, slice_nm: None };
        let usual = ToneMap::default();
        vec![
            image(ImageAction::LinearPolariser { angle: -0.5, strength: 0.25 }),
            image(ImageAction::Multiply { factor: 2.5 }),
            image(ImageAction::Crop { rectangle: [1, 2, 3, 4] }),
            image(ImageAction::Downscale { factor: 3 }),
            image(ImageAction::Add),
            image(ImageAction::Merge),
            image(ImageAction::Denoise),
            image(ImageAction::DifferenceTo { path: "a.exr".into(), question: Question::default(), most: None }),
            image(ImageAction::DifferenceTo {
                path: "a \"b\".exr".into(),
                question: Question {
                    metric: Metric::PlusMinus,
                    wavelength_nm: Some(550.0),
                    exposure: Some(Exposure::Key(0.2)),
                },
                most: Some(3.0),
            }),
            image(ImageAction::VisualisePolarisation(View {
                quantity: Quantity::Orientation,
                wavelength_nm: Some(500.5),
                most: 0.3,
                overlay: Overlay::Picture,
                legend: false,
            })),
            Action::ToneMap { tone: usual, slice_nm: Some(633.0) },
            tone(ToneMap { exposure: Exposure::Ev(-1.5), curve: Curve::Aces, space: ColourSpace::Rec2020, ..usual }),
            tone(ToneMap {
                exposure: Exposure::Percentile(99.0),
                curve: Curve::Exponential { target: Some(0.3) },
                gamut: Gamut::Lab,
                ..usual
            }),
            tone(ToneMap {
                curve: Curve::Calibrated(Calibration { aperture: -1.0, contrast: 80.0, line: Some([1.0, 0.5]) }),
                white: Some([0.31, 0.32]),
                adaptation: Adaptation::Cat16,
                white_lightness: Some(150.0),
                ..usual
            }),
        ]
    }

    #[test]
    fn what_is_written_reads_back() {
        let origin = arsc_diagnostics::Span { source: arsc_diagnostics::SourceId(0), start: 0, end: 0 };
        let mut builder = Builder::new();
        let root = builder.union(vec![], origin);
        let mut ir = builder.finish(root);
        ir.actions = actions().into_iter().map(|action| ActionAt { action, origin }).collect();
        verify(&ir).unwrap();
        let back = read(&ir.to_string()).unwrap_or_else(|error| panic!("{error}\n{ir}"));
        assert_eq!(back, ir);
    }

    #[test]
    fn nonsense_is_not_valid() {
        for action in [
            ImageAction::LinearPolariser { angle: f64::NAN, strength: 1.0 },
            ImageAction::LinearPolariser { angle: 0.0, strength: 1.5 },
            ImageAction::Multiply { factor: 0.0 },
            ImageAction::Crop { rectangle: [3, 0, 3, 1] },
            ImageAction::Downscale { factor: 0 },
            ImageAction::VisualisePolarisation(View { most: -1.0, ..View::default() }),
        ] {
            assert!(!action.is_valid(), "{action:?}");
        }
        let usual = ToneMap::default();
        for tone in [
            ToneMap { exposure: Exposure::Key(0.0), ..usual },
            ToneMap { exposure: Exposure::Percentile(101.0), ..usual },
            ToneMap { white: Some([0.9, 0.9]), ..usual },
            ToneMap { white_lightness: Some(50.0), ..usual },
            ToneMap { curve: Curve::Exponential { target: Some(1.0) }, ..usual },
        ] {
            assert!(!is_valid_tone_map(&tone, None), "{tone:?}");
        }
    }
}
