//! Top-level names that nothing uses.
//!
//! A module without a scene is a library: what it defines is for others. A script with a scene is a whole.

use arsc_diagnostics::Diagnostic;
use arsc_diagnostics::codes::sema as codes;

use super::Checker;
use super::names::DefKind;

impl Checker<'_> {
    pub(super) fn lint_unused_definitions(&mut self) {
        let mut lints = Vec::new();
        for (index, scope) in self.scopes.iter().enumerate() {
            if self.is_std(index) {
                continue;
            }
            let is_script = index + 1 == self.scopes.len() && self.program.scene.is_some();
            for (name, def) in scope.defs.iter().filter(|(name, def)| !def.used && !name.starts_with('_')) {
                let (code, message, help) = match def.kind {
                    DefKind::Module(_) | DefKind::Import { .. } => {
                        (codes::UNUSED_IMPORT, format!("the import `{name}` is never used"), "remove it")
                    }
                    DefKind::Param(_) if is_script => {
                        (codes::UNUSED_PARAM, format!("the param `{name}` has no effect"), "use it, or remove it")
                    }
                    _ if is_script => {
                        (codes::UNUSED_NAME, format!("`{name}` is never used"), "remove it, or begin its name with `_`")
                    }
                    _ => continue,
                };
                lints.push(Diagnostic::new(code, message).label(def.span, "defined here").help(help));
            }
        }
        self.diagnostics.extend(lints);
    }
}
