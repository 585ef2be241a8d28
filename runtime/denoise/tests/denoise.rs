//! The library is absent on most machines: then that is said. Where `ARSC_OIDN_LIBRARY` names it, it is run.

use std::path::Path;

use arsc_denoise::{DenoiseError, Denoiser, Features};

#[test]
fn what_is_not_there_is_said() {
    let missing = Denoiser::load(Some(Path::new("/no/such/library.so")));
    assert!(matches!(missing, Err(DenoiseError::Load { .. })));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    assert!(matches!(Denoiser::load(Some(&folder.join("Cargo.toml"))), Err(DenoiseError::Load { .. })));
    if let Err(error) = Denoiser::load(None) {
        assert!(error.to_string().contains("not installed"), "{error}");
    }
}

/// Noise about a mean goes, the mean stays, and an edge of the albedo stays sharp.
#[test]
fn noise_goes_and_means_stay() {
    let Some(path) = std::env::var_os("ARSC_OIDN_LIBRARY") else { return };
    let denoiser = Denoiser::load(Some(Path::new(&path))).unwrap();
    let (width, height) = (96, 64);
    let albedo: Vec<[f32; 3]> = (0..width * height).map(|i| if i % width < 48 { [0.8; 3] } else { [0.2; 3] }).collect();
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let noisy: Vec<[f32; 3]> = albedo.iter().map(|a| a.map(|a| a * 2.0 * random())).collect();
    let features = Features { albedo: Some(&albedo), normal: None };
    let clean = denoiser.denoise([width, height], &noisy, features).unwrap();
    assert_eq!(clean, denoiser.denoise([width, height], &noisy, features).unwrap(), "the same again");
    let error = |pixels: &[[f32; 3]]| {
        let off = |(p, a): (&[f32; 3], &[f32; 3])| (0..3).map(|c| (p[c] - a[c]).powi(2)).sum::<f32>();
        (pixels.iter().zip(&albedo).map(off).sum::<f32>() / pixels.len() as f32).sqrt()
    };
    assert!(error(&clean) < 0.2 * error(&noisy), "{} of {}", error(&clean), error(&noisy));
    let size = [width, height + 1];
    assert!(matches!(denoiser.denoise(size, &noisy, features), Err(DenoiseError::Size { .. })));
}
