//! `arsc diff`: how two pictures differ.

use std::path::PathBuf;

use arsc_imaging::difference::{Difference, Errors, Metric, Question, Statistics, difference, errors};

use crate::exit::Exit;
use crate::pictures::{self, ExposureArgs, named};

/// The number that --fail-above looks at
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Statistic {
    Mean,
    Median,
    /// Not exceeded by 95 % of the pixels
    P95,
    Greatest,
    RootMeanSquare,
}

#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Text,
    Json,
}

/// Compares two pictures: prints statistics, draws false colours, fails above a threshold
///
/// Differences of colour are those that a display would show at the exposure that the first picture asks for; pictures
/// without a spectrum that a display can show are compared as they are.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The reference
    reference: PathBuf,

    /// The picture to compare with it
    other: PathBuf,

    /// What is compared
    #[arg(long, default_value = "ciede2000", value_parser = named(&Metric::ALL, Metric::name))]
    metric: Metric,

    /// With --metric plus_minus: radiances of spectral pictures at this wavelength instead of luminances
    #[arg(long, value_name = "WAVELENGTH", value_parser = pictures::wavelength)]
    wavelength: Option<f64>,

    #[command(flatten)]
    exposure: ExposureArgs,

    /// Draws the differences in false colours
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// The difference with the last colour of the scale [default: the greatest]
    #[arg(long, value_name = "DIFFERENCE", value_parser = pictures::positive)]
    max: Option<f64>,

    /// Draws no scale beside the picture
    #[arg(long)]
    no_scale: bool,

    /// Exit status 1 if the statistic is greater than this, or pixels cannot be compared
    #[arg(long, value_name = "DIFFERENCE", value_parser = pictures::finite)]
    fail_above: Option<f64>,

    #[arg(long, value_enum, default_value = "mean")]
    statistic: Statistic,

    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub fn run(args: &Args) -> Exit {
    compare(args).unwrap_or_else(|exit| exit)
}

fn compare(args: &Args) -> Result<Exit, Exit> {
    if let Some(output) = &args.output {
        pictures::Kind::of(output)?;
    }
    let (a, b) = (pictures::load(&args.reference)?, pictures::load(&args.other)?);
    let question = Question { metric: args.metric, wavelength_nm: args.wavelength, exposure: args.exposure.exposure() };
    let difference = difference(&a, &b, &question).map_err(|error| pictures::refused(&args.other, error))?;
    let statistics = difference.statistics();
    // Spectra of other bands have no errors in common; their colours were compared all the same.
    let errors = errors(&a, &b).ok();
    match args.format {
        Format::Text => pictures::print(&text(&difference, &statistics, errors.as_ref())),
        Format::Json => pictures::print(&format!("{}\n", json(&difference, &statistics, errors.as_ref()))),
    }
    if let Some(output) = &args.output {
        let image = difference.picture(args.max, !args.no_scale);
        pictures::save_display(output, &image, arsc_image::Depth::Eight)?;
    }
    let measured = match args.statistic {
        Statistic::Mean => statistics.mean,
        Statistic::Median => statistics.median,
        Statistic::P95 => statistics.percentile_95,
        Statistic::Greatest => statistics.greatest,
        Statistic::RootMeanSquare => statistics.root_mean_square,
    };
    let fails = args.fail_above.is_some_and(|limit| measured > limit || statistics.not_finite > 0);
    Ok(if fails { Exit::Findings } else { Exit::Clean })
}

fn text(difference: &Difference, statistics: &Statistics, errors: Option<&Errors>) -> String {
    let name = difference.metric.name();
    let unit = if difference.metric.is_signed() { " (magnitudes)" } else { "" };
    let mut text = format!("{name}{unit}: mean {:.6}, median {:.6}\n", statistics.mean, statistics.median);
    text.push_str(&format!(
        "95 % of the pixels at most {:.6}, greatest {:.6}, root mean square {:.6}\n",
        statistics.percentile_95, statistics.greatest, statistics.root_mean_square
    ));
    if let Some(errors) = errors {
        text.push_str(&format!(
            "values: root mean square error {:.6e}, PSNR {:.2} dB, SNR {:.2} dB\n",
            errors.root_mean_square, errors.peak_signal_to_noise_db, errors.signal_to_noise_db
        ));
    }
    if statistics.not_finite > 0 {
        text.push_str(&format!("pixels that cannot be compared: {}\n", statistics.not_finite));
    }
    text
}

fn json(difference: &Difference, statistics: &Statistics, errors: Option<&Errors>) -> serde_json::Value {
    // JSON has no infinity: what is infinite is null.
    serde_json::json!({
        "metric": difference.metric.name(),
        "mean": statistics.mean,
        "median": statistics.median,
        "percentile95": statistics.percentile_95,
        "greatest": statistics.greatest,
        "rootMeanSquare": statistics.root_mean_square,
        "notFinite": statistics.not_finite,
        "rmse": errors.map(|e| e.root_mean_square),
        "psnrDb": errors.map(|e| e.peak_signal_to_noise_db),
        "snrDb": errors.map(|e| e.signal_to_noise_db),
    })
}
