//! Diagnostics for people.
use arsc_driver::Compiled;
pub fn human(compiled: &Compiled) {
    for d in &compiled.diagnostics {
        eprintln!("{}: {}", d.code.id(), d.message);
        for l in &d.labels {
            let f = compiled.sources.get(l.span.source);
            let p = f.line_column(l.span.start);
            eprintln!("  {}:{}:{} {}", f.name, p.line, p.column, l.text);
        }
        if let Some(h) = &d.help {
            eprintln!("  help: {h}");
        }
    }
}
