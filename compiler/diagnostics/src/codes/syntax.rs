//! Codes of the syntax stage.

codes! {
    error SYNTAX "E0001" syntax: "the text does not follow the grammar";
    error NESTING "E0002" nesting: "brackets or blocks are nested too deeply";
    error LITERAL "E0003" literal: "a number or string literal is malformed or out of range";
    error NOT_TEXT "E0004" not_text: "the file is not UTF-8 text";
    error TOO_LARGE "E0005" too_large: "the file is larger than the limit";
}
