//! Paths written in scripts: relative to the folder of the script that names them, with `/` between parts.

/// `path` as seen from the file `from`, relative to the root script's folder, with `.` and `..` worked off as far as
/// they can be. What leads out of the root folder keeps its leading `..`; whether that is allowed is the loader's
/// business.
pub fn join(from: &str, path: &str) -> String {
    if path.starts_with('/') {
        return path.to_string();
    }
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(path.split('/')) {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    let joined = parts.join("/");
    if folder.starts_with('/') { format!("/{joined}") } else { joined }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_relative_to_the_file_that_names_them() {
        for (from, path, joined) in [
            ("scene.arsl", "a.arsl", "a.arsl"),
            ("parts/wheel.arsl", "./hub.arsl", "parts/hub.arsl"),
            ("parts/wheel.arsl", "../scene.arsl", "scene.arsl"),
            ("parts/wheel.arsl", "../../x/a.arsl", "../x/a.arsl"),
            ("../x/a.arsl", "../b.arsl", "../b.arsl"),
            ("a.arsl", "/etc/passwd", "/etc/passwd"),
            ("/lib/a.arsl", "b.arsl", "/lib/b.arsl"),
        ] {
            assert_eq!(join(from, path), joined, "{path} from {from}");
        }
    }
}
