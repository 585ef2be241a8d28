//! Legends beside a false-colour picture: a scale bar, or patches with names.

use arsc_image::DisplayImage;

use super::{Colour, ColourMap, GLYPH, PAPER, WHITE, blank, line, paste, rectangle, text, text_width};

/// Space around things, pixels.
const MARGIN: i64 = 8;
const BAR_WIDTH: i64 = 14;
/// Least distance between two numbers of a scale.
const SPACING: i64 = 28;
/// A legend is at least this high, whatever the picture.
const LEAST_HEIGHT: usize = 96;

/// The picture with a legend to the right; the lower one is filled up.
pub fn beside(image: &DisplayImage, legend: &DisplayImage) -> DisplayImage {
    let height = image.height.max(legend.height);
    let mut both = blank(image.width + legend.width, height, PAPER);
    paste(&mut both, image, [0, 0]);
    paste(&mut both, legend, [image.width as i64, 0]);
    both.metadata.clone_from(&image.metadata);
    both
}

/// A vertical bar from `least` to `most`, with a title above and numbers at round values.
pub fn scale_bar(height: usize, map: ColourMap, [least, most]: [f64; 2], title: &[&str]) -> DisplayImage {
    let height = height.max(LEAST_HEIGHT);
    let top = MARGIN + title.len() as i64 * (GLYPH + 2) + MARGIN;
    let length = (height as i64 - top - MARGIN - GLYPH).max(1);
    let ticks = ticks(least, most, (length / SPACING).max(1) as u32);
    let labels: Vec<String> = ticks.iter().map(|tick| label(*tick)).collect();
    let widest = labels.iter().map(|l| BAR_WIDTH + 8 + text_width(l)).chain(title.iter().map(|t| text_width(t))).max();
    let mut image = blank((2 * MARGIN + widest.unwrap_or(0)) as usize, height, PAPER);
    for (i, title) in title.iter().enumerate() {
        text(&mut image, [MARGIN, MARGIN + i as i64 * (GLYPH + 2)], title, WHITE);
    }
    for y in 0..length {
        let share = 1.0 - y as f64 / (length - 1).max(1) as f64;
        let value = if map.is_signed() { 2.0 * share - 1.0 } else { share };
        rectangle(&mut image, [MARGIN, top + y], [BAR_WIDTH, 1], map.colour(value));
    }
    for (tick, label) in ticks.iter().zip(&labels) {
        let y = top as f64 + (1.0 - (tick - least) / (most - least)) * (length - 1) as f64;
        let right = (MARGIN + BAR_WIDTH) as f64;
        line(&mut image, [right, y], [right + 4.0, y], WHITE);
        text(&mut image, [MARGIN + BAR_WIDTH + 7, y.round() as i64 - GLYPH / 2 + 1], label, WHITE);
    }
    image
}

/// A patch of colour and what it means.
pub struct Entry {
    pub colour: Colour,
    pub name: &'static str,
}

/// Patches below each other, with a title above.
pub fn swatches(height: usize, title: &[&str], entries: &[Entry]) -> DisplayImage {
    let top = MARGIN + title.len() as i64 * (GLYPH + 2) + MARGIN;
    let needed = (top + entries.len() as i64 * 2 * GLYPH + MARGIN) as usize;
    let names = entries.iter().map(|entry| 2 * GLYPH + 4 + text_width(entry.name));
    let widest = names.chain(title.iter().map(|t| text_width(t))).max().unwrap_or(0);
    let mut image = blank((2 * MARGIN + widest) as usize, height.max(needed), PAPER);
    for (i, title) in title.iter().enumerate() {
        text(&mut image, [MARGIN, MARGIN + i as i64 * (GLYPH + 2)], title, WHITE);
    }
    for (i, entry) in entries.iter().enumerate() {
        let y = top + i as i64 * 2 * GLYPH;
        rectangle(&mut image, [MARGIN, y], [2 * GLYPH - 2, GLYPH + 4], entry.colour);
        text(&mut image, [MARGIN + 2 * GLYPH + 4, y + 2], entry.name, WHITE);
    }
    image
}

/// Round numbers from `least` to `most`, about `count` of them.
pub(crate) fn ticks(least: f64, most: f64, count: u32) -> Vec<f64> {
    let raw = (most - least) / f64::from(count.max(1));
    if !raw.is_finite() || raw <= 0.0 {
        return vec![least];
    }
    let magnitude = 10f64.powf(raw.log10().floor());
    let step =
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * magnitude).find(|step| *step >= raw * 0.999).unwrap_or(raw);
    let (first, last) = ((least / step - 1e-9).ceil() as i64, (most / step + 1e-9).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

/// A number as short as its digits allow.
pub(crate) fn label(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        assert_eq!(ticks(0.0, 10.0, 5), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks(-1.0, 1.0, 4), [-1.0, -0.5, 0.0, 0.5, 1.0]);
        assert_eq!(ticks(0.0, 0.0, 4), [0.0]);
        assert!(ticks(0.0, 7.3, 4).iter().all(|t| (0.0..=7.3).contains(t)));
        assert_eq!([label(0.5), label(2.0), label(1e-6), label(0.0)], ["0.5", "2", "1.0e-6", "0"]);
    }

    #[test]
    fn a_bar_has_its_ends_where_they_belong() {
        let bar = scale_bar(200, ColourMap::Grey, [0.0, 5.0], &["DELTA E"]);
        let column: Vec<f32> = (0..200).map(|y| bar.rgb[y * bar.width + 12][0]).collect();
        let (brightest, darkest) = (column[30], column[180]);
        assert!(brightest > 0.95 && darkest < 0.1, "{brightest} {darkest}");
        let picture = blank(50, 40, WHITE);
        let both = beside(&picture, &bar);
        assert_eq!((both.width, both.height), (50 + bar.width, 200));
        assert_eq!(both.rgb[49], WHITE);
        both.verify().unwrap();
    }
}
