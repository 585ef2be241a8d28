//! The one door to files: what a script may read, and where pictures may be written.
//!
//! Reading: below the script's folder and the folders granted with `--allow-read`, links resolved first. Writing: below
//! the output folder alone; names in scripts are relative and may not climb out of it, not even through a link.

use std::io::{BufReader, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use arsc_driver::{LoadError, Loader};
use arsc_geometry::TriangleMesh;
use arsc_mesh::MeshError;

/// Largest script, table or data file, bytes. The compiler has its own, smaller limit of texts.
const LARGEST_FILE: u64 = 256 << 20;

/// Names of a folder that are looked at for one to suggest.
const LONGEST_LIST: usize = 1_000;

/// The folders that a script may read.
pub struct ScriptFolder {
    root: PathBuf,
    granted: Vec<PathBuf>,
}

impl ScriptFolder {
    /// Grants the folder of `scene` (the current one for `-`) and `also`.
    pub fn of(scene: &Path, also: &[PathBuf]) -> std::io::Result<ScriptFolder> {
        let folder = match scene.parent() {
            Some(parent) if !parent.as_os_str().is_empty() && scene != Path::new("-") => parent,
            _ => Path::new("."),
        };
        let root = folder.canonicalize()?;
        let mut granted = vec![root.clone()];
        for folder in also {
            granted.push(folder.canonicalize()?);
        }
        Ok(ScriptFolder { root, granted })
    }

    /// The real place of a path written in a script.
    pub fn resolve(&self, path: &str) -> Result<PathBuf, LoadError> {
        let real = self.root.join(path).canonicalize().map_err(load_error)?;
        if self.granted.iter().any(|folder| real.starts_with(folder)) { Ok(real) } else { Err(LoadError::Forbidden) }
    }
}

impl Loader for ScriptFolder {
    fn load(&self, path: &str) -> Result<Arc<str>, LoadError> {
        read_text(std::fs::File::open(self.resolve(path)?).map_err(load_error)?)
    }

    fn mesh(&self, path: &str) -> Result<Arc<TriangleMesh>, LoadError> {
        let real = self.resolve(path)?;
        if !real.is_file() {
            return Err(LoadError::Other("not a file".into()));
        }
        let file = std::fs::File::open(real).map_err(load_error)?;
        let bytes = file.metadata().map_err(load_error)?.len();
        let mesh = arsc_mesh::read(path, &mut BufReader::new(file), bytes).map_err(|error| match error {
            MeshError::Read(error) => load_error(error),
            error => LoadError::Malformed(error.to_string()),
        })?;
        Ok(Arc::new(mesh))
    }

    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        let real = self.resolve(path)?;
        if !real.is_file() {
            return Err(LoadError::Other("not a file".into()));
        }
        read_bytes(std::fs::File::open(real).map_err(load_error)?).map(Arc::from)
    }

    fn list(&self, folder: &str) -> Vec<String> {
        let folder = if folder.is_empty() { "." } else { folder };
        let entries = self.resolve(folder).ok().and_then(|real| std::fs::read_dir(real).ok());
        let names = entries.into_iter().flatten().flatten().take(LONGEST_LIST);
        let mut names: Vec<String> = names.filter_map(|entry| entry.file_name().into_string().ok()).collect();
        names.sort();
        names
    }
}

/// Largest picture, bytes.
const LARGEST_PICTURE: u64 = 8 << 30;

/// The bytes of a picture named on the command line.
pub fn read_picture(path: &Path) -> std::io::Result<Vec<u8>> {
    let refuse = |what: &str| Err(std::io::Error::other(what));
    if path.is_dir() {
        return refuse("is a folder");
    }
    let mut bytes = Vec::new();
    let read = std::fs::File::open(path)?.take(LARGEST_PICTURE + 1).read_to_end(&mut bytes)?;
    if read as u64 > LARGEST_PICTURE { refuse("is larger than a picture may be") } else { Ok(bytes) }
}

/// The text of the script itself, `-` for standard input.
pub fn read_script(scene: &Path) -> Result<Arc<str>, LoadError> {
    if scene == Path::new("-") {
        return read_text(std::io::stdin().lock());
    }
    if scene.is_dir() {
        return Err(LoadError::Other("is a folder".into()));
    }
    read_text(std::fs::File::open(scene).map_err(load_error)?)
}

fn read_bytes(from: impl Read) -> Result<Vec<u8>, LoadError> {
    let mut bytes = Vec::new();
    let read = from.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(load_error)?;
    if read as u64 > LARGEST_FILE {
        return Err(LoadError::TooLarge { bytes: read as u64 });
    }
    Ok(bytes)
}

fn read_text(from: impl Read) -> Result<Arc<str>, LoadError> {
    match String::from_utf8(read_bytes(from)?) {
        Ok(text) => Ok(text.into()),
        Err(error) => Err(LoadError::NotText(error.utf8_error().valid_up_to())),
    }
}

fn load_error(error: std::io::Error) -> LoadError {
    match error.kind() {
        std::io::ErrorKind::NotFound => LoadError::NotFound,
        _ => LoadError::Other(error.to_string()),
    }
}

/// Where pictures go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// Names in the script are relative to this folder.
    Folder(PathBuf),
    /// This very file, whatever its name in the script; its extension says which kind of file.
    File(PathBuf),
}

impl Output {
    /// A path that ends like a picture and is no folder is a file.
    pub fn new(path: &Path) -> Output {
        let is_picture = extension(path).is_some_and(|e| ["exr", "png", "tif", "tiff", "csv"].contains(&&*e));
        if is_picture && !path.is_dir() { Output::File(path.to_owned()) } else { Output::Folder(path.to_owned()) }
    }

    /// Where to write what the script calls `name`, making folders as needed; `None` if it is not wanted.
    pub fn place(&self, name: &str) -> Result<Option<PathBuf>, OutputError> {
        match self {
            Output::Folder(folder) => below(folder, name).map(Some),
            Output::File(file) if extension(file) == extension(Path::new(name)) => {
                if let Some(folder) = file.parent() {
                    make_folder(folder)?;
                }
                Ok(Some(file.clone()))
            }
            Output::File(_) => Ok(None),
        }
    }
}

fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// Why a picture has no place.
#[derive(Debug)]
pub enum OutputError {
    /// The name would leave the output folder.
    Outside(String),
    Folder(PathBuf, std::io::Error),
}

impl std::fmt::Display for OutputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            OutputError::Outside(name) => write!(f, "`{name}` lies outside of the output folder"),
            OutputError::Folder(folder, _) => write!(f, "cannot use the output folder {}", folder.display()),
        }
    }
}

impl std::error::Error for OutputError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            OutputError::Outside(_) => None,
            OutputError::Folder(_, source) => Some(source),
        }
    }
}

fn make_folder(folder: &Path) -> Result<PathBuf, OutputError> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    std::fs::create_dir_all(folder)
        .and_then(|()| folder.canonicalize())
        .map_err(|error| OutputError::Folder(folder.to_owned(), error))
}

/// `name` below `folder`. Folders on the way are made one at a time, so that none is made behind a link that leads out.
fn below(folder: &Path, name: &str) -> Result<PathBuf, OutputError> {
    let outside = || OutputError::Outside(name.to_owned());
    let parts: Vec<_> = Path::new(name).components().filter(|part| *part != Component::CurDir).collect();
    if parts.is_empty() || !parts.iter().all(|part| matches!(part, Component::Normal(_))) {
        return Err(outside());
    }
    let root = make_folder(folder)?;
    let mut place = root.clone();
    for part in &parts[..parts.len() - 1] {
        place = make_folder(&place.join(part))?;
        if !place.starts_with(&root) {
            return Err(outside());
        }
    }
    Ok(place.join(parts[parts.len() - 1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_below_the_output_folder() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let output = Output::new(&out);
        let place = output.place("sub/./a.png").unwrap().unwrap();
        assert_eq!(place, out.canonicalize().unwrap().join("sub/a.png"));
        for name in ["../a.png", "/tmp/a.png", "sub/../../a.png", "", ".", "a/../b.png"] {
            assert!(matches!(output.place(name), Err(OutputError::Outside(_))), "{name}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_do_not_lead_out() {
        let folder = tempfile::tempdir().unwrap();
        let (out, elsewhere) = (folder.path().join("out"), folder.path().join("elsewhere"));
        std::fs::create_dir(&out).unwrap();
        std::fs::create_dir(&elsewhere).unwrap();
        std::fs::write(elsewhere.join("secret.txt"), "secret").unwrap();
        std::os::unix::fs::symlink(&elsewhere, out.join("link")).unwrap();
        assert!(matches!(Output::new(&out).place("link/deep/a.png"), Err(OutputError::Outside(_))));
        let script = ScriptFolder::of(&out.join("scene.arsl"), &[]).unwrap();
        assert_eq!(script.load("link/secret.txt"), Err(LoadError::Forbidden));
        assert_eq!(script.load("../elsewhere/secret.txt"), Err(LoadError::Forbidden));
        let granted = ScriptFolder::of(&out.join("scene.arsl"), &[elsewhere]).unwrap();
        assert_eq!(&*granted.load("../elsewhere/secret.txt").unwrap(), "secret");
    }

    #[test]
    fn a_named_picture_takes_only_its_kind() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("new/picture.PNG");
        let output = Output::new(&file);
        assert_eq!(output.place("whatever.png").unwrap(), Some(file.clone()));
        assert_eq!(output.place("whatever.exr").unwrap(), None);
        assert!(file.parent().unwrap().is_dir());
    }

    #[test]
    fn text_that_is_not_text_names_the_offset() {
        assert_eq!(read_text(&b"ab\xff"[..]), Err(LoadError::NotText(2)));
    }
}
