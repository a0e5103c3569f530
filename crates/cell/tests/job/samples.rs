//! The jobs in `examples/jobs`, and jobs that lie together in a folder.

use std::fs;
use std::path::{Path, PathBuf};

use seamline_cell::job::{
    Action, ArcPart, Disposition, Interpreter, JobFile, JobSet, LinearSpeedUnit, LoadError, MovePath, Zone,
    disposition,
};

use crate::support::TestWorld;

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/jobs")
}

/// All actions of a set, run to its end.
fn run(set: &JobSet) -> Vec<Action> {
    let mut interpreter = Interpreter::new(set, LinearSpeedUnit::default());
    let mut world = TestWorld::default();
    let mut actions = Vec::new();
    while actions.len() < 1000 {
        match interpreter.next(&mut world) {
            Ok(Some(step)) => actions.push(step.action),
            Ok(None) => break,
            Err(error) => panic!("{error}"),
        }
    }
    actions
}

#[test]
fn the_example_jobs_run_whole() {
    for (name, arcs, moves) in [("fillet.JBI", 1, 10), ("pulses.JBI", 0, 6), ("near_wrist.JBI", 0, 5)] {
        let path = examples().join(name);
        let bytes = fs::read(&path).unwrap();
        let file = JobFile::parse(name, &bytes).unwrap_or_else(|e| panic!("{e}"));
        // Ours are written as controllers require it.
        assert_eq!(file.to_crlf(), bytes);
        let set = JobSet::load(&path).unwrap();
        for statement in &set.entry().program {
            let fate = disposition(&statement.instruction);
            assert!(!matches!(fate, Disposition::Refused(_)), "{name}: {}", statement.text);
        }
        let actions = run(&set);
        assert_eq!(actions.last(), Some(&Action::End));
        let motions: Vec<_> = actions
            .iter()
            .filter_map(|action| match action {
                Action::Move(motion) => Some(motion),
                _ => None,
            })
            .collect();
        assert_eq!(motions.len(), moves, "{name}");
        assert!(motions.iter().all(|m| m.zone == Zone::Exact));
        let whole = |path: &MovePath| matches!(path, MovePath::Circular(arc) if arc.part == ArcPart::Whole);
        assert_eq!(motions.iter().filter(|m| whole(&m.path)).count(), arcs, "{name}");
    }
}

fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    for (file, text) in files {
        fs::write(folder.join(file), text).unwrap();
    }
    folder
}

fn text(name: &str, program: &str) -> String {
    format!("/JOB\r\n//NAME {name}\r\n//INST\r\nNOP\r\n{program}\r\nEND\r\n")
}

#[test]
fn called_jobs_come_from_the_same_folder() {
    let folder = folder(
        "called",
        &[
            ("main.JBI", &text("MAIN", "CALL JOB:FIRST")),
            // Found by its name inside, not by the file's.
            ("other.jbi", &text("FIRST", "CALL JOB:SECOND\r\nMSG \"one\"")),
            ("SECOND.JBI", &text("SECOND", "MSG \"two\"")),
            // Wrong, and not needed.
            ("broken.JBI", &text("THIRD", "MOVL V=")),
            ("lost.JBI", &text("LOST", "CALL JOB:FIRTS")),
        ],
    );
    let set = JobSet::load(&folder.join("main.JBI")).unwrap();
    let names: Vec<&str> = set.jobs().map(|job| &*job.name).collect();
    assert_eq!(names, ["MAIN", "FIRST", "SECOND"]);
    let message = |text: &str| Action::Message { text: text.into() };
    assert_eq!(run(&set), [message("two"), message("one"), Action::End]);

    // The nearest name in the folder is offered; a file that cannot be read is named.
    let lost = JobSet::load(&folder.join("lost.JBI")).unwrap_err().to_string();
    assert!(lost.ends_with("lost.JBI:5:10: there is no job `FIRTS`; did you mean `FIRST`?"), "{lost}");
    let error = JobSet::load(&folder.join("none.JBI")).unwrap_err();
    assert!(matches!(error, LoadError::Read { .. }));
    assert!(error.to_string().starts_with("cannot read "), "{error}");
}
