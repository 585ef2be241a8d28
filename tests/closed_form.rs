//! Whole pictures against closed forms.
//!
//! Each test renders a scene whose radiance is known exactly and states its sample count, the standard error that this
//! count gives, and the chance of a false alarm. Renders are deterministic: a test that passes keeps passing until the
//! program changes, and the false-alarm rate is that of a change which keeps the distribution.

mod closed_form {
    mod furnace;
    mod support;
}
