//! Files that are written whole or not at all.

use std::io::Write;
use std::path::Path;

use crate::ImageError;

/// Writes `bytes` to `path`: into a temporary file in the same folder, flushed to the disk, then renamed over the
/// target. On any failure an existing file stays as it was and the temporary is removed. A link at `path` is replaced,
/// not followed.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    let failed = |source| ImageError::Write { path: path.to_path_buf(), source };
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if path.is_dir() {
        return Err(failed(std::io::Error::new(std::io::ErrorKind::IsADirectory, "is a folder")));
    }
    let mut temporary =
        tempfile::Builder::new().prefix(".arsc-").suffix(".part").tempfile_in(folder).map_err(failed)?;
    temporary.write_all(bytes).map_err(failed)?;
    temporary.as_file().sync_all().map_err(failed)?;
    make_readable(temporary.as_file()).map_err(failed)?;
    temporary.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Whether [`write_whole`] would find a folder that takes files. Leaves nothing behind.
pub fn check_writable(path: &Path) -> Result<(), ImageError> {
    temporary_beside(path).map(drop).map_err(|source| ImageError::Write { path: path.to_path_buf(), source })
}

fn temporary_beside(path: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if path.is_dir() {
        return Err(std::io::Error::new(std::io::ErrorKind::IsADirectory, "is a folder"));
    }
    tempfile::Builder::new().prefix(".arsc-").suffix(".part").tempfile_in(folder)
}

/// Temporary files are private to their owner; a picture is an ordinary file.
#[cfg(unix)]
fn make_readable(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_file: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_a_file_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        write_whole(&path, b"old").unwrap();
        write_whole(&path, b"new and longer").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new and longer");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn failure_keeps_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("taken");
        std::fs::create_dir(&target).unwrap();
        std::fs::write(target.join("inside"), b"kept").unwrap();
        assert!(matches!(write_whole(&target, b"bytes"), Err(ImageError::Write { .. })));
        assert!(check_writable(&target).is_err() && check_writable(&folder.path().join("missing/a.png")).is_err());
        assert!(check_writable(&folder.path().join("new.png")).is_ok());
        assert_eq!(std::fs::read(target.join("inside")).unwrap(), b"kept");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary is left");
        assert!(write_whole(&folder.path().join("missing/picture.png"), b"bytes").is_err());
    }
}
