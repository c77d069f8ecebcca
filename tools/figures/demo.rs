//! The README's picture.

use crate::sheet::Sheet;
use crate::stage::shoot;
use std::path::Path;
use std::sync::Arc;
use worsted::error::Error;
use worsted::scene::Scene;
use worsted::vulkan::Device;

const SIZE: [u32; 2] = [1024, 768];

/// Draws `docs/figures/demo.png` from `models/demo.toml`.
///
/// # Errors
/// Those of the scene, the device and the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/demo.toml");
    let picture = shoot(device, Scene::load(&path, &[])?, SIZE, 16)?;
    let mut sheet = Sheet::new(SIZE[0], SIZE[1], [0; 3]);
    sheet.place(&picture, 0, 0);
    sheet.save("demo")
}
