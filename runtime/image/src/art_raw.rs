//! Reading the raw pictures of ART: ARTRAW (spectra) and ARTCSP (CIE XYZ).
//!
//! A text header, then big-endian 32 bit floats without compression. Of the header only what is needed is looked for, by
//! its words, in any order: the size, whether the picture is polarised, the number of channels and the n + 1 limits of
//! the bands in nm. Pixels are n bands and alpha (left out), or X, Y, Z. In polarised pictures each group of up to 8 pixels
//! of a row begins with a byte whose bits, the first pixel in the highest, say which pixels carry S0, S1, S2 and S3 of
//! all bands, one after the other, instead of S0 alone; alpha follows. The data begin behind the line that announces them,
//! and an X if there is one, and must fill the file to its end. Source: the description in ART's handbook; polarised files were not at hand for a check.

use crate::{ColourImage, ImageError, Picture, UNIT_LUMINANCE, claims, spectral};

/// The header is text within so many bytes.
const LONGEST_HEADER: usize = 1 << 16;

/// More bands than any spectrum type of ART has.
const MOST_BANDS: usize = 1_000;

pub fn is_one(bytes: &[u8]) -> bool {
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(64)]).to_ascii_lowercase();
    let first = start.lines().next().unwrap_or_default();
    first.starts_with("art ") && first.contains("image format")
}

/// A spectral picture, or one of colours from ARTCSP.
pub fn decode(bytes: &[u8]) -> Result<Picture, ImageError> {
    let header = Header::read(bytes)?;
    let pixels = (header.width as u64).saturating_mul(header.height as u64);
    let least = pixels.saturating_mul(4).saturating_mul(header.bands.as_ref().map_or(3, |edges| edges.len() as u64));
    if pixels == 0 || least > bytes.len() as u64 {
        return Err(claims::refusal("ARTRAW"));
    }
    let data = &bytes[header.end..];
    let data = data.strip_prefix(b"X").unwrap_or(data);
    header.pixels(data).unwrap_or_else(|| Err(malformed("its data do not fill the file as the header says")))
}

fn malformed(what: &str) -> ImageError {
    ImageError::Decode { format: "ARTRAW", source: what.into() }
}

struct Header {
    width: usize,
    height: usize,
    /// Edges in nm; `None` for CIE XYZ.
    bands: Option<Vec<f64>>,
    polarised: bool,
    /// Where the text ends.
    end: usize,
}

impl Header {
    fn read(bytes: &[u8]) -> Result<Header, ImageError> {
        let (mut size, mut count, mut edges) = (None, None, None);
        let (mut polarised, mut is_xyz, mut at) = (false, false, 0);
        while at < bytes.len().min(LONGEST_HEADER) {
            let length = bytes[at..].iter().position(|b| *b == b'\n').unwrap_or(bytes.len() - at);
            let line = String::from_utf8_lossy(&bytes[at..at + length]).to_ascii_lowercase();
            at = (at + length + 1).min(bytes.len());
            let value = line.split_once(':').map_or(line.as_str(), |(_, value)| value);
            if line.contains("binary") && line.contains("data") {
                let bands = match (edges, is_xyz || count.is_none()) {
                    (_, true) => None,
                    (Some(edges), false) => Some(edges),
                    (None, false) => return Err(malformed("the header lacks the limits of the bands")),
                };
                let (width, height) = size.ok_or_else(|| malformed("the header lacks the size"))?;
                let right = bands.as_ref().is_none_or(|edges: &Vec<f64>| {
                    count == Some(edges.len() - 1) && edges.windows(2).all(|edge| edge[0] < edge[1])
                });
                return if right {
                    Ok(Header { width, height, bands, polarised, end: at })
                } else {
                    Err(malformed("the limits of the bands do not fit their number"))
                };
            } else if line.contains("size") {
                size = numbers(value).get(..2).map(|n| (n[0] as usize, n[1] as usize)).or(size);
            } else if line.contains("bounds") || line.contains("limits") {
                edges = Some(numbers(value)).filter(|edges| edges.len() >= 2).or(edges);
            } else if line.contains("channels") {
                count = numbers(value).first().map(|n| *n as usize).filter(|n| *n <= MOST_BANDS).or(count);
            } else if line.contains("polaris") && !line.contains("plain") && !line.contains("unpolaris") {
                polarised = true;
            }
            is_xyz |= line.contains("ciexyz") || line.contains("cie xyz");
        }
        Err(malformed("the header has no end"))
    }

    /// The picture, if `data` is exactly its pixels.
    fn pixels(&self, data: &[u8]) -> Option<Result<Picture, ImageError>> {
        let (size, mut data) = ([self.width, self.height], Data { rest: data, flags: 0 });
        let Some(edges) = &self.bands else {
            let mut xyz = Vec::new();
            for _ in 0..self.width * self.height {
                xyz.push([data.float()?, data.float()?, data.float()?].map(|c| f64::from(c) * UNIT_LUMINANCE));
            }
            let image = || ColourImage::from_linear(size, xyz.into_iter(), glam::DMat3::IDENTITY);
            return data.rest.is_empty().then(image).map(|image| image.map(Picture::Colour));
        };
        let bands = edges.len() - 1;
        let (mut radiance, mut stokes) = (Vec::new(), Vec::new());
        for pixel in 0..self.width * self.height {
            let place = pixel % self.width % 8;
            if self.polarised && place == 0 {
                data.flags = data.byte()?;
            }
            let whole = self.polarised && data.flags & (0x80 >> place) != 0;
            let values: Vec<f32> =
                (0..if whole { 4 * bands } else { bands }).map(|_| data.float()).collect::<Option<_>>()?;
            data.float()?;
            radiance.extend(&values[..bands]);
            let of = |band: usize, parameter: usize| values.get(parameter * bands + band).copied().unwrap_or(0.0);
            if self.polarised {
                stokes.extend((0..bands).map(|band| [of(band, 1), of(band, 2), of(band, 3)]));
            }
        }
        let image = || spectral::from_bands(size, edges.clone(), radiance, self.polarised.then_some(stokes));
        data.rest.is_empty().then(image).map(|image| image.map(Picture::Spectral))
    }
}

/// What is left of the data, and the flags of the group of pixels.
struct Data<'a> {
    rest: &'a [u8],
    flags: u8,
}

impl Data<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*first)
    }

    fn float(&mut self) -> Option<f32> {
        let (first, rest) = self.rest.split_first_chunk()?;
        self.rest = rest;
        Some(f32::from_be_bytes(*first))
    }
}

/// Every number in a text, signs and separators left out.
fn numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| !(c.is_ascii_digit() || c == '.'))
        .filter_map(|word| word.parse().ok())
        .filter(|n: &f64| n.is_finite() && *n < 1e9)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(polarised: bool) -> Vec<u8> {
        let kind = if polarised { "polarised" } else { "plain" };
        format!(
            "ART RAW image format 2.5\n\nFile created by:  a test\nImage size:  3 x 2\nDPI:  72.0 x 72.0\n\
             Image type:  {kind}\nColour type:  spectrum\nNumber of channels:  2\n\
             Channel bounds in nanometers:  400.0 500.0 700.0\n\nBig-endian float binary image data:\nX"
        )
        .into_bytes()
    }

    fn floats(values: impl IntoIterator<Item = f32>) -> Vec<u8> {
        values.into_iter().flat_map(f32::to_be_bytes).collect()
    }

    #[test]
    fn plain_pictures_are_read() {
        let bytes = [header(false), floats((0..6u8).flat_map(|i| [f32::from(i), 0.5, 1.0]))].concat();
        let Picture::Spectral(image) = Picture::decode(&bytes).unwrap() else { panic!("a spectrum") };
        assert_eq!((image.width, image.height, &image.band_edges_nm[..]), (3, 2, &[400.0, 500.0, 700.0][..]));
        assert_eq!(image.radiance, [0.0, 0.5, 1.0, 0.5, 2.0, 0.5, 3.0, 0.5, 4.0, 0.5, 5.0, 0.5]);
        assert!(image.stokes.is_none());
    }

    #[test]
    fn polarised_pixels_are_read_where_they_are_flagged() {
        let mut bytes = header(true);
        for _ in 0..2 {
            bytes.push(0b0100_0000);
            bytes.extend(floats([1.0, 2.0, 1.0]));
            bytes.extend(floats([3.0, 4.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 1.0]));
            bytes.extend(floats([5.0, 6.0, 1.0]));
        }
        let Picture::Spectral(image) = Picture::decode(&bytes).unwrap() else { panic!("a spectrum") };
        assert_eq!(image.radiance[..6], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let stokes = image.stokes.unwrap();
        assert_eq!(
            (stokes[0], stokes[2], stokes[3], stokes[4]),
            ([0.0; 3], [0.1, 0.3, 0.5], [0.2, 0.4, 0.6], [0.0; 3])
        );
    }

    #[test]
    fn cut_and_broken_files_are_errors() {
        let whole = [header(false), floats([1.0; 18])].concat();
        for cut in 0..whole.len() {
            assert!(Picture::decode(&whole[..cut]).is_err(), "cut at {cut}");
        }
        for at in 0..whole.len() {
            let mut broken = whole.clone();
            broken[at] ^= 0x11;
            let _ = Picture::decode(&broken);
        }
    }
}
