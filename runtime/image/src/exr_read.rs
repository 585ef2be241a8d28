//! Reading spectral OpenEXR files.
//!
//! Understands what [`crate::encode_exr`] writes and, of the layout by Fichet, Pacanowski and Wilkie, emissive images
//! (`S0.<λ>nm`, and `S1` to `S3` where all three are there with the same wavelengths) of other writers: without `arsc:bandEdges` the edges are the midpoints between
//! neighbouring wavelengths, as the layout prescribes; without `XYZ.*` the image is refused.

use exr::prelude::*;

use crate::{Channel, ImageError, SpectralImage};

/// ZIP shrinks at most by about this factor: a file that claims more pixels than that is not believed.
const LARGEST_COMPRESSION: u64 = 1100;

/// An image from the bytes of a file.
///
/// Errors: [`ImageError::Decode`] for what is no OpenEXR file or claims more pixels than its bytes can hold,
/// [`ImageError::NotSpectral`] for what lacks the spectral channels.
pub fn decode_exr(bytes: &[u8]) -> std::result::Result<SpectralImage, ImageError> {
    let failed = |source: Box<dyn std::error::Error + Send + Sync>| ImageError::Decode { format: "OpenEXR", source };
    check_claimed_size(bytes).map_err(failed)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(std::io::Cursor::new(bytes))
        .map_err(|error| failed(Box::new(error)))?;
    from_layer(&image.layer_data)
}

fn check_claimed_size(bytes: &[u8]) -> std::result::Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let meta = MetaData::read_from_buffered(std::io::Cursor::new(bytes), false)?;
    let limit = (bytes.len() as u64).saturating_mul(LARGEST_COMPRESSION);
    for header in &meta.headers {
        let size = header.layer_size;
        let samples = (size.0 as u64).saturating_mul(size.1 as u64).saturating_mul(header.channels.list.len() as u64);
        if samples > limit {
            return Err("the header claims more pixels than the file can hold".into());
        }
    }
    Ok(())
}

fn from_layer(layer: &Layer<AnyChannels<FlatSamples>>) -> std::result::Result<SpectralImage, ImageError> {
    let (width, height) = (layer.size.0, layer.size.1);
    let named = |name: &str| layer.channel_data.list.iter().find(|channel| channel.name.eq(name));
    let bands_of = |parameter| bands_of(&layer.channel_data.list, parameter);
    let bands = bands_of('0');
    if bands.is_empty() {
        return Err(ImageError::NotSpectral("no channel is named S0.<wavelength>nm".into()));
    }
    let [Some(x), Some(y), Some(z)] = ["XYZ.X", "XYZ.Y", "XYZ.Z"].map(named) else {
        return Err(ImageError::NotSpectral("the XYZ channels are missing".into()));
    };
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
    let xyz = x.sample_data.values_as_f32().zip(y.sample_data.values_as_f32()).zip(z.sample_data.values_as_f32());
    let centers: Vec<f64> = bands.iter().map(|band| band.0).collect();
    let (metadata, edges) = metadata(&layer.attributes);
    let image = SpectralImage {
        width,
        height,
        band_edges_nm: edges.filter(|e| e.len() == centers.len() + 1).unwrap_or_else(|| midpoints(&centers)),
        radiance,
        stokes,
        xyz: xyz.map(|((x, y), z)| [x, y, z]).collect(),
        channels: further_channels(&layer.channel_data.list),
        metadata,
    };
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

/// The wavelength of `S0.550,000000nm`, for the Stokes parameter 0.
fn wavelength_nm(channel: &str, parameter: char) -> Option<f64> {
    let number = channel.strip_prefix('S')?.strip_prefix(parameter)?.strip_prefix('.')?.strip_suffix("nm")?;
    let value: f64 = number.replace(',', ".").parse().ok()?;
    (value.is_finite() && value > 0.0).then_some(value)
}

/// Edges half-way between neighbours; the outermost bands are symmetric about their centres.
fn midpoints(centers: &[f64]) -> Vec<f64> {
    let (first, last) = (centers[0], centers[centers.len() - 1]);
    let half = |pair: Option<(f64, f64)>| pair.map_or(0.5, |(a, b)| 0.5 * (b - a));
    let at = |i: usize| Some((*centers.get(i)?, *centers.get(i + 1)?));
    std::iter::once(first - half(at(0)))
        .chain(centers.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])))
        .chain(std::iter::once(last + half(centers.len().checked_sub(2).and_then(at))))
        .collect()
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
    fn edges_default_to_midpoints() {
        assert_eq!(midpoints(&[400.0, 410.0, 430.0]), vec![395.0, 405.0, 420.0, 440.0]);
        assert_eq!(midpoints(&[500.0]), vec![499.5, 500.5]);
    }

    #[test]
    fn buffers_of_the_wrong_size_are_errors() {
        let mut image = image();
        image.radiance.pop();
        assert!(matches!(encode_exr(&image), Err(ImageError::Shape { what: "radiance", .. })));
    }
}
