//! The scenes of the thesis' chapter 4 in its order, with the seconds that its tables 4.1 to 4.5 state.
//!
//! Those were taken at 700×700 pixels, 128 samples each, paths of up to 20 segments, on 8 threads of an i7-4720HQ. `art`:
//! what ART itself, version 2.1.1 or the thesis' build, whichever is faster, reached natively in thousands of camera paths
//! per second of processor time (350×350, depth 20).

use arsc_accel::Strategy::{self, Hybrid, Kd, Local, Native, Tree};

/// Seconds of preparing and of tracing; not every table states both, nor every run.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct Stated {
    pub prepare: Option<f64>,
    pub trace: Option<f64>,
}

pub struct ThesisScene {
    pub figure: &'static str,
    /// Its table, by number after the 4.
    pub table: u8,
    /// Name of the script, without extension.
    pub script: &'static str,
    /// Params that are set.
    pub set: &'static [(&'static str, &'static str)],
    /// A file that `meshes/fetch` makes.
    pub mesh: Option<&'static str>,
    /// What the thesis states, by the strategy of ours that works alike.
    pub stated: &'static [(Strategy, Stated)],
    pub art: Option<f64>,
}

impl ThesisScene {
    /// The strategies to measure: the thesis' and the default. Open meshes are Embree's in all of ours but `native`, which
    /// has no hierarchy over their triangles and would test each.
    pub fn strategies(&self) -> impl Iterator<Item = Strategy> {
        let is_mesh = self.table == 5;
        let thesis = self.stated.iter().map(|&(strategy, _)| strategy);
        thesis.filter(move |_| !is_mesh).chain([Local])
    }
}

const fn traced(seconds: f64) -> Stated {
    Stated { prepare: None, trace: Some(seconds) }
}

const fn both(prepare: f64, trace: f64) -> Stated {
    Stated { prepare: Some(prepare), trace: Some(trace) }
}

const ABSENT: Stated = Stated { prepare: None, trace: None };

const fn csg(
    figure: &'static str,
    script: &'static str,
    stated: &'static [(Strategy, Stated)],
    art: f64,
) -> ThesisScene {
    ThesisScene { figure, table: 1, script, set: &[], mesh: None, stated, art: Some(art) }
}

const fn hybrid(
    figure: &'static str,
    script: &'static str,
    stated: &'static [(Strategy, Stated)],
    art: f64,
) -> ThesisScene {
    ThesisScene { figure, table: 3, script, set: &[], mesh: None, stated, art: Some(art) }
}

const fn mesh(
    figure: &'static str,
    set: &'static [(&'static str, &'static str)],
    mesh: &'static str,
    stated: &'static [(Strategy, Stated)],
) -> ThesisScene {
    ThesisScene { figure, table: 5, script: "mesh", set, mesh: Some(mesh), stated, art: None }
}

pub const SCENES: &[ThesisScene] = &[
    csg("4.1a", "shell", &[(Native, traced(2611.75)), (Tree, traced(2437.81)), (Kd, traced(4151.01))], 22.0),
    csg("4.1b", "oren_nayar_spheres", &[(Native, traced(791.71)), (Tree, traced(522.97)), (Kd, traced(528.77))], 104.0),
    csg("4.1c", "villa_rotonda", &[(Native, traced(738.25)), (Tree, traced(629.03)), (Kd, traced(765.44))], 126.0),
    csg(
        "4.1d",
        "torrance_sparrow_spheres",
        &[(Native, traced(910.56)), (Tree, traced(896.97)), (Kd, traced(902.61))],
        54.0,
    ),
    csg("4.1e", "biplane", &[(Native, traced(522.58)), (Tree, traced(498.25)), (Kd, traced(546.79))], 97.0),
    csg("4.1f", "locomotive", &[(Native, traced(312.94)), (Tree, traced(272.08)), (Kd, traced(280.83))], 166.0),
    ThesisScene {
        figure: "4.2a",
        table: 2,
        script: "mesh_spheres",
        set: &[],
        mesh: None,
        stated: &[(Native, both(0.09, 237.25)), (Kd, both(0.09, 284.86))],
        art: None,
    },
    ThesisScene {
        figure: "4.2b",
        table: 2,
        script: "mesh_csg",
        set: &[],
        mesh: Some("meshes/data/buddha.ply"),
        stated: &[(Native, both(4.58, 376.20)), (Kd, both(61.82, 709.77))],
        art: None,
    },
    hybrid("4.3a", "colorchecker", &[(Native, traced(382.70)), (Hybrid, traced(361.80))], 245.0),
    hybrid("4.3b", "textured_cornell_box", &[(Native, traced(387.72)), (Hybrid, traced(227.74))], 199.0),
    hybrid("4.3c", "glowing_spheres", &[(Native, traced(397.46)), (Hybrid, traced(389.72))], 252.0),
    hybrid("4.3d", "exoplanet", &[(Native, traced(674.91)), (Hybrid, traced(634.52))], 71.0),
    ThesisScene {
        figure: "4.3b",
        table: 4,
        script: "textured_cornell_box",
        set: &[("quads", "\"solid\"")],
        mesh: None,
        stated: &[(Native, traced(454.60)), (Hybrid, traced(292.25))],
        art: None,
    },
    mesh(
        "4.5a",
        &[("model", "\"teapot\"")],
        "meshes/data/teapot.ply",
        &[(Native, both(0.29, 353.83)), (Tree, both(0.04, 304.26))],
    ),
    mesh(
        "4.5b",
        &[("model", "\"bunny\"")],
        "meshes/data/bunny.ply",
        &[(Native, both(4.28, 379.02)), (Tree, both(0.25, 305.00))],
    ),
    mesh(
        "4.5c",
        &[("model", "\"david\"")],
        "meshes/data/david.ply",
        &[(Native, both(18.40, 302.52)), (Tree, both(1.85, 254.03))],
    ),
    mesh(
        "4.5d",
        &[("model", "\"buddha\"")],
        "meshes/data/buddha.ply",
        &[(Native, both(57.28, 351.92)), (Tree, both(6.48, 276.00))],
    ),
    mesh(
        "4.5e",
        &[("model", "\"asian_dragon\"")],
        "meshes/data/asian_dragon.ply",
        &[(Native, ABSENT), (Tree, both(64.43, 304.29))],
    ),
    mesh("4.5f", &[("model", "\"lucy\"")], "meshes/data/lucy.ply", &[(Native, ABSENT), (Tree, both(302.19, 327.59))]),
];
