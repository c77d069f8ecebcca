//! `worsted view`: what a window edits, and how.

pub mod changes;
pub mod document;
mod edit;
pub mod history;
mod lights;
mod lines;
pub mod panel;
pub mod recent;
mod save;
