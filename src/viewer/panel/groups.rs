//! Groups of rows: one for each table of a scene, one within for each light and fabric.

use super::Panel;
use super::rows::row;
use crate::scene::parameters::{Group, Parameter, of_table, parameters};
use crate::viewer::document::Document;
use egui::{CollapsingHeader, ComboBox, RichText, Ui};

/// Groups that are open in the beginning.
const OPEN: [Group; 3] = [Group::Yarn, Group::Fiber, Group::Light];

/// Whether all words of a search are in what a row says.
pub fn matches(row: &Parameter, search: &str) -> bool {
    let Parameter { about, symbol, paper, .. } = row;
    let text =
        format!("{} {} {} {about} {symbol} {paper}", row.path(), row.group.title(), super::rows::name(row));
    let text = text.to_lowercase();
    search.to_lowercase().split_whitespace().all(|word| text.contains(word))
}

impl Panel {
    pub(super) fn groups(&mut self, ui: &mut Ui, document: &mut Document) {
        self.choose_scope(ui, document);
        for group in Group::ALL {
            let rows: Vec<&Parameter> = parameters().iter().filter(|row| row.group == group).collect();
            let found: Vec<&Parameter> = rows.into_iter().filter(|row| matches(row, &self.search)).collect();
            if found.is_empty() {
                continue;
            }
            let changed = found.iter().any(|row| self.differs(document, row));
            let title =
                RichText::new(format!("{}{}", group.title(), if changed { " •" } else { "" })).strong();
            let header =
                CollapsingHeader::new(title).id_salt(group.title()).default_open(OPEN.contains(&group));
            let searched = (!self.search.trim().is_empty()).then_some(true);
            header.open(searched).show(ui, |ui| self.group(ui, document, group, &found));
        }
    }

    fn group(&mut self, ui: &mut Ui, document: &mut Document, group: Group, found: &[&Parameter]) {
        match group {
            Group::Light => self.lights(ui, document, found),
            Group::Fabric => self.fabrics(ui, document, found),
            _ => found.iter().for_each(|found| self.row(ui, document, found, &self.path_of(found))),
        }
    }

    fn row(&mut self, ui: &mut Ui, document: &mut Document, parameter: &Parameter, path: &str) {
        self.rejection_shown |= row(ui, document, parameter, path);
    }

    /// The path that a row of yarn or fiber edits.
    fn path_of(&self, row: &Parameter) -> String {
        match (self.scope.flatten(), row.group) {
            (Some(index), Group::Yarn | Group::Fiber) => format!("fabric.{index}.{}", row.path()),
            _ => row.path(),
        }
    }

    fn differs(&self, document: &Document, row: &Parameter) -> bool {
        let count = match row.table {
            "light" => document.light_count(),
            "fabric" => document.scene_file().fabric.len(),
            _ => return !document.is_default(&self.path_of(row)),
        };
        let one = |index: usize| !document.is_default(&format!("{}.{index}.{}", row.table, row.key));
        row.key != "model" && (0..count).any(one)
    }

    /// Which fabric's yarn and fiber are edited, where that makes a difference.
    fn choose_scope(&mut self, ui: &mut Ui, document: &Document) {
        let fabrics = &document.scene_file().fabric;
        let own = |index: usize| !(fabrics[index].yarn.is_empty() && fabrics[index].fiber.is_empty());
        let any_own = (0..fabrics.len()).any(own);
        if self.scope.flatten().is_some_and(|index| index >= fabrics.len()) {
            self.scope = None;
        }
        // What the scene says reaches no fabric that says it itself.
        let scope = self.scope.get_or_insert_with(|| (fabrics.len() == 1 && any_own).then_some(0));
        if fabrics.len() < 2 && !any_own {
            *scope = None;
            return;
        }
        let name = |scope: &Option<usize>| match scope {
            None => "of all fabrics".to_owned(),
            Some(index) => format!("of fabric {}: {}", index + 1, fabrics[*index].model),
        };
        ui.horizontal(|ui| {
            ui.label("Yarn and fiber");
            ComboBox::from_id_salt("scope").selected_text(name(scope)).width(200.0).truncate().show_ui(
                ui,
                |ui| {
                    for choice in std::iter::once(None).chain((0..fabrics.len()).map(Some)) {
                        let text = name(&choice);
                        ui.selectable_value(scope, choice, text);
                    }
                },
            );
        });
    }

    fn lights(&mut self, ui: &mut Ui, document: &mut Document, found: &[&Parameter]) {
        let mut removed = None;
        for index in 0..document.light_count() {
            let path = |key: &str| format!("light.{index}.{key}");
            let kind = document.get(&path("kind"));
            let kind = kind.as_ref().and_then(toml::Value::as_str).unwrap_or_default();
            let title = format!("Light {}: {kind}", index + 1);
            CollapsingHeader::new(title).id_salt(("light", index)).default_open(true).show(ui, |ui| {
                for row in found {
                    // Other kinds have other keys.
                    if document.get(&path(row.key)).is_some() {
                        self.row(ui, document, row, &path(row.key));
                    }
                }
                if ui.small_button(format!("Remove light {}", index + 1)).clicked() {
                    removed = Some(index);
                }
            });
        }
        // Errors are shown at the panel's head.
        let mut outcome = removed.map(|index| document.remove_light(index));
        ui.horizontal(|ui| {
            ui.label("Add light:");
            for kind in kinds() {
                if ui.small_button(*kind).clicked() {
                    outcome = Some(document.add_light(kind));
                }
            }
        });
        drop(outcome);
    }

    fn fabrics(&mut self, ui: &mut Ui, document: &mut Document, found: &[&Parameter]) {
        for row in found.iter().filter(|row| row.table.is_empty()) {
            self.row(ui, document, row, &row.path());
        }
        let count = document.scene_file().fabric.len();
        for index in 0..count {
            if count > 1 {
                ui.label(format!("Fabric {}", index + 1));
            }
            for row in found.iter().filter(|row| row.table == "fabric") {
                self.row(ui, document, row, &format!("fabric.{index}.{}", row.key));
            }
        }
    }
}

/// The kinds of light, as the scene file names them.
fn kinds() -> &'static [&'static str] {
    let kind = of_table("light").find(|row| row.key == "kind").map(|row| row.kind);
    match kind {
        Some(crate::scene::parameters::Kind::Name(names)) => names,
        _ => &[],
    }
}
