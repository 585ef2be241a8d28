//! Numbers as colours.

use super::Colour;

/// Maps [0, 1] (or [-1, 1] for signed ones) to colours; beyond the ends the ends stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColourMap {
    /// Black, violet, red, orange, pale yellow, with steadily increasing lightness (anchors of matplotlib's inferno, CC0).
    Heat,
    /// Blue below zero, red above.
    PlusMinus,
    Grey,
    /// From black to one colour.
    To(Colour),
    /// From one colour below zero over black to another.
    Between(Colour, Colour),
}

const HEAT: [Colour; 6] = [
    [0.001, 0.000, 0.014],
    [0.258, 0.039, 0.406],
    [0.578, 0.148, 0.404],
    [0.865, 0.317, 0.226],
    [0.988, 0.645, 0.040],
    [0.988, 0.998, 0.645],
];

const PLUS_MINUS: [Colour; 5] =
    [[0.02, 0.15, 0.50], [0.33, 0.58, 0.88], [0.96, 0.96, 0.96], [0.93, 0.49, 0.33], [0.53, 0.02, 0.10]];

impl ColourMap {
    pub fn is_signed(self) -> bool {
        matches!(self, ColourMap::PlusMinus | ColourMap::Between(..))
    }

    pub fn colour(self, value: f64) -> Colour {
        let value = if value.is_nan() { return super::MISSING } else { value.clamp(-1.0, 1.0) };
        let scaled = |colour: Colour, by: f64| colour.map(|c| c * by as f32);
        match self {
            ColourMap::Heat => along(&HEAT, value.max(0.0)),
            ColourMap::PlusMinus => along(&PLUS_MINUS, 0.5 + 0.5 * value),
            ColourMap::Grey => [value.max(0.0) as f32; 3],
            ColourMap::To(colour) => scaled(colour, value.max(0.0)),
            ColourMap::Between(below, above) => scaled(if value < 0.0 { below } else { above }, value.abs()),
        }
    }
}

fn along(anchors: &[Colour], t: f64) -> Colour {
    let at = t * (anchors.len() - 1) as f64;
    let i = (at as usize).min(anchors.len() - 2);
    let t = (at - i as f64) as f32;
    std::array::from_fn(|c| anchors[i][c] + t * (anchors[i + 1][c] - anchors[i][c]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_grows_lighter_and_ends_are_kept() {
        let luma = |c: Colour| 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        let values: Vec<f32> = (0..=20).map(|i| luma(ColourMap::Heat.colour(f64::from(i) / 20.0))).collect();
        assert!(values.windows(2).all(|pair| pair[1] > pair[0]));
        assert_eq!(ColourMap::Heat.colour(7.0), ColourMap::Heat.colour(1.0));
        let [blue, red] = [-1.0, 1.0].map(|v| ColourMap::PlusMinus.colour(v));
        assert!(blue[2] > blue[0] && red[0] > red[2]);
        assert_eq!(ColourMap::Grey.colour(f64::NAN), super::super::MISSING);
    }
}
