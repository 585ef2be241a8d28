//! Data files for sema: embedded tables for modules of `std`, files through the loader for the others.

use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

use arsc_diagnostics::SourceId;
use arsc_sema::{AssetError, Assets, DataFile, MeshFile};

use crate::{LoadError, Loader, paths, stdlib};

/// Where a source comes from.
#[derive(Clone, Debug)]
pub(crate) enum Origin {
    /// A module of `std`.
    Std,
    /// A file, relative to the root script's folder.
    File(String),
}

pub(crate) struct LoaderAssets<'a> {
    pub loader: &'a dyn Loader,
    /// By source.
    pub origins: &'a [Origin],
    /// Bytes of one text.
    pub limit: usize,
    /// Meshes that were asked for, by path.
    pub meshes: RefCell<HashMap<String, Result<MeshFile, AssetError>>>,
}

impl LoaderAssets<'_> {
    /// The path relative to the root script's folder, or the embedded text.
    fn place(&self, from: SourceId, path: &str) -> Result<String, Option<&'static str>> {
        match self.origins.get(from.0 as usize) {
            Some(Origin::Std) => Err(stdlib::file(path)),
            Some(Origin::File(file)) => Ok(paths::join(file, path)),
            None => Ok(paths::join("", path)),
        }
    }
}

impl Assets for LoaderAssets<'_> {
    fn text(&self, from: SourceId, path: &str) -> Result<Arc<str>, AssetError> {
        match self.place(from, path) {
            Err(text) => text.map(Arc::from).ok_or(AssetError::NotFound),
            Ok(path) => {
                let text = self.loader.load(&path).map_err(asset_error)?;
                if text.len() > self.limit { Err(AssetError::TooLarge) } else { Ok(text) }
            }
        }
    }

    fn mesh(&self, from: SourceId, path: &str) -> Result<MeshFile, AssetError> {
        let path = self.place(from, path).map_err(|_| AssetError::NotFound)?;
        let mut known = self.meshes.borrow_mut();
        let outcome = known.entry(path.clone()).or_insert_with(|| {
            let mesh = self.loader.mesh(&path).map_err(asset_error)?;
            Ok(MeshFile { path: path.as_str().into(), mesh })
        });
        outcome.clone()
    }

    fn bytes(&self, from: SourceId, path: &str) -> Result<DataFile, AssetError> {
        let path = self.place(from, path).map_err(|_| AssetError::NotFound)?;
        let bytes = self.loader.bytes(&path).map_err(asset_error)?;
        Ok(DataFile { path: path.into(), bytes })
    }
}

fn asset_error(error: LoadError) -> AssetError {
    match error {
        LoadError::NotFound => AssetError::NotFound,
        LoadError::NotText(_) => AssetError::NotText,
        LoadError::TooLarge { .. } => AssetError::TooLarge,
        LoadError::Forbidden => AssetError::Forbidden,
        LoadError::Malformed(reason) => AssetError::Malformed(reason),
        LoadError::Other(reason) => AssetError::Other(reason),
    }
}
