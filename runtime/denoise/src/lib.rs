//! Intel Open Image Denoise, version 2, loaded at run time: nothing of arsc needs it to build or to start.
//!
//! The second door to `unsafe` code beside `arsc-embree`, and a small one: the functions of the library are called from
//! [`Denoiser`] alone. Its interface is safe: buffers are slices whose lengths are checked against the picture's size, and
//! no pointer outlives the call. The filter is "RT" for light without an upper limit, on the processor; the same input gives the
//! same output on the same machine.

mod library;

use std::path::{Path, PathBuf};

use library::{Device, Library};

/// Names under which the system's loader may find it.
pub const NAMES: [&str; 4] =
    ["libOpenImageDenoise.so.2", "libOpenImageDenoise.so", "libOpenImageDenoise.dylib", "OpenImageDenoise.dll"];

#[derive(Debug, thiserror::Error)]
pub enum DenoiseError {
    #[error(
        "Intel Open Image Denoise is not installed: none of {} is found by the system's loader",
        NAMES.join(", ")
    )]
    Missing,
    #[error("cannot load {}", path.display())]
    Load { path: PathBuf, source: Box<dyn std::error::Error + Send + Sync> },
    #[error("Open Image Denoise: {0}")]
    Library(String),
    #[error("{what} holds {found} pixels where {expected} are due")]
    Size { what: &'static str, found: usize, expected: usize },
}

/// What guides the filter besides the light: of the first surface that a pixel sees.
#[derive(Clone, Copy, Debug, Default)]
pub struct Features<'a> {
    /// Reflectance in [0, 1], `[y][x][RGB]`.
    pub albedo: Option<&'a [[f32; 3]]>,
    /// In [-1, 1], `[y][x][XYZ]`; without albedo it is not used.
    pub normal: Option<&'a [[f32; 3]]>,
}

/// A loaded library with its device.
pub struct Denoiser {
    // Before the library, whose code it runs when it is dropped.
    device: Device,
    library: Library,
}

impl Denoiser {
    /// Loads the library at `path`, or the one that the system's loader finds. Loading runs the library's own code: name no
    /// file that you would not run.
    pub fn load(path: Option<&Path>) -> Result<Denoiser, DenoiseError> {
        let library = Library::load(path)?;
        let device = library.device()?;
        Ok(Denoiser { device, library })
    }

    /// Three channels without noise; values are at least 0 and without an upper limit.
    pub fn denoise(
        &self,
        size: [usize; 2],
        light: &[[f32; 3]],
        features: Features<'_>,
    ) -> Result<Vec<[f32; 3]>, DenoiseError> {
        let expected = size[0].saturating_mul(size[1]);
        let check = |what: &'static str, pixels: &[[f32; 3]]| match pixels.len() {
            found if found == expected && found > 0 => Ok(()),
            found => Err(DenoiseError::Size { what, found, expected }),
        };
        check("the picture", light)?;
        features.albedo.map_or(Ok(()), |albedo| check("the albedo", albedo))?;
        features.normal.map_or(Ok(()), |normal| check("the normal", normal))?;
        self.library.run(&self.device, size, light, features)
    }
}
