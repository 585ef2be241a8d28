//! Running the command from tests.
#![allow(dead_code)] // Each test binary uses its part.

use std::io::Write;
use std::process::{Command, Output, Stdio};

pub fn arsc(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_arsc")).args(arguments).stdin(Stdio::null()).output().expect("arsc starts")
}

pub fn arsc_with_input(arguments: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_arsc"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("arsc starts");
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("arsc reads its input");
    child.wait_with_output().expect("arsc ends")
}

/// A folder of its own with a script in it, and the script's path.
pub fn scene(name: &str, text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("the folder takes files");
    let path = path.to_str().expect("a path in UTF-8").to_owned();
    (folder, path)
}

pub fn stdout(run: &Output) -> String {
    String::from_utf8_lossy(&run.stdout).into_owned()
}

pub fn stderr(run: &Output) -> String {
    String::from_utf8_lossy(&run.stderr).into_owned()
}
