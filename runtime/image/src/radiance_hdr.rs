//! Radiance pictures (`.hdr`, `.pic`): colours with a common exponent, flat or run-length coded.
//!
//! After the Radiance manual's "File formats" (G. Ward). A coded pixel (r, g, b, e) is (r, g, b) + 1/2, times 2^(e - 136); e = 0
//! is black. Only rows from the top with columns from the left (`-Y h +X w`) are read. `EXPOSURE` lines are divided out, so that the
//! values are those before them.

use arsc_spectral::srgb;

use crate::{ColourImage, ImageError, UNIT_LUMINANCE, claims};

type Reason = Box<dyn std::error::Error + Send + Sync>;

/// Rows of this many columns may have the newer run-length code.
const CODED_WIDTHS: std::ops::Range<usize> = 8..0x8000;

pub fn decode(bytes: &[u8]) -> Result<ColourImage, ImageError> {
    let (size, rgb) = read(bytes).map_err(|source| ImageError::Decode { format: "Radiance HDR", source })?;
    let rgb = rgb.iter().map(|c| c.map(f64::from));
    ColourImage::from_linear(size, rgb, srgb::xyz_from_rgb() * UNIT_LUMINANCE)
}

type Pixels = ([usize; 2], Vec<[f32; 3]>);

fn read(bytes: &[u8]) -> Result<Pixels, Reason> {
    let mut rest = bytes;
    let mut exposure = 1.0;
    if !line(&mut rest)?.starts_with(b"#?") {
        return Err("the first line does not begin with `#?`".into());
    }
    loop {
        let header = std::str::from_utf8(line(&mut rest)?)?.trim();
        if header.is_empty() {
            break;
        }
        if let Some(format) = header.strip_prefix("FORMAT=")
            && format != "32-bit_rle_rgbe"
        {
            return Err(format!("the format `{format}` is not understood").into());
        }
        if let Some(value) = header.strip_prefix("EXPOSURE=") {
            exposure *= value.trim().parse::<f32>()?;
        }
    }
    if !(exposure > 0.0 && exposure.is_finite()) {
        return Err("the exposure is not positive".into());
    }
    let size = std::str::from_utf8(line(&mut rest)?)?;
    let words: Vec<&str> = size.split_whitespace().collect();
    let ["-Y", height, "+X", width] = words[..] else { return Err("the rows are not in the usual order".into()) };
    let (width, height) = (width.parse::<usize>()?, height.parse::<usize>()?);
    claims::check("Radiance HDR", rest, (width as u64).saturating_mul(height as u64))?;
    let mut values = Vec::with_capacity(width * height);
    let mut row = vec![[0u8; 4]; width];
    for _ in 0..height {
        read_row(&mut rest, &mut row)?;
        for [r, g, b, e] in &row {
            let scale = if *e == 0 { 0.0 } else { 2f32.powi(i32::from(*e) - 136) / exposure };
            values.push([r, g, b].map(|c| (f32::from(*c) + 0.5) * scale));
        }
    }
    Ok(([width, height], values))
}

/// Up to the next newline, which is taken too.
fn line<'a>(rest: &mut &'a [u8]) -> Result<&'a [u8], Reason> {
    let end = rest.iter().position(|byte| *byte == b'\n').ok_or("the header does not end")?;
    let found = &rest[..end];
    *rest = &rest[end + 1..];
    Ok(found)
}

fn take<'a>(rest: &mut &'a [u8], count: usize) -> Result<&'a [u8], Reason> {
    let (found, behind) = rest.split_at_checked(count).ok_or("the file ends within a row")?;
    *rest = behind;
    Ok(found)
}

fn read_row(rest: &mut &[u8], row: &mut [[u8; 4]]) -> Result<(), Reason> {
    let width = row.len();
    match **rest {
        [2, 2, high, low, ..] if CODED_WIDTHS.contains(&width) && high < 128 => {
            if usize::from(high) << 8 | usize::from(low) != width {
                return Err("a row has another width than the picture".into());
            }
            take(rest, 4)?;
            (0..4).try_for_each(|component| read_runs(rest, row, component))
        }
        _ => read_old_row(rest, row),
    }
}

/// One component of a row: a byte above 128 repeats the next one, another one says how many follow.
fn read_runs(rest: &mut &[u8], row: &mut [[u8; 4]], component: usize) -> Result<(), Reason> {
    let mut at = 0;
    while at < row.len() {
        let count = take(rest, 1)?[0];
        let (length, repeated) = if count > 128 { (count - 128, true) } else { (count, false) };
        let end = at + usize::from(length);
        if length == 0 || end > row.len() {
            return Err("a run does not fit its row".into());
        }
        let data = take(rest, if repeated { 1 } else { usize::from(length) })?;
        for (i, pixel) in row[at..end].iter_mut().enumerate() {
            pixel[component] = if repeated { data[0] } else { data[i] };
        }
        at = end;
    }
    Ok(())
}

/// Flat pixels, where (1, 1, 1, n) repeats the last one; several in a row are the bytes of a longer count.
fn read_old_row(rest: &mut &[u8], row: &mut [[u8; 4]]) -> Result<(), Reason> {
    let (mut at, mut shift) = (0, 0);
    while at < row.len() {
        let pixel: [u8; 4] = take(rest, 4)?.try_into()?;
        if pixel[..3] == [1, 1, 1] && at > 0 {
            let count = usize::from(pixel[3]).checked_shl(shift).ok_or("a run does not fit its row")?;
            let end = at.checked_add(count).filter(|end| *end <= row.len()).ok_or("a run does not fit its row")?;
            let last = row[at - 1];
            row[at..end].fill(last);
            (at, shift) = (end, shift + 8);
        } else {
            row[at] = pixel;
            (at, shift) = (at + 1, 0);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(width: usize, height: usize) -> Vec<u8> {
        format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2.0\n\n-Y {height} +X {width}\n").into_bytes()
    }

    #[test]
    fn flat_and_coded_rows_agree() {
        let pixels: Vec<[u8; 4]> =
            (0..10).map(|i| if i < 6 { [128, 64, 0, 129] } else { [i * 20, 3, 9, 130] }).collect();
        let mut flat = header(10, 1);
        flat.extend(pixels.iter().flatten());
        let mut coded = header(10, 1);
        coded.extend([2, 2, 0, 10]);
        for c in 0..4 {
            coded.extend([128 + 6, pixels[0][c], 4]);
            coded.extend(pixels[6..].iter().map(|pixel| pixel[c]));
        }
        let mut old = header(10, 1);
        old.extend(pixels[0]);
        old.extend([1, 1, 1, 5]);
        old.extend(pixels[6..].iter().flatten());
        let raster = read(&flat).unwrap();
        assert_eq!(read(&coded).unwrap(), raster);
        assert_eq!(read(&old).unwrap(), raster);
        // (128.5 / 256) 2^(129 - 128), over the exposure.
        assert!((raster.1[0][0] - 128.5 / 256.0).abs() < 1e-6);
        for cut in 0..coded.len() {
            assert!(read(&coded[..cut]).is_err(), "cut at {cut}");
        }
    }

    #[test]
    fn claims_and_runs_that_do_not_fit_are_errors() {
        let mut huge = header(60_000, 60_000);
        huge.extend([0; 64]);
        assert!(read(&huge).is_err());
        let mut run = header(10, 1);
        run.extend([2, 2, 0, 10, 128 + 11, 5]);
        assert!(read(&run).is_err());
        let mut endless = header(4, 1);
        endless.extend([9, 9, 9, 130]);
        endless.extend([1, 1, 1, 0].repeat(12));
        assert!(read(&endless).is_err());
    }
}
