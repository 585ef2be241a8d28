//! A drawing of lines, rectangles and words that becomes SVG or pixels.

use std::fmt::Write;

use arsc_image::DisplayImage;

use super::{Colour, GLYPH, blank, line, rectangle, text, text_width};

#[derive(Clone, Debug)]
pub enum Mark {
    Line {
        points: Vec<[f64; 2]>,
        colour: Colour,
    },
    Rectangle {
        corner: [f64; 2],
        size: [f64; 2],
        colour: Colour,
    },
    /// Centred about x, or ending there.
    Words {
        place: [f64; 2],
        words: String,
        colour: Colour,
        centred: bool,
    },
}

/// Marks in the order in which they are drawn, on white.
#[derive(Clone, Debug)]
pub struct Plot {
    pub size: [usize; 2],
    pub marks: Vec<Mark>,
}

impl Plot {
    pub fn to_svg(&self) -> String {
        let [width, height] = self.size;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        );
        for mark in &self.marks {
            // Writing to a string does not fail.
            let _ = match mark {
                Mark::Line { points, colour } => {
                    let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
                    let (points, colour) = (points.join(" "), hex(*colour));
                    writeln!(
                        svg,
                        "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.3\"/>"
                    )
                }
                Mark::Rectangle { corner: [x, y], size: [w, h], colour } => {
                    let colour = hex(*colour);
                    writeln!(
                        svg,
                        "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" fill=\"{colour}\"/>"
                    )
                }
                Mark::Words { place: [x, y], words, colour, centred } => {
                    let anchor = if *centred { "middle" } else { "end" };
                    let words = words.replace('&', "&amp;").replace('<', "&lt;");
                    writeln!(
                        svg,
                        "<text x=\"{x:.2}\" y=\"{:.2}\" font-family=\"sans-serif\" font-size=\"11\" \
                         text-anchor=\"{anchor}\" fill=\"{}\">{words}</text>",
                        y + 4.0,
                        hex(*colour)
                    )
                }
            };
        }
        svg.push_str("</svg>\n");
        svg
    }

    pub fn to_pixels(&self) -> DisplayImage {
        let mut image = blank(self.size[0], self.size[1], [1.0; 3]);
        for mark in &self.marks {
            match mark {
                Mark::Line { points, colour } => {
                    points.windows(2).for_each(|pair| line(&mut image, pair[0], pair[1], *colour));
                }
                Mark::Rectangle { corner: [x, y], size: [w, h], colour } => {
                    let (x0, y0) = (x.round() as i64, y.round() as i64);
                    let size = [(x + w).round() as i64 - x0, (y + h).round() as i64 - y0];
                    rectangle(&mut image, [x0, y0], size, *colour);
                }
                Mark::Words { place: [x, y], words, colour, centred } => {
                    let width = if *centred { text_width(words) / 2 } else { text_width(words) };
                    text(&mut image, [x.round() as i64 - width, y.round() as i64 - GLYPH / 2], words, *colour);
                }
            }
        }
        image
    }
}

fn hex(colour: Colour) -> String {
    let [r, g, b] = colour.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
