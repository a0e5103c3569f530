//! The program `seamline`: welding jobs in a simulated cell, and the parts of the motion library one by one.
//!
//! Exit status: 0 done, 1 failed (one message on stderr), 2 wrong usage.

mod commands;
mod json_lines;
mod plot;
mod report;
mod robot;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Motion control for welding robots.
#[derive(Debug, Parser)]
#[command(name = "seamline", version, about, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(commands::run::Arguments),
    Check(commands::check::Arguments),
    Cell(commands::cell::Arguments),
    Fk(commands::fk::Arguments),
    Ik(commands::ik::Arguments),
    Otg(commands::otg::Arguments),
    Profile(commands::profile::Arguments),
    Shaper(commands::shaper::Arguments),
    Identify(commands::identify::Arguments),
    Corner(commands::corner::Arguments),
    Experiment(commands::experiment::Arguments),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Check(arguments) => commands::check::run(&arguments),
        Command::Cell(arguments) => commands::cell::run(&arguments),
        Command::Fk(arguments) => commands::fk::run(&arguments),
        Command::Ik(arguments) => commands::ik::run(&arguments),
        Command::Otg(arguments) => commands::otg::run(&arguments),
        Command::Profile(arguments) => commands::profile::run(&arguments),
        Command::Shaper(arguments) => commands::shaper::run(&arguments),
        Command::Identify(arguments) => commands::identify::run(&arguments),
        Command::Corner(arguments) => commands::corner::run(&arguments),
        Command::Experiment(arguments) => commands::experiment::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            report(&error);
            ExitCode::FAILURE
        }
    }
}

#[expect(clippy::print_stderr, reason = "the one place where a failure becomes a message")]
fn report(error: &anyhow::Error) {
    eprintln!("seamline: {error:#}");
}
