//! The line of buttons above everything.

use super::canvas::Shows;
use super::desk::Desk;
use super::playing::last;
use crate::scene::file::DebugView;
use std::path::PathBuf;
use toml::Value;

/// Shows it, and does what is pressed.
pub fn show(ui: &mut egui::Ui, desk: &mut Desk) {
    egui::Panel::top("toolbar").show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            files(ui, desk);
            ui.separator();
            views(ui, desk);
            ui.separator();
            comparing(ui, desk);
            ui.separator();
            ui.toggle_value(&mut desk.live.is_open, "Figures");
        });
        if desk.shown().is_some_and(|shown| shown.frame_count.is_some()) {
            timeline(ui, desk);
        }
    });
}

fn files(ui: &mut egui::Ui, desk: &mut Desk) {
    ui.menu_button("File", |ui| {
        ui.label(desk.document.path().display().to_string());
        ui.label("Drop a scene, a yarn, frames or an EXR on the window to open it.");
        let scene = desk.document.path().with_extension("toml");
        if ui.button("Save scene").on_hover_text(scene.display().to_string()).clicked() {
            desk.save(&scene);
            ui.close();
        }
        if ui.button("Screenshot").on_hover_text("The picture, and the scene beside it").clicked() {
            take_screenshot(desk);
            ui.close();
        }
        if ui.button("Copy as --set").clicked() {
            let lines = desk.keep_camera().map(|()| desk.document.set_lines().join(" "));
            match lines {
                Ok(lines) => ui.ctx().copy_text(lines),
                Err(why) => desk.say(why),
            }
            ui.close();
        }
        ui.separator();
        ui.label("Recent");
        let recent: Vec<PathBuf> = desk.recent.files().map(PathBuf::from).collect();
        for path in recent {
            if ui.button(path.display().to_string()).clicked() {
                desk.open(&path);
                ui.close();
            }
        }
    });
}

fn take_screenshot(desk: &mut Desk) {
    let stem = desk.document.path().with_extension("");
    let free =
        (1..10_000).map(|n| PathBuf::from(format!("{}-{n:04}.png", stem.display()))).find(|p| !p.exists());
    if let Some(path) = free {
        desk.take_screenshot(path);
    }
}

fn views(ui: &mut egui::Ui, desk: &mut Desk) {
    if ui.button("Fit").on_hover_text("Look at all of it (F)").clicked() {
        desk.fit();
    }
    let mut turns = desk.playing.turns();
    if ui.toggle_value(&mut turns, "Turntable").on_hover_text("T").clicked() {
        desk.toggle_turntable();
    }
    let view = desk.document.scene_file().debug.view;
    egui::ComboBox::from_id_salt("debug view").selected_text(name_of(view)).show_ui(ui, |ui| {
        for other in VIEWS {
            if ui.selectable_label(view == other, name_of(other)).clicked() {
                let set = desk.document.set("debug.view", Value::String(name_of(other)));
                desk.document.end_gesture();
                desk.say_if_wrong(set);
            }
        }
    });
    egui::ComboBox::from_id_salt("samples")
        .selected_text(format!("{} samples", desk.look.most_samples))
        .show_ui(ui, |ui| {
            for samples in [4, 16, 64] {
                ui.selectable_value(&mut desk.look.most_samples, samples, format!("{samples} samples"));
            }
        });
}

/// Views in the order of their numbers.
const VIEWS: [DebugView; 9] = [
    DebugView::Shaded,
    DebugView::Normal,
    DebugView::Tangent,
    DebugView::Occlusion,
    DebugView::Ply,
    DebugView::Kind,
    DebugView::Frame,
    DebugView::Length,
    DebugView::LevelOfDetail,
];

/// A view as a scene file calls it.
fn name_of(view: DebugView) -> String {
    match Value::try_from(view) {
        Ok(Value::String(name)) => name,
        _ => format!("{view:?}"),
    }
}

fn comparing(ui: &mut egui::Ui, desk: &mut Desk) {
    if ui.button("Keep as A").on_hover_text("Compare what follows with the picture as it is").clicked()
        && let Some(shown) = &desk.shown
    {
        desk.canvas.keep(ui.ctx(), shown);
    }
    desk.reference_menu(ui);
    let Some((other, fits)) = desk.canvas.other(|| desk.file()).map(|(name, fits)| (name.to_owned(), fits))
    else {
        return;
    };
    let shows = desk.canvas.shows;
    let mut choose = |ui: &mut egui::Ui, to: Shows, name: &str| {
        let chosen = std::mem::discriminant(&shows) == std::mem::discriminant(&to);
        if ui.selectable_label(chosen, name).clicked() && !chosen {
            desk.canvas.shows = to;
        }
    };
    choose(ui, Shows::Picture, "B");
    choose(ui, Shows::Wipe(0.5), "A | B");
    choose(ui, Shows::Heatmap, "Heatmap");
    let stale = if fits { "" } else { ", of the scene before it changed" };
    ui.label(format!("A: {other}{stale}"));
    if ui.small_button("x").on_hover_text("Compare no more").clicked() {
        desk.canvas.forget_other();
    }
}

fn timeline(ui: &mut egui::Ui, desk: &mut Desk) {
    let Some(count) = desk.shown().and_then(|shown| shown.frame_count) else { return };
    ui.horizontal(|ui| {
        let name = if desk.playing.plays() { "Pause" } else { "Play" };
        if ui.button(name).on_hover_text("Space").clicked() {
            desk.toggle_playing();
        }
        let mut frame = desk.file().animation.frame.unwrap_or(0.0);
        ui.spacing_mut().slider_width = (ui.available_width() - 260.0).max(100.0);
        let slider = ui.add(egui::Slider::new(&mut frame, 0.0..=last(count)).text("frame"));
        if slider.changed() {
            desk.playing.pause();
            desk.scrub(frame);
        }
        if slider.drag_stopped() {
            desk.document.end_gesture();
        }
        let speed = egui::DragValue::new(&mut desk.playing.speed).range(0.05..=20.0).speed(0.01).suffix(" x");
        if ui.add(speed).on_hover_text("Speed").changed() && desk.playing.plays() {
            // It goes on from where it is.
            desk.playing.play(frame, std::time::Instant::now());
        }
    });
}
