//! Why something cannot be done with a picture.

#[derive(Debug, thiserror::Error)]
pub enum ImagingError {
    #[error("the pictures differ in size: {}x{} and {}x{}", .0[0], .0[1], .1[0], .1[1])]
    Sizes([usize; 2], [usize; 2]),
    #[error("the pictures differ in their bands")]
    Bands,
    #[error("the pictures differ in their channels")]
    Channels,
    #[error("the picture has no spectrum")]
    NoSpectrum,
    #[error("the picture is not polarised: render with `polarised: true`")]
    NotPolarised,
    #[error("{wanted} nm lies outside of the picture's bands, {first} nm to {last} nm")]
    Wavelength { wanted: f64, first: f64, last: f64 },
    #[error("{0}")]
    Arguments(String),
    #[error(transparent)]
    Image(#[from] arsc_image::ImageError),
}
