//! `seamline otg`: the trajectory generator by itself.

mod answer;
mod axes;
mod request;

use std::path::PathBuf;

use crate::json_lines::bench::read_all;
use crate::json_lines::{answer_each, print_line};

const HELP: &str = "\
Each line is one question of 1 to 16 axes:
  {\"id\": any, \"control\": C, \"synchronization\": S, \"current\": STATE, \"target\": STATE,
   \"limits\": {\"velocity_max\": [..], \"velocity_min\": [..], \"acceleration_max\": [..],
   \"acceleration_min\": [..], \"jerk_max\": [..], \"position_max\": [..], \"position_min\": [..]},
   \"enabled\": B, \"target_moves\": B, \"duration_min\": s, \"duration_step\": s, \"sample\": [0..1, ..],
   \"profiles\": true}
C      \"position\" (default) or \"velocity\", for all axes or as a list
S      \"none\", \"time\" (default), \"time_if_necessary\", \"phase\" or \"phase_strict\", likewise
B      true or false, likewise: axes that are not enabled (default true) go on as they are; a target that
       moves (default false) goes on at its velocity from now on, and is met where it will be
STATE  {\"position\": [..], \"velocity\": [..], \"acceleration\": [..]}; what is missing is 0, except
       positions; a target position does not matter in velocity control
A limit that is null or missing is infinite, a minimum that is missing the negated maximum. A motion
that would leave the position limits has no answer: the error says where and when. The duration is at
least duration_min, and a whole number of duration_step.
Any unit of length or angle; seconds.

The answer, on one line:
  {\"id\", \"ok\": true, \"duration\", \"duration_min_per_axis\": [..], \"synchronized\": [..],
   \"samples\": [{\"time\", \"position\": [..], \"velocity\": [..], \"acceleration\": [..]}, ..]}
\"sample\" asks for samples at fractions of the duration. \"profiles\" asks for each axis's pieces from
the current state on, {\"duration\", \"jerk\"}; without jerk limit {\"duration\", \"acceleration\"}, without
acceleration limit {\"duration\", \"velocity\"}. A question without answer gets
  {\"id\", \"ok\": false, \"error\": \"..\"}
and the next one its turn.

Example:
  echo '{\"id\": 1, \"current\": {\"position\": [0]}, \"target\": {\"position\": [1]}, \"sample\": [0.5, 1],
    \"limits\": {\"velocity_max\": [1], \"acceleration_max\": [2]}}' | tr -d '\\n' | seamline otg";

/// Calculate time-optimal, jerk-limited trajectories: JSON lines in, JSON lines out.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Questions; the standard input if there is no file.
    file: Option<PathBuf>,
    /// Measure the bare calculation: prints {"cases", "dofs", "mean_ns", "p99_ns", "max_ns"}.
    ///
    /// Reads all questions first, then calculates them all nine times over. What counts for each is the least of its
    /// nine readings, less the time of reading the clock. One line for each number of axes.
    #[arg(long)]
    bench: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let input = arguments.file.as_deref();
    let mut generators = axes::all();
    if !arguments.bench {
        return answer_each(input, |line| generators[request::axes(line)? - 1].answer(line));
    }
    read_all(input, |line| generators[request::axes(line)? - 1].keep(line))?;
    for measured in generators.iter_mut().filter_map(|generator| generator.measure()) {
        print_line(&measured)?;
    }
    Ok(())
}
