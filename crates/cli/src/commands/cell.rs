//! `seamline cell`: cell files.

use std::io::Write as _;

use seamline_cell::cell::DEFAULT_CELL_TOML;

/// Print the embedded default cell as TOML.
///
/// A cell file of your own gives only what differs from it.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  seamline cell --print > cell.toml")]
pub(crate) struct Arguments {
    /// Print the default cell.
    #[arg(long, required = true)]
    print: bool,
}

pub(crate) fn run(_: &Arguments) -> anyhow::Result<()> {
    Ok(std::io::stdout().write_all(DEFAULT_CELL_TOML.as_bytes())?)
}
