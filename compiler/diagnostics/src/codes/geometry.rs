//! Codes of the lints over the IR: geometry, materials and lights.

codes! {
    error TOO_MANY_PRIMITIVES "E0401" too_many_primitives: "the solids of the scene have too many primitives when written out";
    lint EMPTY_CSG "W0201" empty_csg: "a Boolean expression contains no point";
}
