//! Data files that a script names and that are neither meshes nor tables of spectra: pictures, lamps, measured reflection.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_image::Picture;
use arsc_spectral::{MerlBrdf, PhotometricWeb, Raster};

use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::registry::{asset_failure, shortened};

impl Machine<'_> {
    /// A picture, with its path from the root script's folder; decoded once. The path is the call's first argument.
    pub fn picture(&mut self, path: &str, site: &Site) -> Eval<(Arc<str>, Arc<Raster>)> {
        let key = (site.span.source, path.to_owned());
        if let Some(known) = self.pictures.get(&key) {
            return Ok(known.clone());
        }
        let file = self.assets.bytes(site.span.source, path).map_err(|error| asset_failure(site, path, &error))?;
        let image = Picture::decode(&file.bytes).and_then(|picture| picture.to_raster()).map_err(|error| {
            let reason = std::error::Error::source(&error).map_or_else(|| error.to_string(), ToString::to_string);
            malformed(site, "image", path, reason)
        })?;
        let picture = (file.path, Arc::new(image));
        self.pictures.insert(key, picture.clone());
        Ok(picture)
    }

    /// A table of reflection, with its path from the root script's folder; read once. The path is the call's first argument.
    pub fn measured_brdf(&mut self, path: &str, site: &Site) -> Eval<(Arc<str>, Arc<MerlBrdf>)> {
        let key = (site.span.source, path.to_owned());
        if let Some(known) = self.brdfs.get(&key) {
            return Ok(known.clone());
        }
        let file = self.assets.bytes(site.span.source, path).map_err(|error| asset_failure(site, path, &error))?;
        let brdf = MerlBrdf::parse(&file.bytes)
            .map_err(|error| malformed(site, "measured reflection", path, error.to_string()))?;
        let table = (file.path, Arc::new(brdf));
        self.brdfs.insert(key, table.clone());
        Ok(table)
    }

    /// A lamp's intensities times a factor. The path is the call's first argument.
    pub fn photometric_web(&mut self, path: &str, scale: f64, site: &Site) -> Eval<Arc<PhotometricWeb>> {
        let text = self.assets.text(site.span.source, path).map_err(|error| asset_failure(site, path, &error))?;
        self.spend_elements(text.len() / 8, site.span)?;
        let web = PhotometricWeb::parse_ies(&text).and_then(|web| web.scaled(scale));
        web.map(Arc::new).map_err(|error| malformed(site, "IES file", path, error.to_string()))
    }
}

fn malformed(site: &Site, what: &str, path: &str, reason: String) -> Box<arsc_diagnostics::Diagnostic> {
    let message = format!("the {what} `{}` cannot be used", shortened(path));
    site.fail_arg(0, codes::MALFORMED_FILE, message, reason)
}
