//! How bright a picture is shown.
//!
//! Automatic exposure maps the log-average luminance of the pixels that are not black to a key (Reinhard et al. 2002,
//! "Photographic tone reproduction for digital images", equations 1 and 2, with black left out of the mean instead of
//! the small delta, so that a black background does not brighten the picture).

/// Luminance that the log-average is mapped to, of the display's white.
pub const KEY: f64 = 0.18;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Exposure {
    /// The log-average becomes [`KEY`].
    #[default]
    Auto,
    /// The log-average becomes this, of the display's white; positive.
    Key(f64),
    /// This percentile of the luminances, in (0, 100], becomes the display's white.
    Percentile(f64),
    /// In stops: radiances are multiplied by 2^ev.
    Ev(f64),
}

impl Exposure {
    /// In stops; 0 for a black picture.
    pub fn ev(self, luminances: &Luminances) -> f64 {
        let becomes = |luminance: f64, target: f64| {
            if luminance > 0.0 { target.log2() - luminance.log2() } else { 0.0 }
        };
        match self {
            Exposure::Auto => becomes(luminances.log_average(), KEY),
            Exposure::Key(key) => becomes(luminances.log_average(), key),
            Exposure::Percentile(percent) => becomes(luminances.percentile(percent), 1.0),
            Exposure::Ev(ev) => ev,
        }
    }
}

/// The luminances of a picture that are finite and not black, in order.
#[derive(Clone, Debug, Default)]
pub struct Luminances {
    increasing: Vec<f64>,
    log_average: f64,
}

impl Luminances {
    pub fn new(luminances: impl Iterator<Item = f64>) -> Luminances {
        let mut increasing: Vec<f64> = luminances.filter(|y| y.is_finite() && *y > 0.0).collect();
        // In the order of the pixels, before sorting: the sum is the same for the same picture.
        let sum: f64 = increasing.iter().map(|y| y.log2()).sum();
        let log_average = if increasing.is_empty() { 0.0 } else { (sum / increasing.len() as f64).exp2() };
        increasing.sort_unstable_by(f64::total_cmp);
        Luminances { increasing, log_average }
    }

    /// Geometric mean; 0 for a black picture.
    pub fn log_average(&self) -> f64 {
        self.log_average
    }

    /// The least luminance that is not below `percent` of them; 0 for a black picture.
    pub fn percentile(&self, percent: f64) -> f64 {
        let rank = (percent / 100.0 * self.increasing.len() as f64).ceil() as usize;
        self.increasing.get(rank.clamp(1, self.increasing.len().max(1)) - 1).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposures_bring_what_they_say_to_its_place() {
        let luminances = Luminances::new([1.0, 0.0, 100.0, f64::NAN, 10.0, f64::INFINITY, -1.0].into_iter());
        assert!((luminances.log_average() - 10.0).abs() < 1e-12);
        let brought = |exposure: Exposure, luminance: f64| luminance * exposure.ev(&luminances).exp2();
        assert!((brought(Exposure::Auto, 10.0) - 0.18).abs() < 1e-12);
        assert!((brought(Exposure::Key(0.4), 10.0) - 0.4).abs() < 1e-12);
        assert!((brought(Exposure::Percentile(100.0), 100.0) - 1.0).abs() < 1e-12);
        assert!((brought(Exposure::Percentile(50.0), 10.0) - 1.0).abs() < 1e-12);
        assert!((brought(Exposure::Percentile(1e-9), 1.0) - 1.0).abs() < 1e-12);
        let black = Luminances::new(std::iter::empty());
        for exposure in [Exposure::Auto, Exposure::Key(0.5), Exposure::Percentile(99.0)] {
            assert_eq!(exposure.ev(&black), 0.0);
        }
    }
}
