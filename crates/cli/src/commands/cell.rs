//! `seamline cell`: cell files.

use std::io::Write as _;

use clap::builder::PossibleValuesParser;
use seamline_cell::cell::BUILT_IN_CELLS;

/// Print a built-in cell as TOML.
///
/// The default cell has every key there is. A cell file of your own gives only what differs from it, as the other built-in
/// cells do.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  seamline cell --print > cell.toml")]
pub(crate) struct Arguments {
    /// Print the cell.
    #[arg(long, required = true)]
    print: bool,
    /// Which one.
    #[arg(default_value = "default", value_parser = PossibleValuesParser::new(BUILT_IN_CELLS.map(|(name, _)| name)))]
    name: String,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let chosen = BUILT_IN_CELLS.iter().find(|(name, _)| *name == arguments.name);
    let text = chosen.map_or("", |(_, text)| text);
    Ok(std::io::stdout().write_all(text.as_bytes())?)
}
