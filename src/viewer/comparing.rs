//! Comparing with a traced reference: the menu, and the tracing behind it.

use super::desk::Desk;
use super::references::{Asked, Effort, References, Tracing};
use crate::vulkan::Device;
use egui::PopupCloseBehavior;
use egui::containers::menu::{MenuButton, MenuConfig};
use std::sync::Arc;

/// Samples a pixel that are offered.
const SAMPLES: [u64; 4] = [16, 64, 256, 1024];
/// What the sides of the picture may be divided by.
const DIVISORS: [u32; 3] = [1, 2, 4];

/// References of the scene on the desk.
#[derive(Default)]
pub struct Comparing {
    /// Who makes them, and on what pictures are drawn; nobody where they could not be kept.
    makers: Option<(Arc<dyn References>, Arc<Device>)>,
    /// How the next one is asked for.
    effort: Effort,
    /// The one that is being traced.
    tracing: Option<Tracing>,
}

impl Comparing {
    /// With references by these, of pictures of this device.
    pub fn new(references: Option<Arc<dyn References>>, device: &Arc<Device>) -> Self {
        let makers = references.map(|references| (references, device.clone()));
        Self { makers, ..Self::default() }
    }
}

impl Desk {
    /// What can be done about references.
    pub(super) fn reference_menu(&mut self, ui: &mut egui::Ui) {
        if self.comparing.makers.is_none() {
            return;
        }
        if let Some(tracing) = &self.comparing.tracing {
            let bar = egui::ProgressBar::new(tracing.share() as f32).desired_width(90.0).show_percentage();
            ui.add(bar).on_hover_text("The reference is being traced");
            if ui.button("Stop").on_hover_text("What was traced so far is kept").clicked() {
                tracing.stop();
            }
            return;
        }
        // A choice in it does not close it.
        let stays = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        MenuButton::new("Reference").config(stays).ui(ui, |ui| {
            ui.label("Traces every fiber, for minutes; where it was traced before it is there at once.");
            let effort = &mut self.comparing.effort;
            ui.horizontal(|ui| {
                for samples in SAMPLES {
                    ui.selectable_value(&mut effort.samples, samples, samples.to_string());
                }
                ui.label("samples");
            });
            ui.horizontal(|ui| {
                for divisor in DIVISORS {
                    let name = if divisor == 1 { "whole".into() } else { format!("1/{divisor}") };
                    ui.selectable_value(&mut effort.divisor, divisor, name);
                }
                ui.label("of the sides");
            });
            if ui.button("Compare with the reference").clicked() {
                self.trace(ui.ctx());
                ui.close();
            }
        });
    }

    /// Starts to trace the scene as it is looked at.
    fn trace(&mut self, context: &egui::Context) {
        let Comparing { makers: Some((references, device)), effort, .. } = &self.comparing else { return };
        let Some(size) = self.canvas.place_size() else { return };
        let asked = Asked {
            file: self.file(),
            folder: self.document.folder().to_owned(),
            name: self.document.path().display().to_string(),
            size: size.map(|side| side.div_ceil(effort.divisor)),
            samples: effort.samples,
            device: device.clone(),
        };
        let context = context.clone();
        self.comparing.tracing =
            Some(Tracing::start(references.clone(), asked, move || context.request_repaint()));
    }

    /// Lets tracing wait while something moves: it would take the processor away from drawing.
    pub(super) fn hold_tracing(&self, moving: bool) {
        if let Some(tracing) = &self.comparing.tracing {
            tracing.hold(moving);
        }
    }

    /// Hears what came of tracing.
    pub(super) fn hear_reference(&mut self, context: &egui::Context) {
        let Some(heard) = self.comparing.tracing.as_ref().and_then(Tracing::hear) else { return };
        let Some(tracing) = self.comparing.tracing.take() else { return };
        let found = match heard {
            Ok(Some(found)) => found,
            Ok(None) => return,
            Err(error) => return self.say(error.to_string()),
        };
        tracing::info!(
            "reference: {}x{}, {} samples, {} other settings known",
            found.light.width,
            found.light.height,
            tracing.asked.samples,
            found.known.len()
        );
        let compared = self.canvas.compare_with_found(context, found, tracing.asked.file.clone());
        self.say_if_wrong(compared.map_err(|error| error.to_string()));
    }
}
