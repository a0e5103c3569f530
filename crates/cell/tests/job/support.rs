//! Jobs to test with, and a world for them.

use std::collections::BTreeMap;

use seamline_cell::job::{
    Action, ArcCondition, Coordinates, Frame, Interpreter, JobError, JobFile, JobPosition, JobSet,
    LinearSpeedUnit, Rectangular, SignalKind, Step, World,
};

/// Twelve steps, three position variables, all kinds of locals.
const HEADER: &str = "/JOB
//NAME TEST
//POS
///NPOS 12,0,1,3,0,0
///TOOL 1
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=900.000,0.000,100.000,180.0000,0.0000,0.0000
C00001=1000.000,0.000,100.000,180.0000,0.0000,0.0000
C00002=1100.000,100.000,100.000,180.0000,0.0000,0.0000
C00003=1200.000,0.000,100.000,180.0000,0.0000,0.0000
C00004=1300.000,-100.000,100.000,180.0000,0.0000,0.0000
C00005=1400.000,0.000,100.000,180.0000,0.0000,0.0000
C00006=1400.000,0.000,100.000,180.0000,0.0000,0.0000
C00007=1500.000,100.000,100.000,180.0000,0.0000,0.0000
C00008=1600.000,0.000,100.000,180.0000,0.0000,0.0000
C00009=1000.000,0.000,300.000,180.0000,0.0000,0.0000
C00010=1000.000,0.000,300.000,180.0000,0.0000,0.0000
C00011=1000.000,0.000,300.000,180.0000,0.0000,0.0000
P00001=1000.000,-20.000,300.500,180.0000,-5.2500,0.0000
P00100=10.000,0.000,5.000,0.0000,0.0000,0.0000
///POSTYPE PULSE
///PULSE
EC00000=1000,-2000
P00002=1000,2000,3000,-4000,5000,6000
//INST
///DATE 2026/01/02 10:00
///ATTR SC,RW
///GROUP1 RB1
///LVARS 4,4,4,4,4,4,0,0
NOP
";

/// The line of the first instruction of a [`job`].
pub(crate) const FIRST_LINE: u32 = 33;

/// A job with this program, LF.
pub(crate) fn job(program: &str) -> String {
    format!("{HEADER}{program}\nEND\n")
}

/// The file of a [`job`].
pub(crate) fn file(program: &str) -> JobFile {
    JobFile::parse("t.JBI", job(program).as_bytes()).unwrap_or_else(|e| panic!("{e}\n{program}"))
}

/// A job of this name without positions.
pub(crate) fn other(name: &str, program: &str) -> JobFile {
    let text = format!("/JOB\n//NAME {name}\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\nNOP\n{program}\nEND\n");
    JobFile::parse(&format!("{name}.JBI"), text.as_bytes()).unwrap_or_else(|e| panic!("{e}"))
}

/// Inputs that the test sets, and a robot at a fixed place.
#[derive(Debug, Default)]
pub(crate) struct TestWorld {
    pub(crate) inputs: BTreeMap<(SignalKind, u32), u32>,
    /// Speed of every arc condition.
    pub(crate) arc_speed_mm_s: Option<f64>,
}

impl World for TestWorld {
    fn input(&mut self, kind: SignalKind, number: u32) -> u32 {
        self.inputs.get(&(kind, number)).copied().unwrap_or(0)
    }

    fn current_position(&mut self) -> Option<JobPosition> {
        Some(JobPosition { coordinates: Coordinates::Pulses(vec![1, 2, 3, 4, 5, 6]), tool: 1 })
    }

    fn convert(&mut self, position: &JobPosition, frame: Frame, tool: u32) -> Option<JobPosition> {
        let rectangular = Rectangular {
            position_mm: [1000.0, 200.0, -300.0],
            rotation_deg: [180.0, 0.0, 12.5],
            elbow_deg: None,
            frame,
            configuration: Default::default(),
        };
        let _ = position;
        Some(JobPosition { coordinates: Coordinates::Rectangular(rectangular), tool })
    }

    fn arc_speed_mm_s(&mut self, _: &ArcCondition) -> Option<f64> {
        self.arc_speed_mm_s
    }
}

/// All steps of a set of files, at most `limit`, and the error that ended it.
pub(crate) fn steps(
    files: Vec<JobFile>,
    world: &mut TestWorld,
    limit: usize,
) -> (Vec<Step>, Option<JobError>) {
    let set = JobSet::from_files(files).unwrap_or_else(|e| panic!("{e}"));
    let mut interpreter = Interpreter::new(&set, LinearSpeedUnit::default());
    let mut steps = Vec::new();
    while steps.len() < limit {
        match interpreter.next(world) {
            Ok(Some(step)) => steps.push(step),
            Ok(None) => return (steps, None),
            Err(error) => return (steps, Some(error)),
        }
    }
    (steps, None)
}

/// All actions of a program that runs to its end.
pub(crate) fn actions(program: &str) -> Vec<Action> {
    let (steps, error) = steps(vec![file(program)], &mut TestWorld::default(), 1000);
    assert_eq!(error, None, "{program}");
    steps.into_iter().map(|step| step.action).collect()
}

/// The messages of a program: what it says about its variables.
pub(crate) fn messages(program: &str) -> Vec<String> {
    actions(program)
        .into_iter()
        .filter_map(|action| match action {
            Action::Message { text } => Some(text),
            _ => None,
        })
        .collect()
}

/// The error that ends a program.
pub(crate) fn failure(program: &str) -> String {
    let (_, error) = steps(vec![file(program)], &mut TestWorld::default(), 1000);
    error.map_or_else(|| "no error".to_owned(), |e| e.to_string())
}
