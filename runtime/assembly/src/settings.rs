//! What a run is asked for besides what the script says.

use std::path::PathBuf;

use arsc_accel::{Budget, Strategy};
use arsc_render::{Bands, Film};

use crate::AssemblyError;

/// More pixels than this are refused: a film takes some 600 bytes for each.
const MOST_PIXELS: u64 = 1 << 26;

/// Values that override the script's where they are given.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    pub samples: Option<u32>,
    /// Relative noise that is enough, and seconds after which a render ends: with one of them, and without `samples`, a
    /// render takes as many samples as it needs.
    pub noise: Option<f64>,
    pub time_limit: Option<f64>,
    pub max_depth: Option<u32>,
    pub seed: Option<u64>,
    pub resolution: Option<[u32; 2]>,
    /// Pixels x0, y0, x1, y1 (end exclusive) in place of the camera's crop; the rest stays black.
    pub crop: Option<[u32; 4]>,
    pub strategy: Option<Strategy>,
    /// For the cells of all solids.
    pub budget: Budget,
    /// Threads; `None` for as many as the machine has.
    pub threads: Option<usize>,
    /// Names the pictures of scripts without actions.
    pub scene_name: String,
    /// The library of Open Image Denoise; `None` for the one that the system finds.
    pub denoiser: Option<PathBuf>,
    /// Goes into every picture, before what the render adds itself.
    pub metadata: Vec<(String, String)>,
    /// Write timings into pictures; without, equal runs give equal files.
    pub timings: bool,
    /// Count the tests of camera rays after each render.
    pub statistics: bool,
}

impl Settings {
    /// Refuses a film that would take more memory than the largest picture of the default bands.
    pub fn check_film(
        &self,
        resolution: [u32; 2],
        crop: Option<[u32; 4]>,
        bands: &Bands,
        polarised: bool,
    ) -> Result<(), AssemblyError> {
        let most = MOST_PIXELS.saturating_mul(Film::bytes([1, 1], None, &Bands::default(), true));
        let bytes = Film::bytes(resolution, crop, bands, polarised);
        if bytes > most {
            let refusal = format!("a picture with {} bands would take {} GB", bands.count, bytes >> 30);
            return Err(AssemblyError::Settings(refusal));
        }
        Ok(())
    }

    /// Pixels to render at this resolution.
    pub fn pixels(&self, [width, height]: [u32; 2], crop: Option<[u32; 4]>) -> Result<u64, AssemblyError> {
        let all = u64::from(width) * u64::from(height);
        if all > MOST_PIXELS {
            let refusal = format!("{width}x{height} pixels are more than the supported {MOST_PIXELS}");
            return Err(AssemblyError::Settings(refusal));
        }
        match crop {
            None => Ok(all),
            Some([x0, y0, x1, y1]) if x0 < x1 && y0 < y1 && x1 <= width && y1 <= height => {
                Ok(u64::from(x1 - x0) * u64::from(y1 - y0))
            }
            Some([x0, y0, x1, y1]) => {
                let refusal =
                    format!("the crop {x0},{y0},{x1},{y1} does not lie in the image of {width}x{height} pixels");
                Err(AssemblyError::Settings(refusal))
            }
        }
    }
}
