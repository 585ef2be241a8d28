//! Text in an 8 by 8 bitmap font (public domain, crate font8x8), ASCII.

use arsc_image::DisplayImage;
use font8x8::legacy::BASIC_LEGACY;

use super::{Colour, point};

/// Side of a character, pixels.
pub const GLYPH: i64 = 8;

pub fn text_width(text: &str) -> i64 {
    text.chars().count() as i64 * GLYPH
}

/// Writes with the upper left corner at x, y. What is not ASCII comes out as `?`.
pub fn text(image: &mut DisplayImage, [x, y]: [i64; 2], text: &str, colour: Colour) {
    for (i, character) in text.chars().enumerate() {
        let glyph = BASIC_LEGACY.get(character as usize).unwrap_or(&BASIC_LEGACY[usize::from(b'?')]);
        for (row, bits) in glyph.iter().enumerate() {
            for column in (0..8).filter(|column| bits >> column & 1 == 1) {
                point(image, x + i as i64 * GLYPH + column, y + row as i64, colour);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::{WHITE, blank};

    #[test]
    fn letters_are_upright() {
        let mut image = blank(16, 8, [0.0; 3]);
        text(&mut image, [8, 0], "L", WHITE);
        let lit = |x: usize, y: usize| image.rgb[y * 16 + x] == WHITE;
        // The stem is left, the bar below.
        let column = |x: usize| (0..8).filter(|y| lit(x, *y)).count();
        assert!((8..11).map(column).max() > (12..16).map(column).max());
        assert_eq!((0..8).map(column).sum::<usize>(), 0);
        assert!((8..16).filter(|x| lit(*x, 6)).count() > (8..16).filter(|x| lit(*x, 1)).count());
    }
}
