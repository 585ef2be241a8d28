//! Reading OpenEXR files.
//!
//! Spectral images as [`crate::encode_exr`] writes them and, of the layout by Fichet, Pacanowski and Wilkie, emissive
//! images (`S0.<λ>nm`, and `S1` to `S3` where all three are there with the same wavelengths) of other writers, in any
//! unit of wavelength or frequency that the layout allows: without `arsc:bandEdges` the edges are the midpoints between
//! neighbouring wavelengths, as the layout prescribes; without `XYZ.*` the colour follows from the bands.
//! Left-handed circular polarisation is turned to right-handed.
//! Colours: `XYZ.*`, else `R`, `G`, `B` or `Y`, linear, by the attributes `chromaticities` and `whiteLuminance`.

use exr::prelude::*;
use glam::DMat3;

use arsc_spectral::{colour_space, srgb};

use crate::{Channel, ColourImage, ImageError, Picture, SpectralImage, UNIT_LUMINANCE, claims, spectral};

type Failure = Box<dyn std::error::Error + Send + Sync>;

type Whole = Image<Layer<AnyChannels<FlatSamples>>>;

/// A spectral image from the bytes of a file.
///
/// Errors: [`ImageError::Decode`] for what is no OpenEXR file or claims more pixels than its bytes can hold,
/// [`ImageError::NotSpectral`] for what lacks the spectral channels.
pub fn decode_exr(bytes: &[u8]) -> std::result::Result<SpectralImage, ImageError> {
    from_layer(&decode(bytes)?.layer_data)
}

/// A spectral image, or one of colours where there are no spectral channels.
pub fn decode_exr_picture(bytes: &[u8]) -> std::result::Result<Picture, ImageError> {
    let image = decode(bytes)?;
    if bands_of(&image.layer_data.channel_data.list, '0').is_empty() {
        return colours(&image).map(Picture::Colour);
    }
    from_layer(&image.layer_data).map(Picture::Spectral)
}

fn decode(bytes: &[u8]) -> std::result::Result<Whole, ImageError> {
    let failed = |source: Failure| ImageError::Decode { format: "OpenEXR", source };
    check_claimed_size(bytes).map_err(failed)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(std::io::Cursor::new(bytes))
        .map_err(|error| failed(Box::new(error)))?;
    let pixels = image.layer_data.size.area();
    let short = |channel: &AnyChannel<FlatSamples>| channel.sample_data.len() != pixels;
    if image.layer_data.channel_data.list.iter().any(short) {
        return Err(ImageError::Malformed("channels of fewer samples than pixels are not read".into()));
    }
    Ok(image)
}

fn check_claimed_size(bytes: &[u8]) -> std::result::Result<(), Failure> {
    let meta = MetaData::read_from_buffered(std::io::Cursor::new(bytes), false)?;
    let limit = claims::most_bytes(bytes) as u64;
    for header in &meta.headers {
        let size = header.layer_size;
        let samples = (size.0 as u64).saturating_mul(size.1 as u64).saturating_mul(header.channels.list.len() as u64);
        if samples.saturating_mul(2) > limit {
            return Err("the header claims more pixels than the file can hold".into());
        }
    }
    Ok(())
}

/// Colours of a file without spectral channels.
fn colours(image: &Whole) -> std::result::Result<ColourImage, ImageError> {
    let layer = &image.layer_data;
    let channels = &layer.channel_data.list;
    let size = [layer.size.0, layer.size.1];
    let three = |names: [&str; 3]| -> Option<Vec<[f64; 3]>> {
        let named = |name: &str| channels.iter().find(|channel| channel.name.eq(name));
        let [Some(a), Some(b), Some(c)] = names.map(named) else { return None };
        let [a, b, c] = [a, b, c].map(|channel| channel.sample_data.values_as_f32().map(f64::from));
        Some(a.zip(b).zip(c).map(|((a, b), c)| [a, b, c]).collect())
    };
    let rgb = || three(["R", "G", "B"]).or_else(|| three(["Y"; 3]));
    let mut colours = if let Some(xyz) = three(["XYZ.X", "XYZ.Y", "XYZ.Z"]) {
        ColourImage::from_linear(size, xyz.into_iter(), DMat3::IDENTITY)?
    } else if let Some(rgb) = rgb() {
        ColourImage::from_linear(size, rgb.into_iter(), absolute_xyz_from_rgb(image))?
    } else {
        return Err(ImageError::Malformed("it has neither S0.<wavelength>nm, nor XYZ, nor R, G, B, nor Y".into()));
    };
    colours.channels = further_channels(channels);
    colours.metadata = metadata(&layer.attributes).0;
    colours.verify()?;
    Ok(colours)
}

/// By the primaries and the luminance of white that the file states, else sRGB and [`UNIT_LUMINANCE`].
fn absolute_xyz_from_rgb(image: &Whole) -> DMat3 {
    let luminance = image.layer_data.attributes.white_luminance.map(f64::from).filter(|l| *l > 0.0 && l.is_finite());
    let stated = image.attributes.chromaticities.map(|c| {
        let [red, green, blue, white] = [c.red, c.green, c.blue, c.white].map(|p| [f64::from(p.0), f64::from(p.1)]);
        colour_space::xyz_from_rgb([red, green, blue], white)
    });
    stated.filter(|m| m.is_finite()).unwrap_or_else(srgb::xyz_from_rgb) * luminance.unwrap_or(UNIT_LUMINANCE)
}

fn from_layer(layer: &Layer<AnyChannels<FlatSamples>>) -> std::result::Result<SpectralImage, ImageError> {
    let (width, height) = (layer.size.0, layer.size.1);
    let named = |name: &str| layer.channel_data.list.iter().find(|channel| channel.name.eq(name));
    let bands_of = |parameter| bands_of(&layer.channel_data.list, parameter);
    let bands = bands_of('0');
    if bands.is_empty() {
        return Err(ImageError::NotSpectral("no channel is named S0.<wavelength>nm".into()));
    }
    let mut radiance = vec![0.0; width * height * bands.len()];
    for (band, (_, channel)) in bands.iter().enumerate() {
        for (pixel, value) in channel.sample_data.values_as_f32().enumerate() {
            radiance[pixel * bands.len() + band] = value;
        }
    }
    let polarisation = ['1', '2', '3'].map(bands_of);
    let same = |more: &Vec<(f64, _)>| more.iter().map(|b| b.0).eq(bands.iter().map(|b| b.0));
    let mut stokes = polarisation.iter().all(same).then(|| vec![[0.0; 3]; radiance.len()]);
    for (parameter, (band, (_, channel))) in
        polarisation.iter().enumerate().flat_map(|(i, p)| p.iter().enumerate().map(move |b| (i, b)))
    {
        for (stokes, value) in stokes
            .iter_mut()
            .flat_map(|s| s.iter_mut().skip(band).step_by(bands.len()))
            .zip(channel.sample_data.values_as_f32())
        {
            stokes[parameter] = value;
        }
    }
    let centers: Vec<f64> = bands.iter().map(|band| band.0).collect();
    let (metadata, edges) = metadata(&layer.attributes);
    if handedness(&layer.attributes).as_deref() == Some("left") {
        stokes.iter_mut().flatten().for_each(|stokes| stokes[2] = -stokes[2]);
    }
    let edges = edges.filter(|e| e.len() == centers.len() + 1).unwrap_or_else(|| spectral::midpoints(&centers));
    let mut image = spectral::from_bands([width, height], edges, radiance, stokes)?;
    if let [Some(x), Some(y), Some(z)] = ["XYZ.X", "XYZ.Y", "XYZ.Z"].map(named) {
        let xyz = x.sample_data.values_as_f32().zip(y.sample_data.values_as_f32()).zip(z.sample_data.values_as_f32());
        image.xyz = xyz.map(|((x, y), z)| [x, y, z]).collect();
    }
    image.channels = further_channels(&layer.channel_data.list);
    image.metadata = metadata;
    image.verify()?;
    Ok(image)
}

/// What is neither a band, nor XYZ, nor their sRGB, by name.
fn further_channels(channels: &[AnyChannel<FlatSamples>]) -> Vec<Channel> {
    let known = |name: &str| {
        ["R", "G", "B", "XYZ.X", "XYZ.Y", "XYZ.Z"].contains(&name)
            || ['0', '1', '2', '3'].iter().any(|&parameter| wavelength_nm(name, parameter).is_some())
    };
    let mut further: Vec<Channel> = channels
        .iter()
        .map(|channel| (channel.name.to_string(), channel))
        .filter(|(name, _)| !known(name))
        .map(|(name, channel)| Channel { name, samples: channel.sample_data.values_as_f32().collect() })
        .collect();
    further.sort_by(|a, b| a.name.cmp(&b.name));
    further.dedup_by(|a, b| a.name == b.name);
    further
}

/// The channels of a Stokes parameter by increasing wavelength, nm.
fn bands_of(channels: &[AnyChannel<FlatSamples>], parameter: char) -> Vec<(f64, &AnyChannel<FlatSamples>)> {
    let mut bands: Vec<_> =
        channels.iter().filter_map(|c| Some((wavelength_nm(&c.name.to_string(), parameter)?, c))).collect();
    bands.sort_by(|a, b| a.0.total_cmp(&b.0));
    bands
}

/// The wavelength of `S0.550,000000nm`, for the Stokes parameter 0; also in other units, as `S0.545,0THz`.
fn wavelength_nm(channel: &str, parameter: char) -> Option<f64> {
    let quantity = channel.strip_prefix('S')?.strip_prefix(parameter)?.strip_prefix('.')?;
    let (quantity, is_frequency) = match quantity.strip_suffix("Hz") {
        Some(quantity) => (quantity, true),
        None => (quantity.strip_suffix('m')?, false),
    };
    let digits = quantity.trim_end_matches(char::is_alphabetic);
    let (digits, prefix) = quantity.split_at(digits.len());
    let scale = match prefix {
        "" => 1.0,
        "Y" => 1e24,
        "Z" => 1e21,
        "E" => 1e18,
        "P" => 1e15,
        "T" => 1e12,
        "G" => 1e9,
        "M" => 1e6,
        "k" => 1e3,
        "h" => 1e2,
        "da" => 1e1,
        "d" => 1e-1,
        "c" => 1e-2,
        "m" => 1e-3,
        "u" => 1e-6,
        "n" => 1e-9,
        "p" => 1e-12,
        _ => return None,
    };
    let number: f64 = digits.replace(',', ".").parse().ok()?;
    // What is written in nanometres stays the number that was written.
    let value = match (is_frequency, prefix) {
        (true, _) => 299_792_458e9 / (number * scale),
        (false, "n") => number,
        (false, _) => number * scale * 1e9,
    };
    (value.is_finite() && value > 0.0).then_some(value)
}

/// What the file says of circular polarisation.
fn handedness(attributes: &LayerAttributes) -> Option<String> {
    match attributes.other.get(&Text::from("polarisationHandedness"))? {
        AttributeValue::Text(text) => Some(text.to_string()),
        _ => None,
    }
}

type Metadata = Vec<(String, String)>;

/// The `arsc:` attributes sorted by name, with the band edges taken out.
fn metadata(attributes: &LayerAttributes) -> (Metadata, Option<Vec<f64>>) {
    let mut texts: Metadata = Vec::new();
    for (name, value) in &attributes.other {
        let name = String::from_utf8_lossy(name.as_slice());
        if let (Some(name), AttributeValue::Text(text)) = (name.strip_prefix("arsc:"), value) {
            texts.push((name.to_owned(), String::from_utf8_lossy(text.as_slice()).into_owned()));
        }
    }
    texts.sort();
    let edges = texts
        .iter()
        .find(|(name, _)| name == "bandEdges")
        .and_then(|(_, text)| text.split(';').map(|edge| edge.parse::<f64>().ok()).collect::<Option<Vec<f64>>>());
    texts.retain(|(name, _)| name != "bandEdges" && name != "radianceUnits");
    (texts, edges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encode_exr;

    fn image() -> SpectralImage {
        let (width, height, bands) = (37, 21, 47);
        SpectralImage {
            width,
            height,
            band_edges_nm: (0..=bands).map(|i| 360.0 + 10.0 * i as f64).collect(),
            radiance: (0..width * height * bands).map(|i| (i as f32 * 0.37).sin().abs() * 1e-3).collect(),
            stokes: None,
            xyz: (0..width * height).map(|i| [i as f32, i as f32 * 0.5, 1.0]).collect(),
            channels: vec![],
            metadata: vec![
                ("command".into(), "arsc render Würfel.arsl".into()),
                ("seed".into(), "7".into()),
                ("version".into(), "0.1.0".into()),
            ],
        }
    }

    #[test]
    fn reads_back_what_was_written_and_bytes_are_reproducible() {
        let image = image();
        let bytes = encode_exr(&image).unwrap();
        for _ in 0..3 {
            assert_eq!(bytes, encode_exr(&image).unwrap(), "same image, same bytes");
        }
        assert_eq!(decode_exr(&bytes).unwrap(), image);
    }

    #[test]
    fn polarised_images_keep_their_stokes_parameters() {
        let mut image = image();
        let of = |i: usize| [i as f32, -(i as f32), 0.5 * i as f32];
        image.stokes = Some((0..image.radiance.len()).map(of).collect());
        assert_eq!(decode_exr(&encode_exr(&image).unwrap()).unwrap(), image);
        image.stokes.as_mut().unwrap().pop();
        assert!(matches!(encode_exr(&image), Err(ImageError::Shape { what: "stokes", .. })));
    }

    #[test]
    fn further_channels_travel_with_the_image() {
        let mut image = image();
        let channel = |name: &str, scale: f32| Channel {
            name: name.into(),
            samples: (0..image.xyz.len()).map(|i| scale * i as f32).collect(),
        };
        image.channels = vec![channel("depth.Z", 0.5), channel("normal.X", -1.0)];
        let read = decode_exr(&encode_exr(&image).unwrap()).unwrap();
        assert_eq!(read, image);
        assert_eq!(read.channel("normal.X").unwrap()[3], -3.0);
        assert_eq!(read.channel("normal.Y"), None);
        image.channels.swap(0, 1);
        assert!(encode_exr(&image).is_err(), "unsorted");
    }

    #[test]
    fn garbage_and_cut_files_are_errors() {
        let bytes = encode_exr(&image()).unwrap();
        assert!(matches!(decode_exr(b"not an image"), Err(ImageError::Decode { .. })));
        for cut in [0, 4, 9, 100, bytes.len() / 2] {
            assert!(decode_exr(&bytes[..cut]).is_err(), "cut at {cut}");
        }
    }

    #[test]
    fn a_claim_of_too_many_pixels_is_refused_without_allocating_them() {
        let mut bytes = encode_exr(&image()).unwrap();
        // Windows are boxes of four i32 behind the attribute's name, type and size.
        for name in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
            let at = bytes.windows(name.len()).position(|w| w == name).unwrap() + name.len() + 4;
            bytes[at + 8..at + 12].copy_from_slice(&999_999i32.to_le_bytes());
            bytes[at + 12..at + 16].copy_from_slice(&999_999i32.to_le_bytes());
        }
        assert!(matches!(decode_exr(&bytes), Err(ImageError::Decode { .. })));
    }

    #[test]
    fn wavelengths_have_many_units() {
        for (name, nm) in [
            ("S0.550,000000nm", 550.0),
            ("S0.5,5e-7m", 550.0),
            ("S0.0,55um", 550.0),
            ("S0.545,0THz", 550.077_9),
            ("S0.5,45E+14Hz", 550.077_9),
        ] {
            assert!(wavelength_nm(name, '0').is_some_and(|found| (found - nm).abs() < 1e-3), "{name}");
        }
        for name in ["S1.550nm", "S0.nm", "S0.-5nm", "S0.550xm", "S0.550", "T.550nm", "S0.infnm", "S0.0nm"] {
            assert_eq!(wavelength_nm(name, '0'), None, "{name}");
        }
    }

    #[test]
    fn buffers_of_the_wrong_size_are_errors() {
        let mut image = image();
        image.radiance.pop();
        assert!(matches!(encode_exr(&image), Err(ImageError::Shape { what: "radiance", .. })));
    }
}
