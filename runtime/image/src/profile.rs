//! ICC colour profiles of displays: three primaries and a curve each.
//!
//! Written: version 4.2 with parametric curves (ICC.1:2010), so that a [`ColourSpace`] is stated exactly but for the 16
//! bit of its fractions. Read: every profile of class RGB with matrix and curves, version 2 or 4. Colours of a profile
//! are relative to D50; the adaptation between D65 and D50 is Bradford's.

use arsc_spectral::adaptation::Adaptation;
use arsc_spectral::colour_space::{ColourSpace, D65_WHITE, Transfer};
use glam::{DMat3, DVec3};

/// Chromaticity of the connection space's white, from X 0.9642, Y 1, Z 0.8249.
const D50_WHITE: [f64; 2] = [0.9642 / 2.7891, 1.0 / 2.7891];

/// The profile of a colour space.
pub fn encode(space: ColourSpace) -> Vec<u8> {
    let adaptation = Adaptation::Bradford.matrix(D65_WHITE, D50_WHITE);
    let primaries = adaptation * space.xyz_from_rgb();
    let curve = parametric(&space.transfer());
    let tags: [(&[u8; 4], Vec<u8>); 10] = [
        (b"desc", unicode(space.title())),
        (b"cprt", unicode("No copyright, use freely")),
        (b"wtpt", xyz(DVec3::new(0.9642, 1.0, 0.8249))),
        (b"chad", [&b"sf32\0\0\0\0"[..], &fixed(&adaptation.transpose().to_cols_array())].concat()),
        (b"rXYZ", xyz(primaries.x_axis)),
        (b"gXYZ", xyz(primaries.y_axis)),
        (b"bXYZ", xyz(primaries.z_axis)),
        (b"rTRC", curve.clone()),
        (b"gTRC", curve.clone()),
        (b"bTRC", curve),
    ];
    let mut table = (tags.len() as u32).to_be_bytes().to_vec();
    let (mut data, start) = (Vec::new(), 128 + 4 + 12 * tags.len());
    for (name, content) in &tags {
        table.extend_from_slice(*name);
        table.extend(((start + data.len()) as u32).to_be_bytes());
        table.extend((content.len() as u32).to_be_bytes());
        data.extend(content);
        data.resize(data.len().next_multiple_of(4), 0);
    }
    [header(start + data.len()), table, data].concat()
}

fn header(size: usize) -> Vec<u8> {
    let mut header = vec![0; 128];
    let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, &(size as u32).to_be_bytes());
    put(8, &[4, 0x20, 0, 0]);
    put(12, b"mntrRGB XYZ ");
    // A date that never changes: equal pictures are equal files.
    put(24, &[0x07, 0xE8, 0, 1, 0, 1]);
    put(36, b"acsp");
    put(68, &fixed(&[0.9642, 1.0, 0.8249]));
    header
}

/// s15Fixed16Number
fn fixed(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|n| ((n * 65_536.0).round() as i32).to_be_bytes()).collect()
}

fn xyz(colour: DVec3) -> Vec<u8> {
    [&b"XYZ \0\0\0\0"[..], &fixed(&colour.to_array())].concat()
}

fn parametric(transfer: &Transfer) -> Vec<u8> {
    let Transfer { g, a, b, c, d } = *transfer;
    [&b"para\0\0\0\0\0\x03\0\0"[..], &fixed(&[g, a, b, c, d])].concat()
}

/// multiLocalizedUnicodeType with one record.
fn unicode(text: &str) -> Vec<u8> {
    let words: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    let record = [1, 12].map(u32::to_be_bytes).concat();
    let place = [words.len() as u32, 28].map(u32::to_be_bytes).concat();
    [&b"mluc\0\0\0\0"[..], &record, b"enUS", &place, &words].concat()
}

/// What a profile says of the components of a picture.
#[derive(Clone, Debug)]
pub struct Profile {
    /// Relative to D65.
    xyz_from_rgb: DMat3,
    curves: [Curve; 3],
}

#[derive(Clone, Debug)]
enum Curve {
    Power(f64),
    Parametric { transfer: Transfer, e: f64, f: f64 },
    Table(Vec<f64>),
}

impl Profile {
    /// `None` for what is no RGB profile with matrix and curves.
    pub fn read(bytes: &[u8]) -> Option<Profile> {
        if bytes.get(16..20)? != b"RGB " || bytes.get(20..24)? != b"XYZ " || bytes.get(36..40)? != b"acsp" {
            return None;
        }
        let primary = |name: &[u8; 4]| {
            let content = tag(bytes, name)?;
            (content.get(..4)? == b"XYZ ").then_some(())?;
            Some(DVec3::new(fixed_at(content, 8)?, fixed_at(content, 12)?, fixed_at(content, 16)?))
        };
        let relative = DMat3::from_cols(primary(b"rXYZ")?, primary(b"gXYZ")?, primary(b"bXYZ")?);
        let curve = |name: &[u8; 4]| Curve::read(tag(bytes, name)?);
        let adaptation = Adaptation::Bradford.matrix(D50_WHITE, D65_WHITE);
        Some(Profile {
            xyz_from_rgb: adaptation * relative,
            curves: [curve(b"rTRC")?, curve(b"gTRC")?, curve(b"bTRC")?],
        })
    }

    /// Relative XYZ of coded components in [0, 1].
    pub fn xyz(&self, rgb: [f64; 3]) -> DVec3 {
        let linear: [f64; 3] = std::array::from_fn(|c| self.curves[c].decode(rgb[c]));
        self.xyz_from_rgb * DVec3::from_array(linear)
    }
}

impl Curve {
    fn read(content: &[u8]) -> Option<Curve> {
        match content.get(..4)? {
            b"curv" => {
                let count = u32::from_be_bytes(content.get(8..12)?.try_into().ok()?) as usize;
                let words: Vec<u16> = content
                    .get(12..12usize.checked_add(count.checked_mul(2)?)?)?
                    .chunks_exact(2)
                    .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
                    .collect();
                Some(match words[..] {
                    [] => Curve::Power(1.0),
                    [gamma] => Curve::Power(f64::from(gamma) / 256.0),
                    _ => Curve::Table(words.iter().map(|w| f64::from(*w) / 65_535.0).collect()),
                })
            }
            b"para" => {
                let number = |i: usize| fixed_at(content, 12 + 4 * i);
                let of = |a, b, c, d, e, f| {
                    Some(Curve::Parametric { transfer: Transfer { g: number(0)?, a, b, c, d }, e, f })
                };
                match u16::from_be_bytes(content.get(8..10)?.try_into().ok()?) {
                    0 => Some(Curve::Power(number(0)?)),
                    1 => of(number(1)?, number(2)?, 0.0, -number(2)? / number(1)?, 0.0, 0.0),
                    2 => of(number(1)?, number(2)?, 0.0, -number(2)? / number(1)?, number(3)?, number(3)?),
                    3 => of(number(1)?, number(2)?, number(3)?, number(4)?, 0.0, 0.0),
                    4 => of(number(1)?, number(2)?, number(3)?, number(4)?, number(5)?, number(6)?),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    fn decode(&self, coded: f64) -> f64 {
        match self {
            Curve::Power(gamma) => coded.max(0.0).powf(*gamma),
            Curve::Parametric { transfer, e, f } => transfer.decode(coded) + if coded >= transfer.d { *e } else { *f },
            Curve::Table(values) => {
                let at = coded.clamp(0.0, 1.0) * (values.len() - 1) as f64;
                let i = (at as usize).min(values.len() - 2);
                values[i] + (at - i as f64) * (values[i + 1] - values[i])
            }
        }
    }
}

fn tag<'a>(bytes: &'a [u8], name: &[u8; 4]) -> Option<&'a [u8]> {
    let word = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    // No profile has a thousand tags.
    let at = (0..word(128)?.min(1_000)).map(|i| 132 + 12 * i).find(|at| bytes.get(*at..at + 4) == Some(name))?;
    let start = word(at + 4)?;
    bytes.get(start..start.checked_add(word(at + 8)?)?)
}

fn fixed_at(bytes: &[u8], at: usize) -> Option<f64> {
    Some(f64::from(i32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?)) / 65_536.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_read_back_as_their_space() {
        for space in ColourSpace::ALL {
            let profile = Profile::read(&encode(space)).unwrap();
            for rgb in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.5, 0.02, 0.9], [0.01, 1.0, 0.3]] {
                let linear = DVec3::from_array(rgb.map(|c| space.transfer().decode(c)));
                let off = (profile.xyz(rgb) - space.xyz_from_rgb() * linear).abs().max_element();
                assert!(off < 1e-4, "{}: {rgb:?} off by {off}", space.name());
            }
        }
    }

    #[test]
    fn broken_profiles_are_refused() {
        let whole = encode(ColourSpace::DisplayP3);
        for cut in 0..whole.len() - 4 {
            assert!(Profile::read(&whole[..cut]).is_none(), "cut at {cut}");
        }
        for at in 0..whole.len() {
            let mut broken = whole.clone();
            broken[at] ^= 0xFF;
            if let Some(profile) = Profile::read(&broken) {
                profile.xyz([0.3, 0.5, 1.0]);
            }
        }
    }
}
