//! `arsc probe` from outside: intervals against closed forms, both formats, bad rows; every primitive against its
//! inequality.

mod common;
#[path = "probe/primitives.rs"]
mod primitives;

use common::{arsc, arsc_with_input, scene, stderr, stdout};

/// A ball with a bore along z, beside a box.
const SCENE: &str = "
import std.material { lambert, mirror }
scene {
    (sphere(radius: 2) - (cylinder(radius: 1, height: 10) |> translate(z: -5))) |> with(lambert(0.5))
    box(size: (2, 2, 2)) |> translate(x: 6) |> with(mirror())
}
";

/// Across ball and box; from inside the ball with a direction of length 2; through the bore; up through the box.
const RAYS: &str = "ox,oy,oz,dx,dy,dz\n-10,0,0,1,0,0\n1.5,0,0,0,0,2\n0,0,50,0,0,-1\n6,0,-3,0,0,1\n";

fn probe(rays: &str, arguments: &[&str]) -> std::process::Output {
    let (_folder, script) = scene("probe.arsl", SCENE);
    arsc_with_input(&[&["probe", &script, "--rays", "-"], arguments].concat(), rays)
}

/// Ray, both distances, both normals; `None` where the ray starts inside.
type Expected = (usize, f64, f64, Option<[f64; 3]>, [f64; 3]);

fn expected() -> Vec<Expected> {
    let up = 1.75f64.sqrt();
    let (left, right) = ([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    vec![
        (0, 8.0, 9.0, Some(left), right),
        (0, 11.0, 12.0, Some(left), right),
        (0, 15.0, 17.0, Some(left), right),
        (1, 0.0, up / 2.0, None, [0.75, 0.0, up / 2.0]),
        (3, 2.0, 4.0, Some([0.0, 0.0, -1.0]), [0.0, 0.0, 1.0]),
    ]
}

fn assert_close(found: &[f64], expected: &[f64]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
    }
}

#[test]
fn csv_rows_are_the_closed_form() {
    for strategy in ["local", "native", "collect", "tree", "kd", "hybrid", "incremental"] {
        let run = probe(RAYS, &["--format", "csv", "--csg", strategy]);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        let text = stdout(&run);
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("ray,t_enter,t_exit,solid,material,nx,ny,nz,nx,ny,nz"));
        let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), expected().len(), "{text}");
        let number = |cell: &str| cell.parse::<f64>().unwrap();
        for (row, (ray, enter, exit, normal_enter, normal_exit)) in rows.iter().zip(expected()) {
            assert_eq!(row.len(), 11);
            assert_eq!(row[0], ray.to_string());
            assert_close(&[number(row[1]), number(row[2])], &[enter, exit]);
            match normal_enter {
                Some(normal) => assert_close(&[number(row[5]), number(row[6]), number(row[7])], &normal),
                None => assert_eq!(row[5..8], ["", "", ""]),
            }
            assert_close(&[number(row[8]), number(row[9]), number(row[10])], &normal_exit);
        }
        let columns = |row: usize| (rows[row][3], rows[row][4]);
        assert_eq!(columns(0), columns(1));
        assert_ne!(columns(0).1, columns(2).1, "ball and box have materials of their own");
        assert_eq!(columns(2), columns(4));
    }
}

#[test]
fn json_says_the_same() {
    let run = probe(RAYS, &["--format", "json"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    let rows: Vec<serde_json::Value> = serde_json::from_str(&stdout(&run)).unwrap();
    assert_eq!(rows.len(), expected().len());
    let vector = |value: &serde_json::Value| -> Vec<f64> { serde_json::from_value(value.clone()).unwrap() };
    for (row, (ray, enter, exit, normal_enter, normal_exit)) in rows.iter().zip(expected()) {
        assert_eq!(row["ray"], ray);
        assert_close(&[row["t_enter"].as_f64().unwrap(), row["t_exit"].as_f64().unwrap()], &[enter, exit]);
        match normal_enter {
            Some(normal) => assert_close(&vector(&row["normal_enter"]), &normal),
            None => assert!(row["normal_enter"].is_null()),
        }
        assert_close(&vector(&row["normal_exit"]), &normal_exit);
    }
    let none = probe("0,0,50,0,0,-1\n", &["--format", "json"]);
    assert_eq!(stdout(&none), "[]\n");
}

#[test]
fn bad_rows_and_files_name_the_place() {
    for (rays, reason) in [
        ("0,0,0,0,0,1\n1,2,3\n", "line 2: expected ox,oy,oz,dx,dy,dz"),
        ("0,0,0,0,0,1\n0,0,0,up,0,1\n", "line 2: `up` is not a number"),
        ("0,0,0,0,0,0\n", "line 1: a ray needs"),
    ] {
        let run = probe(rays, &[]);
        assert_eq!(run.status.code(), Some(2));
        assert!(stderr(&run).contains(reason), "{}", stderr(&run));
        assert!(run.stdout.is_empty());
    }
    let (_folder, script) = scene("probe.arsl", SCENE);
    let missing = arsc(&["probe", &script, "--rays", "there-is-no-such.csv"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(stderr(&missing).contains("there-is-no-such.csv"));
    assert_eq!(arsc(&["probe", "-", "--rays", "-"]).status.code(), Some(2));
}
