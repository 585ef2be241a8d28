//! The action sequence: a typed stack machine.
//!
//! The stack begins with the scene. Effects are those documented at [`Action`]; the compiler has checked them, and what
//! does not fit here is an error, never a guess. An interrupted render leaves an image with fewer samples, and the
//! sequence goes on with it, so that it gets written; a render that did not get a single sample ends the sequence
//! instead, so that no empty picture replaces a good one.

use std::path::PathBuf;
use std::sync::Arc;

use arsc_image::{Depth, DisplayImage, SpectralImage};
use arsc_ir::{Action, ImageAction, Ir, PathTrace, ToneMap};

use crate::rendering::RenderReport;
use crate::stage::{Stage, accel_strategy};
use crate::{AssemblyError, Host, Settings, pictures};

/// What a run of the sequence gave.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The pictures, in the order in which they were written.
    pub written: Vec<PathBuf>,
    pub renders: Vec<RenderReport>,
    /// Somebody asked for an early end.
    pub interrupted: bool,
}

/// What lies on the stack.
#[derive(Clone)]
pub(crate) enum Item {
    Scene(arsc_accel::Strategy),
    Spectral(Arc<SpectralImage>),
    Display(Arc<DisplayImage>),
}

impl Item {
    fn name(item: Option<&Item>) -> &'static str {
        match item {
            None => "nothing",
            Some(Item::Scene(_)) => "a scene",
            Some(Item::Spectral(_)) => "a spectral image",
            Some(Item::Display(_)) => "a display image",
        }
    }
}

/// What is done when a script says nothing: a render, written as EXR and PNG under the scene's name.
pub fn default_actions(scene_name: &str) -> Vec<Action> {
    vec![
        Action::PathTrace(PathTrace::default()),
        Action::WriteExr { path: format!("{scene_name}.exr") },
        Action::ToneMap { tone: ToneMap::default(), slice_nm: None },
        Action::WritePng { path: format!("{scene_name}.png"), sixteen_bit: false },
    ]
}

/// The actions that [`run`] goes through.
pub fn actions(ir: &Ir, scene_name: &str) -> Vec<Action> {
    if ir.actions.is_empty() {
        default_actions(scene_name)
    } else {
        ir.actions.iter().map(|at| at.action.clone()).collect()
    }
}

/// Runs the action sequence of a scene in normal form.
pub fn run(ir: &Ir, settings: &Settings, host: &dyn Host) -> Result<Outcome, AssemblyError> {
    let stage = Stage::new(ir, settings, host)?;
    let mut machine = Machine { stage, settings, host, stack: Vec::new(), outcome: Outcome::default() };
    machine.stack.push(Item::Scene(settings.strategy.unwrap_or_default()));
    for action in actions(ir, &settings.scene_name) {
        if !machine.step(&action)? {
            break;
        }
    }
    Ok(machine.outcome)
}

pub(crate) struct Machine<'a> {
    pub stage: Stage<'a>,
    pub settings: &'a Settings,
    pub host: &'a dyn Host,
    /// The top is the last.
    pub stack: Vec<Item>,
    pub outcome: Outcome,
}

impl Machine<'_> {
    /// Does one action; false when the sequence ends here.
    fn step(&mut self, action: &Action) -> Result<bool, AssemblyError> {
        match action {
            Action::Accelerate { strategy } => {
                self.scene("accelerate")?;
                let strategy = self.settings.strategy.unwrap_or(accel_strategy(*strategy));
                self.stack.pop();
                self.stack.push(Item::Scene(strategy));
            }
            Action::BoundingBoxes => {
                let strategy = self.scene("bounding_boxes")?;
                self.stage.say_bounds(strategy)?;
            }
            Action::CollectLights => {
                let strategy = self.scene("collect_lights")?;
                self.stage.say_lights(strategy)?;
            }
            Action::PathTrace(trace) => return self.path_trace(trace),
            Action::AmbientOcclusion { distance, sampling } => return self.ambient_occlusion(*distance, sampling),
            Action::Preview { sampling, features } => return self.preview(sampling, *features),
            Action::WriteExr { path } => {
                let bytes = arsc_image::encode_exr(&*self.spectral("write_exr")?)?;
                self.write(path, &bytes)?;
            }
            Action::ToneMap { tone, slice_nm } => {
                let image = pictures::tone_map(&*self.spectral("tone_map")?, tone, *slice_nm)?;
                self.stack.pop();
                self.stack.push(Item::Display(Arc::new(image)));
            }
            Action::Image(action) => self.image_action(action)?,
            Action::WritePng { path, sixteen_bit } => {
                let bytes = arsc_image::encode_png(&*self.display("write_png")?, depth(*sixteen_bit))?;
                self.write(path, &bytes)?;
            }
            Action::WriteTiff { path, sixteen_bit } => {
                let bytes = arsc_image::encode_tiff(&*self.display("write_tiff")?, depth(*sixteen_bit))?;
                self.write(path, &bytes)?;
            }
            Action::WriteCsv { path } => {
                let text = arsc_image::encode_csv(&*self.spectral("write_csv")?)?;
                self.write(path, text.as_bytes())?;
            }
            Action::Dup => self.shuffle("dup", 1, |items| vec![items[0].clone(), items[0].clone()])?,
            Action::Drop => self.shuffle("drop", 1, |_| vec![])?,
            Action::Swap => self.shuffle("swap", 2, |items| vec![items[1].clone(), items[0].clone()])?,
            Action::Over => {
                self.shuffle("over", 2, |items| vec![items[0].clone(), items[1].clone(), items[0].clone()])?;
            }
        }
        Ok(true)
    }

    /// Replaces the topmost picture, or two, by what the action makes of them.
    fn image_action(&mut self, action: &ImageAction) -> Result<(), AssemblyError> {
        let top = self.spectral(action.name())?;
        self.stack.pop();
        let below = match (action, self.stack.last()) {
            (ImageAction::Add | ImageAction::Merge, Some(Item::Spectral(_))) => self.stack.pop(),
            (ImageAction::Add | ImageAction::Merge, other) => {
                return Err(mismatch(action.name(), "two spectral images", other));
            }
            _ => None,
        };
        let below = if let Some(Item::Spectral(image)) = below { Some(image) } else { None };
        let made = pictures::apply(action, top, below, self.host, self.settings.denoiser.as_deref())?;
        self.stack.push(made);
        Ok(())
    }

    fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), AssemblyError> {
        let written =
            self.host.write(name, bytes).map_err(|source| AssemblyError::Write { name: name.to_owned(), source })?;
        self.outcome.written.extend(written);
        Ok(())
    }

    /// The scene on top of the stack.
    pub fn scene(&self, action: &'static str) -> Result<arsc_accel::Strategy, AssemblyError> {
        match self.stack.last() {
            Some(Item::Scene(strategy)) => Ok(*strategy),
            other => Err(mismatch(action, "a scene", other)),
        }
    }

    fn spectral(&self, action: &'static str) -> Result<Arc<SpectralImage>, AssemblyError> {
        match self.stack.last() {
            Some(Item::Spectral(image)) => Ok(image.clone()),
            other => Err(mismatch(action, "a spectral image", other)),
        }
    }

    fn display(&self, action: &'static str) -> Result<Arc<DisplayImage>, AssemblyError> {
        match self.stack.last() {
            Some(Item::Display(image)) => Ok(image.clone()),
            other => Err(mismatch(action, "a display image", other)),
        }
    }

    /// Replaces the `count` topmost items.
    fn shuffle(
        &mut self,
        action: &'static str,
        count: usize,
        rearrange: impl Fn(&[Item]) -> Vec<Item>,
    ) -> Result<(), AssemblyError> {
        let needs = if count == 1 { "an item" } else { "two items" };
        let from = self.stack.len().checked_sub(count).ok_or_else(|| mismatch(action, needs, self.stack.last()))?;
        let rearranged = rearrange(&self.stack[from..]);
        self.stack.truncate(from);
        self.stack.extend(rearranged);
        Ok(())
    }
}

fn mismatch(action: &'static str, needs: &'static str, found: Option<&Item>) -> AssemblyError {
    AssemblyError::Stack { action, needs, found: Item::name(found) }
}

fn depth(sixteen_bit: bool) -> Depth {
    if sixteen_bit { Depth::Sixteen } else { Depth::Eight }
}
