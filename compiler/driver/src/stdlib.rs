//! The standard library, embedded: `std/material.arsl` is the module `std.material`, `data/*.csv` are its tables.

/// Path below `stdlib/`, and text; ascending by path.
const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/stdlib.rs"));

/// The text of a file of the library.
pub fn file(path: &str) -> Option<&'static str> {
    FILES.binary_search_by(|(name, _)| (*name).cmp(path)).ok().map(|i| FILES[i].1)
}

/// The text of a module such as `std.material`.
pub fn module(name: &str) -> Option<&'static str> {
    file(&format!("{}.arsl", name.replace('.', "/")))
}

/// The names of all modules, such as `std.material`.
pub fn modules() -> impl Iterator<Item = String> {
    FILES.iter().filter_map(|(path, _)| Some(path.strip_suffix(".arsl")?.replace('/', ".")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_by_their_path() {
        assert!(FILES.is_sorted_by(|a, b| a.0 < b.0));
        assert!(file("data/d65.csv").is_some_and(|text| text.contains("560")));
        assert_eq!(file("data/d65"), None);
        for name in modules() {
            assert!(name.starts_with("std.") && module(&name).is_some(), "{name}");
        }
    }
}
