//! Codes of the lints over the IR: geometry, materials and lights.

codes! {
    lint EMPTY_CSG "W0201" empty_csg: "a Boolean expression contains no point";
}
