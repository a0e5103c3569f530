//! G-code parts of many short lines, made by formula: checked, run and timed.
//!
//! ```sh
//! cargo run --release -p seamline-cell --example parts -- 20000 examples/cells/plate.toml
//! cargo run --release -p seamline-cell --example parts -- 20000 scara
//! ```
#![expect(clippy::print_stdout, reason = "the program's whole purpose")]

#[path = "../tests/common/parts.rs"]
mod parts;

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Instant;

use parts::{Part, distances, parts, places};
use seamline_cell::cell::Cell;
use seamline_cell::gcode;
use seamline_cell::plan::CellArm;
use seamline_cell::run::{Program, RunOptions};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let segments = arguments.next().map_or(Ok(20_000), |text| text.parse())?;
    let source = arguments.next().unwrap_or_else(|| "scara".into());
    let cell = match Cell::built_in(&source) {
        Some(cell) => cell?,
        None => Cell::load(Path::new(&source))?,
    };
    let arm = CellArm::from_cell(&cell)?;
    let out = std::env::temp_dir().join(format!("seamline-parts-{}", std::process::id()));
    println!(
        "{:10} {:>8} {:>8} {:>8} {:>7} {:>8} {:>8} {:>9} {:>9} {:>7} {:>7} {:>7}",
        "part", "lines", "s", "feed %", "read s", "check x", "all x", "off µm", "of µm", "v", "a", "j"
    );
    for part in parts(segments) {
        measure(&part, &cell, &arm, &out)?;
    }
    fs::remove_dir_all(&out)?;
    Ok(())
}

fn measure(part: &Part, cell: &Cell, arm: &CellArm, out: &Path) -> Result<(), Box<dyn Error>> {
    let begun = Instant::now();
    let program: Program = gcode::Program::parse(part.name, part.text.clone().into_bytes())?.into();
    let read = begun.elapsed().as_secs_f64();
    let report = arm.check(&program, cell)?;
    let checked = begun.elapsed().as_secs_f64() - read;
    if !report.errors.is_empty() {
        println!("{}: {} problems, first: {}", part.name, report.errors.len(), report.errors[0]);
        return Ok(());
    }
    if std::env::var_os("FINDINGS").is_some() {
        report.findings.iter().take(8).for_each(|finding| println!("  {}: {}", finding.at, finding.text));
        println!("  {} findings", report.findings.len());
    }
    let begun = Instant::now();
    let options = RunOptions { out: out.to_owned(), speed_override: 1.0, realtime: false };
    let run = arm.run(&program, cell, &options, |_| {})?;
    let whole = begun.elapsed().as_secs_f64() + read;
    let duration = run.findings.duration;
    let peak = |of: fn(&seamline_cell::record::JointFigures) -> f64| {
        run.findings.joints.iter().map(of).fold(0.0, f64::max)
    };
    let work = cell.user_frame(1).ok_or("no user frame 1")?.base_from_user;
    let recording = fs::read_to_string(out.join("recording.csv"))?;
    let [off, missed] = distances(&part.way, &places(&recording, &work));
    println!(
        "{:10} {:>8} {:>8.1} {:>8.1} {:>7.3} {:>8.1} {:>8.1} {:>9.2} {:>9.2} {:>7.3} {:>7.3} {:>7.3}",
        part.name,
        part.segments,
        duration,
        100.0 * part.nominal_seconds / duration,
        read,
        duration / checked,
        duration / whole,
        1000.0 * off.max(missed),
        1000.0 * part.tolerance,
        peak(|joint| joint.velocity.fraction),
        peak(|joint| joint.acceleration.fraction),
        peak(|joint| joint.jerk.fraction),
    );
    Ok(())
}
