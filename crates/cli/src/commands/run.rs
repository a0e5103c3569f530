//! `seamline run`: the main job.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use indicatif::{ProgressBar, ProgressStyle};
use seamline_cell::cell::{FaultKind, ScriptedFault};
use seamline_cell::record::Verdict;
use seamline_cell::run::{Progress, RunOptions, RunReport};

use super::inputs::{CellArguments, Inputs, load};
use crate::report::write_report;

/// Run a job in the simulated cell, cycle by cycle, and report on the motion.
///
/// Writes report.html, recording.csv and summary.json, and prints a summary.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  seamline run examples/jobs/fillet.JBI --override 50 --out out/slow")]
pub(crate) struct Arguments {
    /// The job file: INFORM (.JBI), or G-code (.ngc, .nc, .gcode, .tap).
    job: PathBuf,
    #[command(flatten)]
    cell: CellArguments,
    /// Folder for the results [default: out/JOBNAME].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Run once per period of the clock on the wall, on a real-time thread.
    #[arg(long)]
    realtime: bool,
    /// Speed override in percent: changes time, never the path.
    #[arg(long = "override", value_name = "PCT", default_value_t = 100.0, value_parser = percent)]
    speed_override: f64,
    /// The arc stays out: the job moves as if it burned.
    #[arg(long)]
    dry_run: bool,
    /// Something that goes wrong, as KIND@SECONDS, or KIND@SECONDS:JOINT for what is one joint's; any number of them. Kinds: drive-silent,
    /// drive-alarm, joint-stuck, encoder-jump, encoder-nan, emergency-stop, late-cycles, planner-silent, no-ignition, arc-loss, sensor-silent,
    /// sensor-nan, sensor-jump.
    #[arg(long = "fault", value_name = "KIND@TIME", value_parser = fault)]
    faults: Vec<ScriptedFault>,
}

/// KIND@SECONDS, with :JOINT from 1.
fn fault(text: &str) -> Result<ScriptedFault, String> {
    let expected = || "expected KIND@SECONDS or KIND@SECONDS:JOINT, such as joint-stuck@2.5:3".to_owned();
    let (kind, at) = text.split_once('@').ok_or_else(expected)?;
    let kinds = || FaultKind::ALL.map(|(name, _)| name).join(", ");
    let kind = FaultKind::from_name(kind).ok_or_else(|| format!("expected one of {}", kinds()))?;
    let (time, joint) = at.split_once(':').unwrap_or((at, "1"));
    let time =
        time.parse().ok().filter(|time: &f64| time.is_finite() && *time >= 0.0).ok_or_else(expected)?;
    let joint: usize = joint.parse().ok().filter(|joint| *joint > 0).ok_or_else(expected)?;
    Ok(ScriptedFault { kind, time, joint: joint - 1 })
}

/// Above 0 to 100.
fn percent(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= 100.0 => Ok(value),
        _ => Err("expected a number above 0, at most 100".into()),
    }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let mut inputs = load(&arguments.job, &arguments.cell)?;
    inputs.cell.arc.dry_run |= arguments.dry_run;
    let joints = inputs.cell.robot.joints.len();
    if let Some(fault) = arguments.faults.iter().find(|fault| fault.joint >= joints) {
        bail!("--fault: joint {}: expected 1 to {joints}", fault.joint + 1);
    }
    inputs.cell.simulation.faults.extend(&arguments.faults);
    let out = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.job));
    let options = RunOptions {
        out: out.clone(),
        speed_override: arguments.speed_override / 100.0,
        realtime: arguments.realtime,
    };
    let report = run_with_progress(&inputs, &options)?;
    write_results(&report, &out)?;
    print(&report, &out)?;
    match report.summary.verdict {
        Verdict::Fault => bail!("the run ended with a fault: {}", fault_text(&report)),
        Verdict::Ok | Verdict::OutOfBounds => Ok(()),
    }
}

fn default_folder(job: &Path) -> PathBuf {
    Path::new("out").join(job.file_stem().unwrap_or(job.as_os_str()))
}

/// A bar on a terminal, nothing elsewhere. It is drawn ten times a second; the run does not wait for it.
fn run_with_progress(inputs: &Inputs, options: &RunOptions) -> anyhow::Result<RunReport> {
    const UPDATES: u64 = 64;
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} s of robot time  {msg}") {
        bar.set_style(style);
    }
    let mut calls = 0;
    let progress = |at: Progress| {
        calls += 1;
        if calls % UPDATES == 0 {
            bar.set_length(at.planned.ceil() as u64);
            bar.set_position(at.time as u64);
            bar.set_message(format!("line {}", at.line));
        }
    };
    let report = inputs.arm.run(&inputs.program, &inputs.cell, options, progress)?;
    bar.finish_and_clear();
    Ok(report)
}

fn write_results(report: &RunReport, out: &Path) -> anyhow::Result<()> {
    let summary = out.join("summary.json");
    report.summary.write(&summary).with_context(|| summary.display().to_string())?;
    let page = out.join("report.html");
    let findings = &report.findings;
    write_report(&page, &report.info, &report.summary, &findings.segments, &findings.plot)
        .with_context(|| page.display().to_string())
}

fn print(report: &RunReport, out: &Path) -> anyhow::Result<()> {
    let mut stdout = std::io::stdout().lock();
    for remark in &report.remarks {
        writeln!(stdout, "note: {remark}")?;
    }
    write!(stdout, "{}", report.summary)?;
    writeln!(stdout, "results: {}", out.join("report.html").display())?;
    Ok(())
}

fn fault_text(report: &RunReport) -> String {
    let incident = report.summary.faults.first();
    incident.map_or_else(String::new, |i| format!("{} (at {:.3} s, line {})", i.text, i.time_s, i.line))
}
