//! `worsted stress` as a user calls it; what it finds is tested in process.

use super::process::{Workplace, assert_one_line_error};

#[test]
fn places_that_cannot_be_written_are_refused_before_anything_is_tried() {
    let place = Workplace::new();
    for option in ["--table", "--json"] {
        let arguments = ["stress", "--quick", option, "no/such/folder/table"];
        assert_one_line_error(&place.run_on(&arguments, ""), 2, &["no/such/folder"]);
    }
    assert_one_line_error(&place.run_on(&["stress", "--quicker"], ""), 2, &["--quicker"]);
}
