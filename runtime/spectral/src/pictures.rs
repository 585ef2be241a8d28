//! What can be asked of pictures: metrics of difference, quantities of polarisation.
//!
//! The words that scripts, the command line and `arsc-imaging`, which answers, have in common.

use crate::tone::Exposure;

/// Number that a pixel's difference is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Metric {
    /// CIEDE2000 (Sharma, Wu and Dalal 2005).
    #[default]
    Ciede2000,
    /// Distance in CIE L*a*b* (1976).
    Cie76,
    /// L* of the second less that of the first.
    Lightness,
    /// Chroma C*ab of the second less that of the first.
    Chroma,
    /// Difference of hue H*ab, without sign.
    Hue,
    /// FLIP for low dynamic range (Andersson et al. 2020), from 0 to 1.
    Flip,
    /// The second less the first: of luminances in cd m^-2, or of radiances at a wavelength.
    PlusMinus,
}

impl Metric {
    pub const ALL: [Metric; 7] = [
        Metric::Ciede2000,
        Metric::Cie76,
        Metric::Lightness,
        Metric::Chroma,
        Metric::Hue,
        Metric::Flip,
        Metric::PlusMinus,
    ];

    /// As it is written in scripts and arguments.
    pub const fn name(self) -> &'static str {
        match self {
            Metric::Ciede2000 => "ciede2000",
            Metric::Cie76 => "cie76",
            Metric::Lightness => "lightness",
            Metric::Chroma => "chroma",
            Metric::Hue => "hue",
            Metric::Flip => "flip",
            Metric::PlusMinus => "plus_minus",
        }
    }

    pub const fn is_signed(self) -> bool {
        matches!(self, Metric::Lightness | Metric::Chroma | Metric::PlusMinus)
    }
}

/// What is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Question {
    pub metric: Metric,
    /// For [`Metric::PlusMinus`]: radiances at this wavelength.
    pub wavelength_nm: Option<f64>,
    /// `None`: 0 EV if the first picture has no spectrum and is nowhere brighter than display white, else automatic.
    pub exposure: Option<Exposure>,
}

/// What is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Degree of polarisation, sqrt(S1² + S2² + S3²) / S0.
    #[default]
    Degree,
    /// Its linear part, sqrt(S1² + S2²) / S0.
    Linear,
    /// Its circular part, |S3| / S0.
    Circular,
    /// Linear and circular part in their colours.
    Type,
    /// In which direction the linear part vibrates, as bright as its degree.
    Orientation,
    /// Which way the circular part turns, S3 / S0.
    Chirality,
    /// S1 / S0, horizontal against vertical.
    S1,
    /// S2 / S0, rising against falling diagonals.
    S2,
    /// S3 / S0, right against left.
    S3,
}

impl Quantity {
    pub const ALL: [Quantity; 9] = [
        Quantity::Degree,
        Quantity::Linear,
        Quantity::Circular,
        Quantity::Type,
        Quantity::Orientation,
        Quantity::Chirality,
        Quantity::S1,
        Quantity::S2,
        Quantity::S3,
    ];

    /// As it is written in scripts and arguments.
    pub const fn name(self) -> &'static str {
        match self {
            Quantity::Degree => "degree",
            Quantity::Linear => "linear",
            Quantity::Circular => "circular",
            Quantity::Type => "type",
            Quantity::Orientation => "orientation",
            Quantity::Chirality => "chirality",
            Quantity::S1 => "s1",
            Quantity::S2 => "s2",
            Quantity::S3 => "s3",
        }
    }
}

/// How the false colours and the picture go together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Overlay {
    /// False colours alone.
    #[default]
    None,
    /// False colours, as bright as the picture.
    Luminance,
    /// The picture in grey, with false colours as strong as the light is polarised.
    Picture,
}

impl Overlay {
    pub const ALL: [Overlay; 3] = [Overlay::None, Overlay::Luminance, Overlay::Picture];

    /// As it is written in scripts and arguments.
    pub const fn name(self) -> &'static str {
        match self {
            Overlay::None => "none",
            Overlay::Luminance => "luminance",
            Overlay::Picture => "picture",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    pub quantity: Quantity,
    /// `None`: all bands, as the eye weighs them.
    pub wavelength_nm: Option<f64>,
    /// The value with the full colour; degrees above it saturate. Positive.
    pub most: f64,
    pub overlay: Overlay,
    pub legend: bool,
}

impl Default for View {
    fn default() -> View {
        View { quantity: Quantity::Degree, wavelength_nm: None, most: 1.0, overlay: Overlay::None, legend: true }
    }
}
