//! Meshes that a script names: open surfaces and closed solids, with what there is to say about them.

use std::sync::Arc;

use arsc_diagnostics::Diagnostic;
use arsc_diagnostics::codes::sema as codes;
use arsc_geometry::{ClosedMesh, ClosedMeshError, MeshRepairs};
use arsc_ir::{Shape, Surface};

use crate::MeshFile;
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::registry::{asset_failure, shortened};

/// What became of a mesh that was to be a solid; once for each file.
pub type ClosedOutcome = Result<(Arc<ClosedMesh>, MeshRepairs), ClosedMeshError>;

impl Machine<'_> {
    /// The mesh as a surface. The path is the call's first argument.
    pub fn open_mesh(&mut self, path: &str, site: &Site) -> Eval<Surface> {
        let MeshFile { path, mesh } = self.mesh_file(path, site)?;
        self.lint_degenerate(mesh.count_degenerate(), site);
        Ok(Surface::Mesh { path, mesh })
    }

    /// The mesh as a solid. The path is the call's first argument.
    pub fn closed_mesh(&mut self, path: &str, site: &Site) -> Eval<Shape> {
        let MeshFile { path, mesh } = self.mesh_file(path, site)?;
        let outcome = self
            .closed_meshes
            .entry(path.clone())
            .or_insert_with(|| {
                let (mesh, repairs) = ClosedMesh::new(path.clone(), (*mesh).clone())?;
                Ok((Arc::new(mesh), repairs))
            })
            .clone();
        let (mesh, repairs) = outcome.map_err(|error| does_not_close(&path, &error, site))?;
        self.lint_degenerate(repairs.degenerate, site);
        self.lint_orientation(&repairs, site);
        Ok(Shape::Mesh(mesh))
    }

    fn mesh_file(&mut self, path: &str, site: &Site) -> Eval<MeshFile> {
        self.assets.mesh(site.span.source, path).map_err(|error| asset_failure(site, path, &error))
    }

    fn lint_degenerate(&mut self, faces: usize, site: &Site) {
        if faces > 0 {
            let message = format!("faces of the mesh without an area: {faces}");
            self.lint(
                Diagnostic::new(codes::DEGENERATE_FACES, message)
                    .label(site.args[0], "in this file")
                    .help("they show nothing: remove them where the mesh was made"),
            );
        }
    }

    fn lint_orientation(&mut self, repairs: &MeshRepairs, site: &Site) {
        if repairs.flipped > 0 {
            let message = format!("faces of the mesh that run against their neighbours: {}", repairs.flipped);
            self.lint(
                Diagnostic::new(codes::MESH_ORIENTATION, message)
                    .label(site.args[0], "they were turned to agree")
                    .help("make the faces of the file run counter-clockwise as seen from outside"),
            );
        } else if repairs.inverted_pieces > 0 {
            let message = match repairs.inverted_pieces {
                1 => "a piece of the mesh is inside out".to_owned(),
                many => format!("{many} pieces of the mesh are inside out"),
            };
            self.lint(
                Diagnostic::new(codes::MESH_ORIENTATION, message)
                    .label(site.args[0], "turned so that normals point outwards")
                    .help("make the faces of the file run counter-clockwise as seen from outside"),
            );
        }
    }
}

fn does_not_close(path: &str, error: &ClosedMeshError, site: &Site) -> Box<Diagnostic> {
    let (message, help) = match error {
        ClosedMeshError::Open { .. } => ("is not closed", "close the hole, or use `mesh` for an open surface"),
        ClosedMeshError::Unorientable { .. } => ("has no inside", "use `mesh` for an open surface"),
        _ => ("bounds no solid", "use `mesh` for an open surface"),
    };
    let mut diagnostic =
        *site.fail_arg(0, codes::OPEN_MESH, format!("the mesh `{}` {message}", shortened(path)), error.to_string());
    diagnostic = diagnostic.help(help);
    Box::new(diagnostic)
}
