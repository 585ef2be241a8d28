//! Whole pictures against closed forms.
//!
//! Every pixel of these pictures has the same expectation, and pixels are independent. An estimate is the mean over
//! pixels, its standard error comes from their scatter. A test asserts that the estimate lies within five standard
//! errors of the exact value (false-alarm rate 6e-7 for a change that keeps the distribution), and that the
//! standard error itself is small, so that the assertion has power. Where stratification makes the error
//! deterministic, the test states its bound. Counts are camera paths.

mod closed_form {
    mod determinism;
    mod first_hits;
    mod fluorescence;
    mod furnace;
    mod irradiance;
    mod media;
    mod noise;
    mod polarisation;
    mod sky;
    mod specular;
    mod support;
    mod textures;
    mod thermal;
}
