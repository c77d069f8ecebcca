//! `worsted view`: a window in which yarn and light are edited and the cloth is seen to change.
//!
//! Two threads. The window's ([`app`]) hears the user, shows the panel and presents the last picture there is; it never waits
//! for cloth to be drawn. The painter's ([`painter`]) always draws what was wanted last: small while something moves, then
//! whole, then with more and more samples.
//!
//! What is edited is a [`document::Document`]: the scene's text. What is looked at, and how, is a [`desk::Desk`].

pub mod app;
mod canvas;
pub mod changes;
mod comparing;
pub mod desk;
pub mod document;
mod draft;
mod edit;
mod filing;
mod gui;
pub mod history;
mod lights;
mod lines;
mod live;
pub mod orbit;
pub mod pace;
pub mod painter;
pub mod panel;
mod playing;
pub mod recent;
pub mod references;
#[cfg(feature = "hot-reload")]
mod reload;
mod save;
pub mod scripts;
pub mod showing;
mod stages;
mod toolbar;
mod tried;
mod work;
