//! Every kind of file: what is written reads back, and what is broken is an error.

use arsc_image::{
    Channel, ColourImage, Depth, DisplayImage, ImageError, Picture, SpectralImage, UNIT_LUMINANCE, decode_csv,
    encode_colour_exr, encode_csv, encode_display_exr, encode_exr, encode_png, encode_tiff,
};
use arsc_spectral::colour_space::ColourSpace;
use glam::DVec3;

fn spectral() -> SpectralImage {
    let (width, height, bands) = (5, 3, 4);
    SpectralImage {
        width,
        height,
        band_edges_nm: vec![400.0, 450.0, 500.0, 600.0, 700.0],
        radiance: (0..width * height * bands).map(|i| (i as f32 * 0.7).sin().abs() + 0.001).collect(),
        stokes: None,
        xyz: (0..width * height).map(|i| [i as f32, 2.0 * i as f32, 1.0]).collect(),
        channels: vec![Channel { name: "albedo.R".into(), samples: vec![0.5; width * height] }],
        metadata: vec![("samples".into(), "16".into())],
    }
}

fn display(space: ColourSpace) -> DisplayImage {
    let rgb = (0..15).map(|i| [i as f32 / 15.0, 1.0 - i as f32 / 15.0, 0.4]).collect();
    DisplayImage { width: 5, height: 3, space, rgb, metadata: vec![("seed".into(), "7".into())] }
}

fn colour() -> ColourImage {
    let SpectralImage { width, height, xyz, channels, metadata, .. } = spectral();
    ColourImage { width, height, xyz, channels, metadata }
}

/// One small file of each kind.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("spectral.exr", encode_exr(&spectral()).unwrap()),
        ("colour.exr", encode_colour_exr(&colour()).unwrap()),
        ("display.exr", encode_display_exr(&display(ColourSpace::DisplayP3)).unwrap()),
        ("a.png", encode_png(&display(ColourSpace::Srgb), Depth::Eight).unwrap()),
        ("wide.png", encode_png(&display(ColourSpace::Rec2020), Depth::Sixteen).unwrap()),
        ("a.tif", encode_tiff(&display(ColourSpace::AdobeRgb), Depth::Eight).unwrap()),
        ("wide.tif", encode_tiff(&display(ColourSpace::Srgb), Depth::Sixteen).unwrap()),
        ("a.csv", encode_csv(&spectral()).unwrap().into_bytes()),
    ]
}

#[test]
fn pictures_read_back() {
    assert_eq!(Picture::decode(&encode_exr(&spectral()).unwrap()).unwrap(), Picture::Spectral(spectral()));
    assert_eq!(Picture::decode(&encode_colour_exr(&colour()).unwrap()).unwrap(), Picture::Colour(colour()));
}

#[test]
fn text_keeps_every_bit_of_the_radiances() {
    let read = decode_csv(&encode_csv(&spectral()).unwrap()).unwrap();
    assert_eq!((read.width, read.height, read.radiance), (5, 3, spectral().radiance));
    assert_eq!(read.band_edges_nm.len(), 5);
}

/// A colour coded for any display comes back as the same colour.
#[test]
fn displays_of_all_spaces_mean_the_same_colours() {
    for space in ColourSpace::ALL {
        let image = display(space);
        let linear = |c: f32| space.transfer().decode(f64::from(c));
        let meant: Vec<DVec3> =
            image.rgb.iter().map(|p| space.xyz_from_rgb() * DVec3::from_array(p.map(linear))).collect();
        for (kind, bytes, tolerance) in [
            ("png8", encode_png(&image, Depth::Eight), 8e-3),
            ("png16", encode_png(&image, Depth::Sixteen), 2e-4),
            ("tiff8", encode_tiff(&image, Depth::Eight), 8e-3),
            ("tiff16", encode_tiff(&image, Depth::Sixteen), 2e-4),
            ("exr", encode_display_exr(&image), 1e-6),
        ] {
            let picture = Picture::decode(&bytes.unwrap()).unwrap();
            for (found, meant) in picture.xyz().iter().zip(&meant) {
                let off = (DVec3::from_array(found.map(f64::from)) / UNIT_LUMINANCE - *meant).abs().max_element();
                assert!(off < tolerance, "{} as {kind}: off by {off}", space.name());
            }
        }
    }
}

#[test]
fn cut_files_are_errors() {
    for (name, bytes) in files() {
        for cut in 0..bytes.len() {
            // A PNG may lack its last chunk, which says nothing; text may lack digits or lines at its end.
            let may_pass = cut + 12 >= bytes.len() || name.ends_with(".csv");
            match Picture::decode(&bytes[..cut]) {
                Err(_) => {}
                Ok(picture) => assert!(
                    may_pass && (picture.width() == 5 || name.ends_with(".csv")),
                    "{name} cut at {cut} of {}",
                    bytes.len()
                ),
            }
        }
    }
}

/// Whatever byte is broken: an error or a picture, never a panic.
#[test]
fn broken_bytes_do_no_harm() {
    for (name, bytes) in files() {
        for at in 0..bytes.len() {
            for flip in [0x01, 0x80, 0xFF] {
                let mut broken = bytes.clone();
                broken[at] ^= flip;
                if let Ok(picture) = Picture::decode(&broken) {
                    assert_eq!(picture.xyz().len(), picture.width() * picture.height(), "{name} at {at}");
                }
            }
        }
    }
}

#[test]
fn what_is_no_picture_says_so() {
    for bytes in [&b""[..], b"x", b"scene { sphere() }", b"\0\0\0\0", b"GIF89a"] {
        assert!(matches!(Picture::decode(bytes), Err(ImageError::Unknown)), "{bytes:?}");
    }
    for text in
        ["x,y,", "x,y,500\n", "x,y,500\n0,0,1,2", "x,y,500,400\n0,0,1,1", "x,y,500\n0,0,1\n0,0,1", "x,y,500\n1,0,1"]
    {
        assert!(Picture::decode(text.as_bytes()).is_err(), "{text:?}");
    }
}
