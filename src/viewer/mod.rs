//! `worsted view`: a window in which yarn and light are edited and the cloth is seen to change.
//!
//! Two threads. The window's ([`app`]) hears the user, shows the panel and presents the last picture there is; it never waits
//! for cloth to be drawn. The painter's ([`painter`]) always draws what was wanted last: small while something moves, then
//! whole, then with more and more samples.

pub mod pace;
pub mod painter;
pub mod showing;
mod work;
