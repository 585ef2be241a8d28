//! Spectral OpenEXR files in the layout of Fichet, Pacanowski and Wilkie, "An OpenEXR Layout for Spectral Images",
//! JCGT 10(3), 2021.
//!
//! Channels, all 32 bit: `S0.<centre>nm` per band with a decimal comma and six decimals, for polarised images `S1`, `S2` and
//! `S3` likewise, with the attribute `polarisationHandedness` "right"; `R`, `G`, `B`, linear sRGB in
//! which the relative luminance 1 is [`UNIT_LUMINANCE`] cd m^-2 (also the attribute `whiteLuminance`); `XYZ.X`,
//! `XYZ.Y`, `XYZ.Z` with Y in cd m^-2; further channels under their own names. Attributes: `spectralLayoutVersion` "1.0", `emissiveUnits` "W.m^-2.sr^-1" (the
//! one value that the layout's readers know; the samples are densities, W m^-2 sr^-1 nm^-1, which
//! `arsc:radianceUnits` says), `arsc:bandEdges`, and the image's metadata as `arsc:<name>`.
//! ZIP in blocks of 16 lines, lines in increasing order, attributes sorted by name.

use arsc_spectral::colour_space;
use arsc_spectral::srgb::rgb_from_xyz;
use exr::meta::attribute::Chromaticities;
use exr::prelude::*;
use glam::{DMat3, Vec3};

use crate::{Channel, ColourImage, DisplayImage, ImageError, SpectralImage, UNIT_LUMINANCE, exr_header};

/// The bytes of a spectral OpenEXR file.
pub fn encode_exr(image: &SpectralImage) -> std::result::Result<Vec<u8>, ImageError> {
    image.verify()?;
    let attributes = attributes(image);
    let channels = [bands(image), colours(&image.xyz), further(&image.channels)].concat();
    encode(Vec2(image.width, image.height), attributes, None, channels)
}

/// The bytes of an OpenEXR file of colours: `R`, `G`, `B` and `XYZ.*` as in spectral files.
pub fn encode_colour_exr(image: &ColourImage) -> std::result::Result<Vec<u8>, ImageError> {
    image.verify()?;
    let mut attributes = LayerAttributes { white_luminance: Some(UNIT_LUMINANCE as f32), ..LayerAttributes::default() };
    add_metadata(&mut attributes, &image.metadata);
    encode(Vec2(image.width, image.height), attributes, None, [colours(&image.xyz), further(&image.channels)].concat())
}

/// The bytes of an OpenEXR file of what a display shows: linear components in [0, 1], with its primaries.
pub fn encode_display_exr(image: &DisplayImage) -> std::result::Result<Vec<u8>, ImageError> {
    image.verify()?;
    let transfer = image.space.transfer();
    let linear = |c: usize| image.rgb.iter().map(|p| transfer.decode(f64::from(p[c])) as f32).collect();
    let channels = ["R", "G", "B"].into_iter().enumerate().map(|(i, name)| channel(name, linear(i))).collect();
    let mut attributes = LayerAttributes::default();
    add_metadata(&mut attributes, &image.metadata);
    let [red, green, blue] = image.space.primaries().map(place);
    let chromaticities = Chromaticities { red, green, blue, white: place(colour_space::D65_WHITE) };
    encode(Vec2(image.width, image.height), attributes, Some(chromaticities), channels)
}

fn place([x, y]: [f64; 2]) -> Vec2<f32> {
    Vec2(x as f32, y as f32)
}

fn encode(
    size: Vec2<usize>,
    attributes: LayerAttributes,
    chromaticities: Option<Chromaticities>,
    channels: Vec<AnyChannel<FlatSamples>>,
) -> std::result::Result<Vec<u8>, ImageError> {
    let failed = |source: Box<dyn std::error::Error + Send + Sync>| ImageError::Encode { format: "OpenEXR", source };
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let layer = Layer::new(size, attributes, encoding, AnyChannels::sort(channels.into()));
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = chromaticities;
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(|error| failed(Box::new(error)))?;
    let mut bytes = bytes.into_inner();
    exr_header::sort_attributes(&mut bytes).ok_or_else(|| failed("the header cannot be sorted".into()))?;
    Ok(bytes)
}

fn channel(name: &str, samples: Vec<f32>) -> AnyChannel<FlatSamples> {
    AnyChannel::new(name, FlatSamples::F32(samples))
}

fn bands(image: &SpectralImage) -> Vec<AnyChannel<FlatSamples>> {
    let bands = image.bands();
    let mut channels: Vec<_> = (0..bands)
        .map(|band| {
            let samples = image.radiance.iter().skip(band).step_by(bands).copied().collect();
            channel(&band_name(0, image.band_center_nm(band)), samples)
        })
        .collect();
    for parameter in 0..image.stokes.as_ref().map_or(0, |_| 3) {
        for band in 0..bands {
            let samples = image.stokes.iter().flatten().skip(band).step_by(bands).map(|s| s[parameter]).collect();
            channels.push(channel(&band_name(parameter + 1, image.band_center_nm(band)), samples));
        }
    }
    channels
}

fn colours(xyz: &[[f32; 3]]) -> Vec<AnyChannel<FlatSamples>> {
    let rgb_from_xyz: DMat3 = rgb_from_xyz() * UNIT_LUMINANCE.recip();
    let rgb: Vec<[f32; 3]> =
        xyz.iter().map(|&xyz| (rgb_from_xyz * Vec3::from_array(xyz).as_dvec3()).as_vec3().to_array()).collect();
    let three = |names: [&str; 3], values: &[[f32; 3]]| {
        names.into_iter().enumerate().map(|(i, name)| channel(name, values.iter().map(|p| p[i]).collect())).collect()
    };
    let (rgb, xyz): (Vec<_>, Vec<_>) = (three(["R", "G", "B"], &rgb), three(["XYZ.X", "XYZ.Y", "XYZ.Z"], xyz));
    [rgb, xyz].concat()
}

fn further(channels: &[Channel]) -> Vec<AnyChannel<FlatSamples>> {
    channels.iter().map(|extra| channel(&extra.name, extra.samples.clone())).collect()
}

/// `S0.550,000000nm`
fn band_name(parameter: usize, center_nm: f64) -> String {
    format!("S{parameter}.{}nm", format!("{center_nm:.6}").replace('.', ","))
}

fn attributes(image: &SpectralImage) -> LayerAttributes {
    let mut attributes = LayerAttributes { white_luminance: Some(UNIT_LUMINANCE as f32), ..LayerAttributes::default() };
    let mut text = |name: &str, value: &str| {
        attributes.other.insert(utf8(name), AttributeValue::Text(utf8(value)));
    };
    text("spectralLayoutVersion", "1.0");
    text("emissiveUnits", "W.m^-2.sr^-1");
    if image.stokes.is_some() {
        text("polarisationHandedness", "right");
    }
    text("arsc:radianceUnits", "W.m^-2.sr^-1.nm^-1");
    let edges: Vec<String> = image.band_edges_nm.iter().map(f64::to_string).collect();
    text("arsc:bandEdges", &edges.join(";"));
    add_metadata(&mut attributes, &image.metadata);
    attributes
}

fn add_metadata(attributes: &mut LayerAttributes, metadata: &[(String, String)]) {
    for (name, value) in metadata {
        attributes.other.insert(utf8(&format!("arsc:{name}")), AttributeValue::Text(utf8(value)));
    }
}

/// OpenEXR strings are bytes; they hold UTF-8 here.
fn utf8(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn band_names_have_a_comma_and_six_decimals() {
        assert_eq!(band_name(0, 550.0), "S0.550,000000nm");
        assert_eq!(band_name(3, 365.25), "S3.365,250000nm");
    }
}
