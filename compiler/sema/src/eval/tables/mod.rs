//! Files of samples.
//!
//! A file whose name ends in `.yml` or `.yaml` is an entry of refractiveindex.info ([`refractive_index`]), any other one is
//! a table in text form ([`rows`]).

mod refractive_index;
mod rows;

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::Spectrum;

use super::{Eval, Machine};
use crate::code::Site;
use crate::registry::asset_failure;

/// What a file holds, by the names of its columns; at least one.
pub struct Table {
    pub columns: Vec<(String, Spectrum)>,
}

impl Machine<'_> {
    /// The table in a file next to the calling module; read once.
    pub fn table(&mut self, path: &str, site: &Site) -> Eval<Arc<Table>> {
        let key = (site.span.source, path.to_owned());
        if let Some(table) = self.tables.get(&key) {
            return Ok(table.clone());
        }
        let text = self.assets.text(site.span.source, path).map_err(|error| asset_failure(site, path, &error))?;
        self.spend_elements(text.len() / 8, site.span)?;
        let yaml = path.ends_with(".yml") || path.ends_with(".yaml");
        let columns = if yaml { refractive_index::parse(&text) } else { rows::parse(&text) };
        let columns = columns.map_err(|message| site.fail_arg(0, codes::TABLE, message, "in this file"))?;
        let table = Arc::new(Table { columns });
        self.tables.insert(key, table.clone());
        Ok(table)
    }
}
