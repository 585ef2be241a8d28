//! Links Embree 3, and says what to install when it is missing.

use std::path::{Path, PathBuf};

fn main() {
    println!("cargo:rerun-if-env-changed=EMBREE_LIB_DIR");
    println!("cargo:rerun-if-changed=build.rs");
    let named = std::env::var_os("EMBREE_LIB_DIR").map(PathBuf::from);
    if let Some(dir) = &named {
        println!("cargo:rustc-link-search=native={}", dir.display());
    }
    if named.is_none() && !in_standard_folders() {
        println!(
            "cargo:warning=libembree3 was not found: install Debian's libembree-dev (Embree 3.13), or set EMBREE_LIB_DIR"
        );
    }
    println!("cargo:rustc-link-lib=embree3");
    #[cfg(feature = "regen-bindings")]
    regenerate();
}

fn in_standard_folders() -> bool {
    let arch = std::env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    let multiarch = format!("/usr/lib/{arch}-linux-gnu");
    [multiarch.as_str(), "/usr/lib64", "/usr/lib", "/usr/local/lib", "/opt/homebrew/lib"].iter().any(|dir| {
        ["libembree3.so", "libembree3.dylib", "libembree3.a"].iter().any(|f| Path::new(dir).join(f).exists())
    })
}

#[cfg(feature = "regen-bindings")]
fn regenerate() {
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR")).join("bindings.rs");
    bindgen::Builder::default()
        .header_contents("embree.h", "#include <embree3/rtcore.h>")
        .allowlist_function("rtc.*")
        .allowlist_type("RTC.*")
        .allowlist_var("RTC_.*")
        .default_enum_style(bindgen::EnumVariation::NewType { is_bitfield: false, is_global: false })
        .derive_default(true)
        .generate_comments(false)
        .generate()
        .expect("bindgen reads <embree3/rtcore.h>; it needs libembree-dev and libclang-dev")
        .write_to_file(out)
        .expect("OUT_DIR is writable");
}
