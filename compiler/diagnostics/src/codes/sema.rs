//! Codes of names, types, values, modules and action sequences.

codes! {
    error UNKNOWN_NAME "E0101" unknown_name: "a name is not defined";
    error TYPE_MISMATCH "E0102" type_mismatch: "an expression has another type than the one needed";
    error NOT_IMPLEMENTED "E0901" not_implemented: "the capability is specified but not implemented yet";
}
