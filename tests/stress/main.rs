//! `worsted::stress`: the short run holds, and the published forms in place of the stable ones do not.

#[path = "../support/device.rs"]
mod device;
#[path = "../../src/shaders/glsl.rs"]
mod glsl;
mod stable_forms;

use worsted::stress::{report, stress};
use worsted::vulkan::DeviceChoice;

/// Groups that the issue of extremes lists.
const GROUPS: [&str; 7] =
    ["scattering", "geometry", "level of detail", "tables", "frames", "exposure", "pictures"];

#[test]
fn the_short_run_holds() {
    let device = device::shared(DeviceChoice::Auto);
    let found = stress(device, true, &|share| assert!((0.0..1.0).contains(&share))).unwrap();
    device.check_validation().unwrap();
    let table = report::markdown(&found);
    let bad: Vec<_> = found.rows.iter().filter(|row| !row.holds()).collect();
    assert!(bad.is_empty() && found.holds(), "{bad:#?}");
    for group in GROUPS {
        let rows: Vec<_> = found.rows.iter().filter(|row| row.group == group).collect();
        assert!(!rows.is_empty() && rows.iter().all(|row| row.found.points > 0), "{group}");
        assert!(table.to_lowercase().contains(&format!("### {group}")), "{table}");
    }
    // Every parameter of every function was tried past its ends.
    let alone = found.rows.iter().filter(|row| row.found.refused >= 5).count();
    assert!(alone > 60, "{alone} parameters refuse what is past their ends");
    println!("{} rows in {:.0} s", found.rows.len(), found.seconds);
}
