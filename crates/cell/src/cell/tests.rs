//! The cell file as a whole: the default, what is laid over it, and a table of mistakes.

use super::*;

#[test]
fn the_default_is_right_and_lies_over_itself() {
    let cell = Cell::default_cell().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(Cell::parse(DEFAULT_CELL_TOML, "copy.toml"), Ok(cell.clone()));
    assert_eq!(cell.robot.joints.len(), 6);
}
