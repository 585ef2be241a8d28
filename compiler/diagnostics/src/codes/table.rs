//! The macro that declares a table of codes.

/// `codes! { error NAME "E0101" name: "summary"; lint NAME "W0101" name: "summary"; }`
macro_rules! codes {
    ($($kind:ident $constant:ident $id:literal $name:ident: $summary:literal;)*) => {
        $(
            #[doc = $summary]
            pub const $constant: $crate::Code = $crate::Code(&$crate::codes::CodeEntry {
                id: $id,
                name: stringify!($name),
                summary: $summary,
                severity: codes!(@severity $kind),
            });
        )*
        pub(super) const ALL: &[$crate::Code] = &[$($constant),*];
    };
    (@severity error) => { $crate::Severity::Error };
    (@severity lint) => { $crate::Severity::Warning };
}
