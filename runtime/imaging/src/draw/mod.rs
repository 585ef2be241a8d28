//! Drawing on display pictures: rectangles, lines, text, false colours and their legends.
//!
//! Places are pixels from the upper left corner; what lies outside is left out. Colours are coded sRGB in [0, 1].

mod colour_map;
mod legend;
mod plot;
mod text;

use arsc_image::DisplayImage;
use arsc_spectral::colour_space::ColourSpace;

pub use colour_map::ColourMap;
pub use legend::{Entry, beside, scale_bar, swatches};
pub(crate) use legend::{label, ticks};
pub use plot::{Mark, Plot};
pub use text::{GLYPH, text, text_width};

pub type Colour = [f32; 3];

pub const WHITE: Colour = [1.0; 3];
/// Behind legends.
pub const PAPER: Colour = [0.07; 3];
/// Of what has no value.
pub const MISSING: Colour = [1.0, 0.0, 1.0];

pub fn blank(width: usize, height: usize, colour: Colour) -> DisplayImage {
    DisplayImage { width, height, space: ColourSpace::Srgb, rgb: vec![colour; width * height], metadata: Vec::new() }
}

pub fn point(image: &mut DisplayImage, x: i64, y: i64, colour: Colour) {
    if let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y))
        && x < image.width
        && y < image.height
    {
        image.rgb[y * image.width + x] = colour;
    }
}

/// From x, y over a width and a height.
pub fn rectangle(image: &mut DisplayImage, [x, y]: [i64; 2], [width, height]: [i64; 2], colour: Colour) {
    for (x, y) in (y..y + height).flat_map(|y| (x..x + width).map(move |x| (x, y))) {
        point(image, x, y, colour);
    }
}

/// Between two points, one pixel wide, both ends drawn.
pub fn line(image: &mut DisplayImage, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], colour: Colour) {
    // More steps than a picture has pixels would be a line to nowhere.
    let steps = (x1 - x0).abs().max((y1 - y0).abs()).ceil().clamp(1.0, 1e5);
    for i in 0..=steps as u32 {
        let t = f64::from(i) / steps;
        point(image, (x0 + t * (x1 - x0)).round() as i64, (y0 + t * (y1 - y0)).round() as i64, colour);
    }
}

/// Copies `of` into `image` with its corner at x, y.
pub fn paste(image: &mut DisplayImage, of: &DisplayImage, [x, y]: [i64; 2]) {
    for (i, colour) in of.rgb.iter().enumerate() {
        point(image, x + (i % of.width) as i64, y + (i / of.width) as i64, *colour);
    }
}
