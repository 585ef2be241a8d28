//! How fast texts are read: `cargo run --release -p arsc-syntax --example parse_speed`.

use std::time::Instant;

use arsc_diagnostics::SourceId;

fn main() {
    let statement = "    sphere(radius: 1.5, center: (i * 2, -3, 0.25)) - cube(size: 2) |> rotate_z(45deg * i)\n";
    let scene = |n: usize| format!("scene {{\n{}}}\n", statement.repeat(n));
    let cases = [
        ("statements in one scene", scene(110_000)),
        ("one line of 10 MB", format!("let x = [{}]", "(1.5, 2, x), ".repeat(770_000))),
        ("100 000 statements", "let x = 1 + 2 * y\n".repeat(100_000)),
        ("100 000 errors", "let x = = 1 + 2\n".repeat(100_000)),
        ("10 MB of garbage", "?a]} ) ".repeat(1_450_000)),
    ];
    for (name, text) in cases {
        let start = Instant::now();
        let parsed = arsc_syntax::parse(SourceId(0), &text);
        let seconds = start.elapsed().as_secs_f64();
        let megabytes = text.len() as f64 / 1e6;
        println!(
            "{name}: {megabytes:.1} MB in {seconds:.2} s, {:.1} MB/s, {} items, {} findings",
            megabytes / seconds,
            parsed.module.items.len(),
            parsed.diagnostics.len()
        );
    }
}
