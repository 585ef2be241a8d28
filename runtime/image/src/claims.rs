//! What a file may claim: a reader believes no size that its bytes could not hold.

use crate::ImageError;

/// Deflate, the strongest compression of the formats, shrinks at most by about this factor.
const LARGEST_COMPRESSION: u64 = 1100;

/// No picture takes more memory than this while it is read, bytes.
const MOST_MEMORY: u64 = 16 << 30;

/// Most bytes that a file of this size can become.
pub fn most_bytes(bytes: &[u8]) -> usize {
    (bytes.len() as u64).saturating_mul(LARGEST_COMPRESSION).min(MOST_MEMORY) as usize
}

/// Refuses a claim of more samples, of at least one byte each, than the file can hold, or none at all.
pub fn check(format: &'static str, bytes: &[u8], samples: u64) -> Result<(), ImageError> {
    if samples > most_bytes(bytes) as u64 { Err(refusal(format)) } else { Ok(()) }
}

pub fn refusal(format: &'static str) -> ImageError {
    let source = "it claims more pixels than the file can hold".into();
    ImageError::Decode { format, source }
}
