//! One order for the attributes of an OpenEXR header.
//!
//! The encoder keeps attributes in a hash map whose order changes from run to run. [`sort_attributes`] re-emits a
//! single-part header with the attributes sorted by name. The header keeps its length, so the offset table behind it
//! stays valid. Layout after "OpenEXR File Layout": magic number and version (8 bytes), then attributes as name, NUL,
//! type name, NUL, i32 size, value; a NUL ends the header.

/// Sorts the attributes of the single-part file in `bytes`; `None` if the header cannot be followed.
pub fn sort_attributes(bytes: &mut [u8]) -> Option<()> {
    let start = 8;
    let mut attributes: Vec<(Vec<u8>, Vec<u8>)> = Vec::new();
    let mut at = start;
    while *bytes.get(at)? != 0 {
        let name_end = terminator(bytes, at)?;
        let type_end = terminator(bytes, name_end + 1)?;
        let size_at = type_end + 1;
        let size = i32::from_le_bytes(bytes.get(size_at..size_at + 4)?.try_into().ok()?);
        let end = (size_at + 4).checked_add(usize::try_from(size).ok()?)?;
        attributes.push((bytes.get(at..name_end)?.to_vec(), bytes.get(at..end)?.to_vec()));
        at = end;
    }
    attributes.sort();
    let sorted: Vec<u8> = attributes.into_iter().flat_map(|(_, whole)| whole).collect();
    bytes[start..at].copy_from_slice(&sorted);
    Some(())
}

fn terminator(bytes: &[u8], from: usize) -> Option<usize> {
    bytes.get(from..)?.iter().position(|&b| b == 0).map(|i| from + i)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attribute(name: &str, value: &[u8]) -> Vec<u8> {
        [name.as_bytes(), b"\0string\0", &(value.len() as i32).to_le_bytes(), value].concat()
    }

    #[test]
    fn sorts_by_name_and_keeps_the_rest() {
        let file = |order: [&str; 3]| {
            let body: Vec<u8> = order.iter().flat_map(|name| attribute(name, name.repeat(3).as_bytes())).collect();
            [&b"magic+v2"[..], &body, b"\0pixels"].concat()
        };
        let mut bytes = file(["window", "a", "arsc:seed"]);
        sort_attributes(&mut bytes).unwrap();
        assert_eq!(bytes, file(["a", "arsc:seed", "window"]));
    }

    #[test]
    fn a_broken_header_is_refused() {
        let whole = [&b"magic+v2"[..], &attribute("a", b"value"), b"\0"].concat();
        for cut in 0..whole.len() {
            assert!(sort_attributes(&mut whole[..cut].to_vec()).is_none(), "cut at {cut}");
        }
        let mut negative = whole.clone();
        let size_at = 8 + "a\0string\0".len();
        negative[size_at..size_at + 4].copy_from_slice(&(-5i32).to_le_bytes());
        assert!(sort_attributes(&mut negative).is_none());
    }
}
