//! Images for a screen.

/// 8 bit sRGB (IEC 61966-2-1), encoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DisplayImage {
    pub width: usize,
    pub height: usize,
    /// `[y][x][RGB]`
    pub rgb: Vec<[u8; 3]>,
    /// Free text that travels with the picture.
    pub metadata: Vec<(String, String)>,
}
