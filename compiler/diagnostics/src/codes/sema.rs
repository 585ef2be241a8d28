//! Codes of names, types, values and action sequences.

codes! {
    error UNKNOWN_NAME "E0101" unknown_name: "a name is not defined";
    error TYPE_MISMATCH "E0102" type_mismatch: "an expression has another type than the one needed";
    error DUPLICATE_NAME "E0103" duplicate_name: "a name is defined twice";
    error WRONG_ARGUMENTS "E0104" wrong_arguments: "the arguments do not fit the parameters";
    error NOT_CALLABLE "E0105" not_callable: "what is called is not a function";
    error UNKNOWN_FIELD "E0106" unknown_field: "a value has no such field";
    error OPERANDS "E0107" operands: "an operator does not take operands of these types";
    error NOT_EXHAUSTIVE "E0108" not_exhaustive: "a `match` does not cover every value";
    error NEEDS_TYPE "E0109" needs_type: "a type cannot be inferred and must be written";
    error NOT_A_SOLID "E0110" not_a_solid: "open geometry is an operand of a Boolean operation";
    error UNKNOWN_TYPE "E0111" unknown_type: "a type is not defined";
    error CYCLIC_DEFINITION "E0112" cyclic_definition: "a definition depends on itself";
    error DUPLICATE_BLOCK "E0113" duplicate_block: "a script has two scenes, cameras or action sequences";
    error NOT_A_VALUE "E0114" not_a_value: "a module or type is used as a value";
    error PATTERN "E0115" pattern: "a pattern does not suit its place";
    error OUT_OF_RANGE "E0201" out_of_range: "a value is outside of what is allowed";
    error ARITHMETIC "E0202" arithmetic: "a calculation has no finite result";
    error INDEX "E0203" index: "an index is outside of its list";
    error LIMIT "E0204" limit: "a script exceeds a limit on time or memory";
    error RECURSION "E0205" recursion: "functions call each other too deeply";
    error DEGENERATE_TRANSFORM "E0206" degenerate_transform: "a transform flattens space";
    error EMPTY_LIST "E0207" empty_list: "a list is empty where it must not be";
    error PARAM_VALUE "E0208" param_value: "a parameter gets a value that it does not allow";
    error UNKNOWN_PARAM "E0209" unknown_param: "the script has no parameter of this name";
    error ASSET "E0210" asset: "a data file cannot be read";
    error TABLE "E0211" table: "a table of samples is malformed";
    error CONFLICTING_ATTRIBUTES "E0212" conflicting_attributes: "two attributes of one kind are attached at once";
    error STACK "E0301" stack: "an action does not find what it needs on the stack";
    error NOT_IMPLEMENTED "E0901" not_implemented: "the capability is specified but not implemented yet";
    lint UNUSED_NAME "W0101" unused_name: "a name is defined but never used";
    lint UNUSED_PARAM "W0102" unused_param: "a parameter has no effect";
    lint UNUSED_IMPORT "W0103" unused_import: "an import is never used";
    lint UNREACHABLE_ARM "W0104" unreachable_arm: "a `match` arm can never be chosen";
    lint UNUSED_VALUE "W0105" unused_value: "a value is computed and dropped";
    lint REFLECTANCE_ABOVE_ONE "W0106" reflectance_above_one: "a surface reflects more light than it receives";
    lint SUSPICIOUS_UNIT "W0107" suspicious_unit: "a quantity looks as if it was written in another unit";
    lint SHADOWED_NAME "W0108" shadowed_name: "a name hides another one of the same function or module";
    lint INVISIBLE_SPECTRUM "W0109" invisible_spectrum: "a spectrum lies outside of the rendered range";
    lint ZERO_POWER_LIGHT "W0110" zero_power_light: "a light emits nothing";
    lint NO_OUTPUT "W0111" no_output: "an action sequence writes no file";
    lint EMPTY_SCENE "W0112" empty_scene: "a scene contains nothing";
    lint EMPTY_SCRIPT "W0113" empty_script: "a script declares nothing";
}
