//! From a checked program to the IR.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, SourceId, Span};
use arsc_ir::{ActionAt, Ir, NodeId, NodeKind};

use super::{Eval, Machine};
use crate::code::{Entry, GlobalId};
use crate::value::Value;

impl Machine<'_> {
    pub(super) fn collect(&mut self, value: Value, span: Span) -> Eval<()> {
        match value {
            Value::List(list) => {
                self.spend_elements(list.len(), span)?;
                list.iter().try_for_each(|element| self.collect(element.clone(), span))
            }
            other => {
                self.collected.push(other);
                Ok(())
            }
        }
    }

    /// Runs scene, camera and actions. `Err` holds every failure: the three do not depend on each other.
    pub fn build(&mut self, fallback: Span) -> Result<Ir, Vec<Diagnostic>> {
        let program = self.program;
        let mut failures = Vec::new();
        let root = self.scene(program.scene.as_ref(), fallback).map_err(|failure| failures.push(*failure)).ok();
        let camera = match &program.camera {
            Some(entry) => self.run_entry(entry).map_err(|failure| failures.push(*failure)).ok(),
            None => None,
        };
        let actions = self.actions(program.actions.as_ref()).map_err(|failure| failures.push(*failure)).ok();
        if failures.is_empty() {
            failures.extend(self.unused_values(fallback.source).err().map(|failure| *failure));
        }
        let (Some(root), Some(actions), true) = (root, actions, failures.is_empty()) else { return Err(failures) };
        Ok(Ir {
            nodes: std::mem::take(&mut self.nodes),
            root,
            bsdfs: std::mem::take(&mut self.bsdfs),
            emitters: std::mem::take(&mut self.emitters),
            media: std::mem::take(&mut self.media),
            materials: Vec::new(),
            camera: camera.map(|camera| camera.as_camera().as_ref().clone()),
            actions,
        })
    }

    /// Evaluates the values of the root script that nothing has asked for: `let x = 1 / 0` is wrong although unused.
    /// What they add to the scene's tables is dropped.
    fn unused_values(&mut self, root: SourceId) -> Eval<()> {
        let (nodes, bsdfs) = (self.nodes.len(), self.bsdfs.len());
        let (emitters, media) = (self.emitters.len(), self.media.len());
        for (i, global) in self.program.globals.iter().enumerate() {
            if global.entry.span.source == root {
                self.global(GlobalId(i as u32), global.entry.span)?;
            }
        }
        self.nodes.truncate(nodes);
        self.bsdfs.truncate(bsdfs);
        self.emitters.truncate(emitters);
        self.media.truncate(media);
        Ok(())
    }

    fn scene(&mut self, entry: Option<&Entry>, fallback: Span) -> Eval<NodeId> {
        let span = entry.map_or(fallback, |entry| entry.span);
        let parts = self.run_collecting(entry)?;
        if parts.is_empty() && entry.is_some() {
            self.diagnostics.push(
                Diagnostic::new(codes::EMPTY_SCENE, "the scene contains nothing").label(span, "collects no shape"),
            );
        }
        let parts = parts.iter().map(Value::as_node).collect();
        self.node(NodeKind::Union(parts), span)
    }

    fn actions(&mut self, entry: Option<&Entry>) -> Eval<Vec<ActionAt>> {
        let actions: Vec<ActionAt> =
            self.run_collecting(entry)?.iter().map(|action| action.as_action().as_ref().clone()).collect();
        if let Some(entry) = entry {
            crate::actions::check(&actions, entry.span, &mut self.diagnostics)?;
        }
        Ok(actions)
    }

    fn run_collecting(&mut self, entry: Option<&Entry>) -> Eval<Vec<Value>> {
        let ended = entry.map_or(Ok(Value::unit()), |entry| self.run_entry(entry));
        // Taken whether or not it ended well: the next block collects its own.
        let collected = std::mem::take(&mut self.collected);
        ended.map(|_| collected)
    }
}
