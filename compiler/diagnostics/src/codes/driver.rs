//! Codes of the driver: modules and lint levels.

codes! {
    error MODULE_NOT_FOUND "E0501" module_not_found: "an imported module does not exist";
    error MODULE_UNREADABLE "E0502" module_unreadable: "an imported module cannot be read";
    error IMPORT_CYCLE "E0503" import_cycle: "modules import each other in a cycle";
    error IMPORT_DEPTH "E0504" import_depth: "imports are nested too deeply";
    lint UNKNOWN_LINT "W0001" unknown_lint: "a lint is named that does not exist";
}
