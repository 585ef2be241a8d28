//! Stack effects of actions: the whole sequence is checked before anything is rendered.
//!
//! The stack holds the scene at first. An action finds what it needs on top.

use std::collections::BTreeMap;
use std::fmt;

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span};
use arsc_ir::{Action, ActionAt, ImageAction};

/// What a stack cell holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cell {
    Scene,
    SpectralImage,
    DisplayImage,
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Cell::Scene => "a scene",
            Cell::SpectralImage => "a spectral image",
            Cell::DisplayImage => "a display image",
        })
    }
}

fn name(action: &Action) -> &'static str {
    match action {
        Action::Accelerate { .. } => "accelerate",
        Action::BoundingBoxes => "bounding_boxes",
        Action::CollectLights => "collect_lights",
        Action::PathTrace(_) => "path_trace",
        Action::AmbientOcclusion { .. } => "ambient_occlusion",
        Action::Preview { features: false, .. } => "preview",
        Action::Preview { features: true, .. } => "render_features",
        Action::ToneMap { .. } => "tone_map",
        Action::WriteExr { .. } => "write_exr",
        Action::WritePng { .. } => "write_png",
        Action::WriteTiff { .. } => "write_tiff",
        Action::WriteCsv { .. } => "write_csv",
        Action::Image(action) => action.name(),
        Action::Dup => "dup",
        Action::Swap => "swap",
        Action::Drop => "drop",
        Action::Over => "over",
    }
}

/// Checks a sequence; a sequence that writes nothing is a lint. An empty one stands for the renderer's own.
pub fn check(actions: &[ActionAt], span: Span, lints: &mut Vec<Diagnostic>) -> Result<(), Box<Diagnostic>> {
    let mut stack = vec![Cell::Scene];
    for at in actions {
        apply(&mut stack, at)?;
    }
    no_picture_twice(actions)?;
    if !actions.is_empty() && !actions.iter().any(|at| at.action.output().is_some()) {
        let lint =
            Diagnostic::new(codes::NO_OUTPUT, "the action sequence writes no file").label(span, "no output here");
        lints.push(lint.help("add `write_exr(\"name.exr\")` after `path_trace`"));
    }
    Ok(())
}

/// The second of two pictures of one name would replace the first.
fn no_picture_twice(actions: &[ActionAt]) -> Result<(), Box<Diagnostic>> {
    let mut seen = BTreeMap::new();
    for at in actions {
        if let Some(path) = at.action.output()
            && let Some(first) = seen.insert(path, at.origin)
        {
            let message = format!("the picture `{path}` is written twice");
            let failure = Diagnostic::new(codes::STACK, message).label(at.origin, "this one replaces the other");
            let failure = if first == at.origin { failure } else { failure.label(first, "first written here") };
            return Err(Box::new(failure.help("give each picture a name of its own")));
        }
    }
    Ok(())
}

fn apply(stack: &mut Vec<Cell>, at: &ActionAt) -> Result<(), Box<Diagnostic>> {
    match at.action {
        Action::Accelerate { .. } | Action::BoundingBoxes | Action::CollectLights => top(stack, at, Cell::Scene)?,
        Action::PathTrace(_) | Action::AmbientOcclusion { .. } | Action::Preview { .. } => {
            top(stack, at, Cell::Scene)?;
            stack.push(Cell::SpectralImage);
        }
        Action::ToneMap { .. } => {
            top(stack, at, Cell::SpectralImage)?;
            stack.pop();
            stack.push(Cell::DisplayImage);
        }
        Action::WriteExr { .. } | Action::WriteCsv { .. } => top(stack, at, Cell::SpectralImage)?,
        Action::WritePng { .. } | Action::WriteTiff { .. } => top(stack, at, Cell::DisplayImage)?,
        Action::Image(ref action) => {
            top(stack, at, Cell::SpectralImage)?;
            match action {
                ImageAction::DifferenceTo { .. } | ImageAction::VisualisePolarisation(_) => {
                    stack.pop();
                    stack.push(Cell::DisplayImage);
                }
                ImageAction::Add | ImageAction::Merge => match stack[..] {
                    [.., Cell::SpectralImage, Cell::SpectralImage] => drop(stack.pop()),
                    _ => return Err(too_few_images(stack, at)),
                },
                _ => {}
            }
        }
        Action::Dup | Action::Drop => {
            let [.., last] = stack[..] else { return Err(too_few(stack, at, 1)) };
            if at.action == Action::Dup {
                stack.push(last);
            } else {
                stack.pop();
            }
        }
        Action::Swap | Action::Over => {
            let [.., below, _] = stack[..] else { return Err(too_few(stack, at, 2)) };
            if at.action == Action::Over {
                stack.push(below);
            } else {
                let n = stack.len();
                stack.swap(n - 1, n - 2);
            }
        }
    }
    Ok(())
}

fn top(stack: &[Cell], at: &ActionAt, wanted: Cell) -> Result<(), Box<Diagnostic>> {
    let found = stack.last().copied();
    if found == Some(wanted) {
        return Ok(());
    }
    let image = wanted == Cell::SpectralImage && found == Some(Cell::Scene);
    let wanted_text = if image { "an image".to_owned() } else { wanted.to_string() };
    let message = match found {
        Some(found) if stack.len() == 1 => {
            format!("`{}` needs {wanted_text}, but the stack holds {found}", name(&at.action))
        }
        Some(found) => format!("`{}` needs {wanted_text}, but on top of the stack is {found}", name(&at.action)),
        None => format!("`{}` needs {wanted_text}, but the stack is empty", name(&at.action)),
    };
    let failure = Diagnostic::new(codes::STACK, message).label(at.origin, "this action");
    Err(Box::new(match help(stack, wanted) {
        Some(help) => failure.help(help),
        None => failure,
    }))
}

/// One thing to do about a wrong top of the stack.
fn help(stack: &[Cell], wanted: Cell) -> Option<&'static str> {
    match (stack.last(), wanted) {
        (Some(Cell::Scene), Cell::SpectralImage) => Some("`path_trace()` makes an image of the scene"),
        (Some(Cell::Scene), Cell::DisplayImage) => Some("`path_trace()`, then `tone_map()` make one"),
        (Some(Cell::SpectralImage), Cell::DisplayImage) => Some("`tone_map()` makes one from a spectral image"),
        (Some(Cell::DisplayImage), Cell::SpectralImage) => {
            Some("do this before `tone_map`, or keep the spectral image with `dup()`")
        }
        (Some(_), Cell::Scene) if stack.contains(&Cell::Scene) => Some("`drop()` removes the image from the stack"),
        _ => None,
    }
}

fn too_few(stack: &[Cell], at: &ActionAt, wanted: usize) -> Box<Diagnostic> {
    let message = format!("`{}` needs {wanted} on the stack, but it holds {}", name(&at.action), stack.len());
    Box::new(Diagnostic::new(codes::STACK, message).label(at.origin, "this action"))
}

fn too_few_images(stack: &[Cell], at: &ActionAt) -> Box<Diagnostic> {
    let below = stack.len().checked_sub(2).map_or("nothing".to_owned(), |i| stack[i].to_string());
    let message = format!("`{}` needs two spectral images, but below the topmost lies {below}", name(&at.action));
    let failure = Diagnostic::new(codes::STACK, message).label(at.origin, "this action");
    Box::new(failure.help("`over()`, then `path_trace()` make a second one"))
}
