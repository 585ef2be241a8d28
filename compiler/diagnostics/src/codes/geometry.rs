//! Codes about the scene as a whole, and of the lints over the IR: geometry, materials and lights.

codes! {
    error TOO_MANY_PRIMITIVES "E0401" too_many_primitives: "the solids of the scene have too many primitives when written out";
    lint EMPTY_CSG "W0201" empty_csg: "a Boolean expression contains no point";
    lint USELESS_SUBTRACTION "W0202" useless_subtraction: "a subtraction removes nothing";
    lint ABSORBED_OPERAND "W0203" absorbed_operand: "an operand of a union lies inside of another";
    lint COINCIDENT_FACES "W0204" coincident_faces: "faces of two solids or surfaces lie in one place";
    lint UNBOUNDED_SOLID "W0205" unbounded_solid: "an unbounded solid is left in the scene";
    lint DUPLICATE_GEOMETRY "W0206" duplicate_geometry: "the same geometry is there twice";
    lint NEARLY_FLAT "W0207" nearly_flat: "a transform flattens a shape almost to nothing";
    lint CAMERA_INSIDE "W0208" camera_inside: "the camera is inside of an opaque solid";
    lint NO_LIGHT "W0209" no_light: "a scene that is rendered has no light";
    lint HIDDEN_LIGHT "W0210" hidden_light: "a light is inside of an opaque solid";
    lint OVERLAPPING_DIELECTRICS "W0211" overlapping_dielectrics: "two transmissive solids overlap";
}
