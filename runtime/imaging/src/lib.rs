//! What is done with pictures after they were rendered. Pure: pictures in, pictures and numbers out.
//!
//! [`tone_map`] leads to a display; [`difference`] compares; [`polarisation`] shows Stokes parameters in false colours;
//! [`polariser`] puts a filter before a picture; [`slice`](mod@slice) picks a wavelength; [`combine`] adds and merges; [`mod@denoise`] filters; [`reshape`] crops
//! and shrinks; [`probe`] tells what a pixel holds; [`draw`] has scale bars, text and false colours. Files are `arsc-image`'s
//! matter, colour science that of `arsc-spectral`.
//!
//! Conventions are those of `arsc-image`: rows from the top, XYZ with Y in cd m^-2, relative to
//! [`arsc_image::UNIT_LUMINANCE`] where a colour is shown.

pub mod combine;
pub mod denoise;
pub mod difference;
pub mod draw;
mod error;
pub mod polarisation;
pub mod polariser;
pub mod probe;
pub mod reshape;
pub mod slice;
mod summary;
mod tone_map;

pub use error::ImagingError;
pub use summary::{Summary, summary};
pub use tone_map::{is_display, luminances, tone_map, tone_map_colours};
