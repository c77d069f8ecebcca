//! `worsted view`: a window in which yarn and light are edited and the cloth is seen to change.

pub mod changes;
pub mod document;
mod edit;
pub mod history;
mod lights;
mod lines;
pub mod orbit;
pub mod pace;
pub mod painter;
pub mod panel;
pub mod recent;
mod save;
pub mod showing;
mod work;
