//! The record of `arsc bench thesis` as tables in the thesis' form, and as comma-separated values.
//!
//! A gain is what the thesis calls speedup: the share of native's tracing time that is saved, (native − other) / native.

use super::aligned;
use super::thesis::{Record, Row, Run};
use super::thesis_scenes::Stated;

const TITLES: [&str; 5] = [
    "Table 4.1: scenes of CSG",
    "Table 4.2: CSG of meshes",
    "Table 4.3: scenes of various geometry",
    "Table 4.4: the Cornell box with its quadrangles as primitives of our own",
    "Table 4.5: triangle meshes",
];

/// The default strategy, which the thesis does not have.
const DEFAULT: &str = "local";

pub fn text(record: &Record) -> String {
    let [width, height] = record.size;
    let mut text = format!(
        "{width}x{height} pixels, {} samples, depth {}; seconds of processor time: preparing + tracing.\n\
         A gain is the share of native's tracing time that is saved; in parentheses the thesis' own.\n",
        record.samples, record.max_depth
    );
    for (table, title) in (1..).zip(TITLES) {
        let rows: Vec<&Row> = record.rows.iter().filter(|row| row.table == table).collect();
        if !rows.is_empty() {
            text += &format!("\n{title}\n{}", aligned(&table_of(table, &rows)));
        }
    }
    let rated: Vec<&Row> = record.rows.iter().filter(|row| row.art_paths.is_some()).collect();
    if !rated.is_empty() {
        text += &format!("\nThousand camera paths per second of processor time\n{}", aligned(&rates(&rated)));
    }
    for skipped in &record.skipped {
        text += &format!("skipped {} {}: {}\n", skipped.figure, skipped.scene, skipped.why);
    }
    text
}

fn run<'a>(row: &'a Row, csg: &str) -> Option<&'a Run> {
    row.runs.iter().find(|run| run.csg == csg)
}

/// Share of native's tracing time that a run saves.
fn gain(row: &Row, run: &Run) -> Option<f64> {
    let native = self::run(row, "native")?;
    Some(1.0 - run.trace_seconds / native.trace_seconds)
}

fn stated(row: &Row, csg: &str) -> Option<Stated> {
    row.thesis.iter().find(|stated| stated.csg == csg).map(|stated| stated.seconds)
}

fn stated_gain(row: &Row, csg: &str) -> Option<f64> {
    Some(1.0 - stated(row, csg)?.trace? / stated(row, "native")?.trace?)
}

fn percent(share: Option<f64>) -> String {
    share.map_or("–".into(), |share| format!("{:.1} %", 100.0 * share))
}

/// Names without those that came before, the default last.
fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut distinct: Vec<&str> = Vec::new();
    for name in names {
        if !distinct.contains(&name) {
            distinct.push(name);
        }
    }
    distinct.sort_by_key(|&name| name == DEFAULT);
    distinct
}

fn table_of(table: u8, rows: &[&Row]) -> Vec<Vec<String>> {
    let ours = distinct(rows.iter().flat_map(|row| row.runs.iter().map(|run| run.csg)));
    let thesis = distinct(rows.iter().flat_map(|row| row.thesis.iter().map(|stated| stated.csg)));
    let has_native = ours.contains(&"native");
    let gains: Vec<&str> = ours.iter().copied().filter(|&csg| has_native && csg != "native").collect();
    let mut header = vec!["figure".to_owned(), "scene".into()];
    header.push(if table == 1 { "CSG" } else { "geometries" }.into());
    header.extend(ours.iter().map(|csg| (*csg).to_owned()));
    header.extend(gains.iter().map(|csg| format!("gain of {csg}")));
    if has_native {
        header.push("native / default".into());
    }
    header.extend(thesis.iter().map(|csg| format!("thesis: {csg}")));
    let line = |row: &&Row| {
        let mut cells = vec![row.figure.to_owned(), row.scene.clone()];
        cells.push(if table == 1 { row.solids } else { row.geometries }.to_string());
        let times = |run: &Run| format!("{:.2} + {:.2}", run.prepare_seconds, run.trace_seconds);
        cells.extend(ours.iter().map(|csg| run(row, csg).map_or("–".into(), times)));
        cells.extend(gains.iter().map(|csg| {
            let measured = percent(run(row, csg).and_then(|run| gain(row, run)));
            stated_gain(row, csg).map_or(measured.clone(), |stated| format!("{measured} ({})", percent(Some(stated))))
        }));
        if has_native {
            let factor = run(row, DEFAULT).zip(run(row, "native")).map(|(d, n)| n.trace_seconds / d.trace_seconds);
            cells.push(factor.map_or("–".into(), |factor| format!("{factor:.2}")));
        }
        cells.extend(thesis.iter().map(|csg| stated(row, csg).and_then(times_stated).unwrap_or("–".into())));
        cells
    };
    std::iter::once(header).chain(rows.iter().map(line)).collect()
}

/// As the thesis states them, with preparation where it does.
fn times_stated(stated: Stated) -> Option<String> {
    let trace = stated.trace?;
    Some(stated.prepare.map_or(format!("{trace:.2}"), |prepare| format!("{prepare:.2} + {trace:.2}")))
}

fn rates(rows: &[&Row]) -> Vec<Vec<String>> {
    let header = ["figure", "scene", "native", "default", "ART", "default / ART"];
    let thousands = |run: &Run| run.paths_per_second() / 1e3;
    let line = |row: &&Row| {
        let rate = |csg: &str| run(row, csg).map(thousands);
        let shown = |rate: Option<f64>| rate.map_or("–".into(), |rate| format!("{rate:.0}"));
        let factor = rate(DEFAULT).zip(row.art_paths).map(|(ours, art)| ours / art);
        vec![
            row.figure.to_owned(),
            row.scene.clone(),
            shown(rate("native")),
            shown(rate(DEFAULT)),
            shown(row.art_paths),
            factor.map_or("–".into(), |factor| format!("{factor:.1}")),
        ]
    };
    std::iter::once(header.map(str::to_owned).to_vec()).chain(rows.iter().map(line)).collect()
}

/// A line for each run; what the thesis does not state is empty.
pub fn csv(record: &Record) -> String {
    let mut text =
        "figure,scene,csg_nodes,geometries,csg,prepare_seconds,trace_seconds,camera_paths,paths_per_second,gain,\
                    thesis_prepare_seconds,thesis_trace_seconds,thesis_gain,art_paths_per_second\n"
            .to_owned();
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value}"));
    for row in &record.rows {
        for run in &row.runs {
            let cells = [
                row.figure.to_owned(),
                row.scene.clone(),
                row.solids.to_string(),
                row.geometries.to_string(),
                run.csg.to_owned(),
                run.prepare_seconds.to_string(),
                run.trace_seconds.to_string(),
                run.camera_paths.to_string(),
                run.paths_per_second().to_string(),
                number(gain(row, run)),
                number(stated(row, run.csg).and_then(|stated| stated.prepare)),
                number(stated(row, run.csg).and_then(|stated| stated.trace)),
                number(stated_gain(row, run.csg)),
                number(row.art_paths.map(|rate| 1e3 * rate)),
            ];
            text += &cells.join(",");
            text.push('\n');
        }
    }
    text
}
