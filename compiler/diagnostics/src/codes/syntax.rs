//! Codes of the syntax stage.

codes! {
    error SYNTAX "E0001" syntax: "the text does not follow the grammar";
    error NESTING "E0002" nesting: "brackets, blocks or operators are nested too deeply";
    error LITERAL "E0003" literal: "a number or string literal is malformed or out of range";
    error NOT_TEXT "E0004" not_text: "the file is not UTF-8 text";
    error TOO_LARGE "E0005" too_large: "the file is larger than the limit";
    error BRACKET "E0006" bracket: "a bracket is not closed, or closes nothing";
    error UNTERMINATED "E0007" unterminated: "a string or comment does not end";
    error CHARACTER "E0008" character: "a character has no meaning outside of strings and comments";
    error MISSING_COMMA "E0009" missing_comma: "a comma is missing between two arguments or elements";
    error NAMED_ARGUMENT "E0010" named_argument: "a named argument is written with `=`";
    error STATEMENT_END "E0011" statement_end: "two statements stand on one line";
    error CHAINED_COMPARISON "E0012" chained_comparison: "comparisons do not chain";
}
