//! Programs that run.

use seamline_cell::job::{
    Action, ArcPart, Condition, Coordinates, Frame, JobFile, Location, MAX_CALLS, MAX_IDLE, Move, MovePath,
    Note, Output, PositionKind, PositionName, SignalKind, Speed, SpeedOrigin, Step, WeaveCondition, Zone,
};

use crate::support::{TestWorld, actions, failure, file, messages, other, steps};

/// Values that a program shows with AOUT, which counts 0.01 V.
fn values(program: &str) -> Vec<f64> {
    actions(program)
        .into_iter()
        .filter_map(|action| match action {
            Action::Output(Output::Analog { volts, .. }) => Some((volts * 100.0).round()),
            _ => None,
        })
        .collect()
}

/// The moves of a program with the line of each.
fn moves(program: &str) -> Vec<(u32, Move, Vec<Note>)> {
    let (steps, error) = steps(vec![file(program)], &mut TestWorld::default(), 1000);
    assert_eq!(error, None, "{program}");
    let of = |step: Step| match step.action {
        Action::Move(motion) => Some((step.at.line, *motion, step.notes)),
        _ => None,
    };
    steps.into_iter().filter_map(of).collect()
}

#[test]
fn variables_compute_within_their_ranges() {
    let cases: &[(&str, &[f64])] = &[
        ("SET B000 5\nADD B000 7\nMUL B000 3\nDIV B000 5\nSUB B000 1\nAOUT AO#(1) B000", &[6.0]),
        ("SET I000 -7\nDIV I000 2\nAOUT AO#(1) I000", &[-3.0]),
        ("SET LI000 6\nSET LI000 EXPRESS LI000 / 0.6\nAOUT AO#(1) LI000", &[10.0]),
        ("SET R000 0.3\nSET I000 EXPRESS R000 / 0.1\nAOUT AO#(1) I000", &[3.0]),
        (
            "SET B001 2\nSET B002 7\nSET B003 3\nSET B000 (B001 + B002) / B003 * -2 + 10\nAOUT AO#(1) B000",
            &[4.0],
        ),
        ("SET I000 2+3*4-10/5\nAOUT AO#(1) I000", &[12.0]),
        (
            "SET D000 100000\nDIV D000 1000\nINC D000\nAOUT AO#(1) D000\nDEC D000\nAOUT AO#(1) D000",
            &[101.0, 100.0],
        ),
        ("SET R000 2\nSQRT R001 R000\nMUL R001 100\nSET I000 R001\nAOUT AO#(1) I000", &[141.0]),
        ("SIN R000 30\nMUL R000 1000\nSET I000 R000\nAOUT AO#(1) I000", &[500.0]),
        ("COS R000 60\nMUL R000 1000\nSET I000 R000\nAOUT AO#(1) I000", &[500.0]),
        ("ATAN R000 1\nSET I000 R000\nAOUT AO#(1) I000", &[45.0]),
        (
            "SET B000 12\nAND B000 10\nAOUT AO#(1) B000\nOR B000 3\nAOUT AO#(1) B000\nXOR B000 1\nAOUT AO#(1) B000\nNOT B000 B000\nAOUT AO#(1) B000",
            &[8.0, 11.0, 10.0, 245.0],
        ),
        (
            "SET B005 1\nSET B006 2\nSET B007 3\nCLEAR B005 2\nAOUT AO#(1) B005\nAOUT AO#(1) B006\nAOUT AO#(1) B007\nCLEAR B000 ALL\nAOUT AO#(1) B007",
            &[0.0, 0.0, 3.0, 0.0],
        ),
        ("SET B000 3\nSET B[B000] 9\nSET B[B000+1] 8\nAOUT AO#(1) B003\nAOUT AO#(1) B[2*2]", &[9.0, 8.0]),
        ("SET B000 ON\nAOUT AO#(1) B000", &[1.0]),
        // Position elements: 0.001 mm, 0.0001 degrees, pulses.
        ("GETE D000 P001 (3)\nSUB D000 300000\nAOUT AO#(1) D000", &[500.0]),
        ("GETE D000 P001 (5)\nDIV D000 100\nAOUT AO#(1) D000", &[-525.0]),
        ("GETE D000 P002 (4)\nDIV D000 10\nAOUT AO#(1) D000", &[-400.0]),
        (
            "SET LP000 P001\nSETE LP000 (3) 1234\nGETE D000 LP000 (3)\nAOUT AO#(1) D000\nGETE D000 P001 (3)\nSUB D000 300000\nAOUT AO#(1) D000",
            &[1234.0, 500.0],
        ),
        ("SET P000 P001\nADD P000 P100\nGETE D000 P000 (1)\nSUB D000 1009000\nAOUT AO#(1) D000", &[1000.0]),
        ("SET P000 P100\nSUB P000 P100\nGETE D000 P000 (1)\nAOUT AO#(1) D000", &[0.0]),
        ("SET P000 P100\nMUL P000 (1) 0.1\nADD P000 (1) 5\nGETE D000 P000 (1)\nAOUT AO#(1) D000", &[1005.0]),
        ("GETS PX003 $PX000\nGETE D000 P003 (6)\nAOUT AO#(1) D000", &[6.0]),
        ("GETS P003 $PX001\nGETE D000 P003 (2)\nDIV D000 1000\nAOUT AO#(1) D000", &[200.0]),
        ("CNVRT P003 P002 UF#(3)\nGETE D000 P003 (3)\nDIV D000 1000\nAOUT AO#(1) D000", &[-300.0]),
    ];
    for (program, expected) in cases {
        assert_eq!(values(program), *expected, "{program}");
    }
}

#[test]
fn values_outside_their_range_and_impossible_operations_end_the_run() {
    let cases = [
        ("SET B000 250\nADD B000 10", "34:5: the value of a B variable is 260, expected 0 to 255"),
        ("DEC B000", "33:5: the value of a B variable is -1, expected 0 to 255"),
        ("SET I000 32767\nINC I000", "34:5: the value of an I variable is 32768, expected -32768 to 32767"),
        (
            "SET D000 2147483647\nADD D000 1",
            "34:5: the value of a D variable is 2147483648, expected -2147483648 to 2147483647",
        ),
        ("DIV I000 B001", "33:10: division by zero"),
        ("SET I000 1/(B000+B001)", "33:13: division by zero"),
        ("SET R000 -1\nSQRT R001 R000", "34:11: square root of -1, expected a number that is not negative"),
        ("MOVJ P055 VJ=10.00", "33:6: position variable P055 was never set"),
        ("GETE D000 P002 (7)", "33:17: the element is 7, expected 1 to 6"),
        (
            "SET P000 P001\nADD P000 P002",
            "34:10: P002 holds a position in pulses, expected a rectangular position",
        ),
        ("SET I000 -1\nSET B[I000] 1", "34:7: the number is -1, expected 0 to 99999"),
        (
            "MOVL C00001 PL=0",
            "33:1: MOVL has no speed, and no SPEED instruction, arc condition or earlier move supplies one",
        ),
        ("MOVL C00001 V=I000 PL=0", "33:15: V is 0, expected 0.01 to 10000"),
        ("SET B000 9\nMOVL C00001 V=1.0 PL=B000", "34:22: PL is 9, expected 0 to 8"),
        ("GETARG LB000 IARG#(1)", "33:20: the call passes 0 arguments, but the job reads argument 1"),
        ("GETS B000 $RV", "33:6: $RV is empty: the last call returned no value"),
        ("GETS B000 $PX000", "33:6: B000 holds no position, expected a position in pulses"),
        ("FOR I000=1 TO 3 STEP=B000\nNEXT I000", "33:22: found a step of 0, expected a step that counts"),
        ("*A\nJUMP *A", "34:1: 100000 instructions ran without one that takes time: an endless loop?"),
        ("CALL JOB:TEST", "33:10: CALL nested more than 32 deep"),
    ];
    for (program, expected) in cases {
        assert_eq!(failure(program), format!("t.JBI:{expected}"), "{program}");
    }
    assert_eq!((MAX_IDLE, MAX_CALLS), (100_000, 32));
}

#[test]
fn a_loop_with_outputs_and_no_time_ends_in_an_error() {
    let program = file("*A\nDOUT OT#(1) ON\nJUMP *A");
    let (steps, error) = steps(vec![program], &mut TestWorld::default(), 200_000);
    assert!(error.is_some_and(|e| e.to_string().contains("an endless loop?")));
    assert_eq!(steps.len(), 33_333);
    let (taken, error) = self::steps_of("*A\nTIMER T=0.01\nJUMP *A", 200_000);
    assert_eq!((taken, error), (200_000, None));
}

fn steps_of(program: &str, limit: usize) -> (usize, Option<String>) {
    let (steps, error) = steps(vec![file(program)], &mut TestWorld::default(), limit);
    (steps.len(), error.map(|e| e.to_string()))
}

#[test]
fn programs_flow_as_written() {
    let cases: &[(&str, &str)] = &[
        ("FOR B000=1 TO 3\nMSG \"A\"\nNEXT B000", "AAA"),
        ("FOR I000=3 TO 1 STEP=-1\nMSG \"A\"\nNEXT I000\nMSG \"B\"", "AAAB"),
        ("FOR I000=5 TO 3\nMSG \"A\"\nNEXT I000\nMSG \"B\"", "B"),
        ("FOR B000=254 TO 255\nMSG \"A\"\nNEXT B000", "AA"),
        ("FOR I000=1 TO 2\nFOR I001=1 TO 2\nMSG \"A\"\nNEXT I001\nMSG \"B\"\nNEXT I000", "AABAAB"),
        ("WHILE B000<3\nINC B000\nMSG \"A\"\nENDWHILE\nMSG \"B\"", "AAAB"),
        ("WHILEEXP B000<1 OREXP B000=1\nINC B000\nMSG \"A\"\nENDWHILE", "AA"),
        (
            "SET B000 2\nIFTHEN B000=1\nMSG \"A\"\nELSEIF B000=2\nMSG \"B\"\nELSE\nMSG \"C\"\nENDIF\nMSG \"D\"",
            "BD",
        ),
        (
            "SET B000 1\nIFTHEN B000=1\nMSG \"A\"\nELSEIF B000=2\nMSG \"B\"\nELSE\nMSG \"C\"\nENDIF\nMSG \"D\"",
            "AD",
        ),
        ("IFTHEN B000=1\nMSG \"A\"\nELSEIF B000=2\nMSG \"B\"\nELSE\nMSG \"C\"\nENDIF\nMSG \"D\"", "CD"),
        ("IFTHEN B000=1\nMSG \"A\"\nENDIF\nMSG \"D\"", "D"),
        ("IFTHEN B000=0\nANDIF B001=1\nORIF B002=0\n'C\nMSG \"A\"\nENDIF", "A"),
        ("IFTHEN B000=0\nANDIF B001=1\nMSG \"A\"\nELSEIF B000=1\nORIF B001=0\nMSG \"B\"\nENDIF", "B"),
        ("IFTHENEXP B000=0 ANDEXP NOT B001=1\nMSG \"A\"\nENDIF", "A"),
        ("IFTHENEXP B000<>0 AND 1/B000>0\nMSG \"A\"\nELSE\nMSG \"B\"\nENDIF", "B"),
        (
            "SET B000 3\nSWITCH B000\nCASE 1\nMSG \"A\"\nCASE 2,3\nMSG \"B\"\nDEFAULT\nMSG \"C\"\nENDSWITCH\nMSG \"D\"",
            "BD",
        ),
        ("SET B000 7\nSWITCH B000\nCASE 1\nMSG \"A\"\nDEFAULT\nMSG \"C\"\nENDSWITCH\nMSG \"D\"", "CD"),
        ("SWITCH B000\nCASE 1\nMSG \"A\"\nENDSWITCH\nMSG \"D\"", "D"),
        ("SET S000 \"x\"\nSWITCH S000\nCASE \"y\"\nMSG \"A\"\nCASE \"x\"\nMSG \"B\"\nENDSWITCH", "B"),
        ("*A\nINC B000\nMSG \"A\"\nJUMP *A IF B000<3\nMSG \"B\"", "AAAB"),
        ("JUMP *A\nMSG \"X\"\n*A\nMSG \"A\"", "A"),
        ("SET S000 \"AB\"\nIFTHEN S000=\"AB\"\nMSG S000\nENDIF", "AB"),
        ("COMM MSG \"X\"\nMSG \"A\"", "A"),
        ("RET IF B000=1\nMSG \"A\"\nRET\nMSG \"X\"", "A"),
        ("MSG \"A\"\nABORT\nMSG \"X\"", "A"),
        ("SETUALM 8001 \"X\" 0 SMODE=1\nMSG \"A\"", "A"),
        ("SETUALM 8001 \"X\" 0\nMSG \"A\"", ""),
    ];
    for (program, expected) in cases {
        assert_eq!(messages(program).concat(), *expected, "{program}");
    }
}

#[test]
fn jobs_call_each_other_with_arguments_and_local_variables() {
    let caller =
        "SET LB000 9\nCALL JOB:SUB ARGF3 ARGF\"text\"\nGETS I000 $RV\nAOUT AO#(1) I000\nAOUT AO#(1) LB000";
    let callee = other(
        "SUB",
        "AOUT AO#(1) LB000\nGETARG LB000 IARG#(1)\nGETARG LS000 IARG#(2)\nMSG LS000\nMUL LB000 2\nRET LB000",
    );
    let (taken, error) = steps(vec![file(caller), callee], &mut TestWorld::default(), 100);
    assert_eq!(error, None);
    let volts = |step: &Step| match &step.action {
        Action::Output(Output::Analog { volts, .. }) => Some((volts * 100.0).round()),
        _ => None,
    };
    // The called job's own local is 0 at first; the caller's keeps its value.
    assert_eq!(taken.iter().filter_map(volts).collect::<Vec<_>>(), [0.0, 6.0, 9.0]);
    let message = taken.iter().find(|s| matches!(s.action, Action::Message { .. })).unwrap();
    assert_eq!(message.at, Location { job: "SUB".into(), line: 10 });
    assert_eq!(message.action, Action::Message { text: "text".into() });

    let (taken, error) =
        steps(vec![file("JUMP JOB:SUB\nMSG \"X\""), other("SUB", "MSG \"A\"")], &mut TestWorld::default(), 9);
    assert_eq!((taken.len(), error), (2, None));

    // CLEAR STACK forgets the caller.
    let (taken, _) = steps(
        vec![file("CALL JOB:SUB\nMSG \"X\""), other("SUB", "CLEAR STACK")],
        &mut TestWorld::default(),
        9,
    );
    assert_eq!(taken.into_iter().map(|s| s.action).collect::<Vec<_>>(), [Action::End]);
}

#[test]
fn speeds_come_from_the_first_rule_that_has_one() {
    let program = "MOVL C00001 V=211.7 PL=0
MOVL C00002 PL=0
SPEED V=50.0 VJ=25.00
MOVL C00001 PL=0
MOVJ C00002 PL=0
MOVL C00001 VR=30.0 PL=0
ARCON AC=200 V=8.0
MOVL C00002 PL=0
MOVL C00001 V=9.0 PL=0
ARCOF
SET I000 105
MOVL C00002 V=I000 PL=0
MOVL C00003 V=12 PL=0";
    let seen: Vec<(u32, Speed, SpeedOrigin)> =
        moves(program).into_iter().map(|(line, m, _)| (line, m.speed, m.speed_origin)).collect();
    let linear = |mm_s| Speed::Linear { mm_s };
    let at = |line| Location { job: "TEST".into(), line };
    assert_eq!(
        seen,
        [
            (33, linear(211.7), SpeedOrigin::Written),
            (34, linear(211.7), SpeedOrigin::LastMove(at(33))),
            (36, linear(50.0), SpeedOrigin::SpeedInstruction(at(35))),
            (37, Speed::JointPercent(25.0), SpeedOrigin::SpeedInstruction(at(35))),
            (38, Speed::Rotation { deg_s: 30.0 }, SpeedOrigin::Written),
            (40, linear(8.0), SpeedOrigin::ArcCondition),
            (41, linear(9.0), SpeedOrigin::Written),
            (44, linear(10.5), SpeedOrigin::Written),
            (45, linear(12.0), SpeedOrigin::Written),
        ]
    );
    assert_eq!(linear(12.0).metres_per_second(), Some(0.012));
    let notes = |line: u32| moves(program).into_iter().find(|(l, ..)| *l == line).unwrap().2;
    assert_eq!(notes(33), []);
    assert_eq!(notes(34)[0].to_string(), "V is missing, taken from the move in TEST line 33");
    assert_eq!(notes(37)[0].to_string(), "VJ is missing, taken from SPEED in TEST line 35");
    assert_eq!(
        notes(45)[0].to_string(),
        "V=12 is an integer, read as mm/s; the cell file sets the unit of V"
    );

    // A condition of the cell supplies it just so.
    let mut world = TestWorld { arc_speed_mm_s: Some(7.5), ..TestWorld::default() };
    let (taken, _) = steps(vec![file("ARCON ASF#(3)\nMOVL C00001 PL=0")], &mut world, 9);
    assert!(matches!(&taken[1].action, Action::Move(m) if m.speed == linear(7.5)));
}

#[test]
fn speeds_survive_a_call() {
    let (taken, error) = steps(
        vec![file("CALL JOB:SUB\nMOVL C00001 PL=0"), other("SUB", "SPEED V=33.0")],
        &mut TestWorld::default(),
        9,
    );
    assert_eq!(error, None);
    assert!(matches!(&taken[0].action, Action::Move(m) if m.speed == Speed::Linear { mm_s: 33.0 }));
}

#[test]
fn moves_carry_zones_shares_and_targets() {
    let program = "MOVJ C00001 VJ=10.00 PL=0 ACC=50 DEC=20
MOVL C00002 V=10.0
MOVL C00003 V=10.0 PL=3
MOVL C00004 V=10.0 CR=2.5 NWAIT
MOVJ P002 VJ=10.00 PL=0
IMOV P100 V=10.0 PL=0 UF#(2)
IMOV P100 V=10.0 PL=0
IMOV P002 V=10.0 PL=0";
    let all = moves(program);
    assert_eq!((all[0].1.acceleration, all[0].1.deceleration, all[1].1.acceleration), (0.5, 0.2, 1.0));
    let zones: Vec<Zone> = all.iter().take(4).map(|(_, m, _)| m.zone).collect();
    assert_eq!(zones, [Zone::Exact, Zone::Unspecified, Zone::Level(3), Zone::CornerRadius { mm: 2.5 }]);
    assert_eq!(all[3].2, [Note::TagWithoutEffect("NWAIT")]);
    assert!(all[3].1.no_wait);
    assert_eq!(all[4].1.target.name, Some(PositionName { local: false, kind: PositionKind::P, number: 2 }));
    assert!(matches!(all[4].1.target.position.coordinates, Coordinates::Pulses(_)));
    let paths: Vec<&MovePath> = all.iter().map(|(_, m, _)| &m.path).collect();
    assert_eq!(*paths[5], MovePath::Incremental { frame: Some(Frame::User(2)) });
    assert_eq!(*paths[6], MovePath::Incremental { frame: Some(Frame::Robot) });
    assert_eq!(*paths[7], MovePath::Incremental { frame: None });
}

/// The points of MOVS are held back until their run ends; what stands between them stays between them.
#[test]
fn splines_run_through_all_points_of_their_run() {
    let program = "MOVL C00001 V=10.0
MOVS C00002 V=20.0
DOUT OT#(1) ON
MOVS C00003 V=20.0
MOVS C00004 V=30.0
MOVL C00005 V=10.0
MOVS C00001 V=10.0
MOVS C00002 V=10.0";
    let (taken, error) = steps(vec![file(program)], &mut TestWorld::default(), 100);
    assert_eq!(error, None);
    let short = |step: &Step| match &step.action {
        Action::Move(m) => match &m.path {
            MovePath::Linear if step.notes == [Note::SplineTooShort] => format!("short {}", m.target),
            MovePath::Linear => format!("line {}", m.target),
            MovePath::Spline(piece) => {
                let points: Vec<_> =
                    piece.points.iter().map(|point| point.name.unwrap().number.to_string()).collect();
                assert_eq!(piece.points[piece.end], m.target);
                format!("spline {} to {}", points.join("-"), piece.end)
            }
            other => format!("{other:?}"),
        },
        Action::Output(_) => "output".into(),
        _ => "end".into(),
    };
    let seen: Vec<String> = taken.iter().map(short).collect();
    assert_eq!(
        seen,
        [
            "line C00001",
            "line C00002",
            "output",
            "spline 2-3-4 to 1",
            "spline 2-3-4 to 2",
            "line C00005",
            "short C00001",
            "short C00002",
            "end"
        ]
    );
}

/// Moves in short: `L5` straight to C5, `J5` joint, `W1-2-3` a whole arc, `F` its first half, `S` its second.
fn shape(program: &str) -> String {
    let one = |motion: &Move| {
        let number = motion.target.name.unwrap().number;
        match &motion.path {
            MovePath::Joint => format!("J{number}"),
            MovePath::Circular(arc) => {
                let letter = match arc.part {
                    ArcPart::Whole => 'W',
                    ArcPart::First => 'F',
                    ArcPart::Second => 'S',
                };
                let points: Vec<String> =
                    arc.points.iter().map(|p| p.name.unwrap().number.to_string()).collect();
                format!("{letter}{}", points.join("-"))
            }
            _ => format!("L{number}"),
        }
    };
    let (taken, error) = steps(vec![file(program)], &mut TestWorld::default(), 1000);
    assert_eq!(error, None);
    let words: Vec<String> = taken
        .iter()
        .filter_map(|step| match &step.action {
            Action::Move(motion) => Some(one(motion)),
            Action::ArcOn(_) => Some("on".into()),
            Action::ArcOff(_) => Some("off".into()),
            _ => None,
        })
        .collect();
    words.join(" ")
}

#[test]
fn circular_points_become_arcs() {
    let movc = |points: &[&str]| {
        points.iter().fold(String::from("MOVJ C00000 VJ=10.00 PL=0"), |text, point| {
            match point.strip_prefix('C') {
                Some(rest) => format!("{text}\nMOVC C0000{rest} V=10.0 PL=0"),
                None => format!("{text}\n{point}"),
            }
        })
    };
    let cases: &[(&[&str], &str)] = &[
        (&["C1", "C2", "C3"], "J0 L1 W1-2-3"),
        (&["C1", "ARCON", "C2", "C3", "ARCOF"], "J0 L1 on W1-2-3 off"),
        (&["C1", "C2", "ARCON", "C3"], "J0 L1 F1-2-3 on S1-2-3"),
        (&["C1", "C2", "C3", "C4", "C5"], "J0 L1 W1-2-3 S2-3-4 S3-4-5"),
        (&["C1", "C2", "C3 FPT", "C4", "C5"], "J0 L1 W1-2-3 W3-4-5"),
        // C5 and C6 are the same place.
        (&["C3", "C4", "C5", "C6", "C7", "C8"], "J0 L3 W3-4-5 L6 W6-7-8"),
        (&["C1"], "J0 L1"),
        (&["C1", "C2"], "J0 L1 L2"),
        (&["C1", "C2", "MOVL C00003 V=10.0 PL=0"], "J0 L1 L2 L3"),
        (&["C1", "C2", "MOVL C00003 V=10.0 PL=0", "C4", "C5", "C7"], "J0 L1 L2 L3 L4 W4-5-7"),
        (&["C1", "C2 FPT", "C3", "C4"], "J0 L1 L2 W2-3-4"),
    ];
    for (points, expected) in cases {
        let program = movc(points).replace(" FPT V=10.0 PL=0", " V=10.0 PL=0 FPT");
        assert_eq!(shape(&program), *expected, "{program}");
    }
    let short = moves("MOVC C00001 V=10.0 PL=0\nMOVC C00002 V=10.0 PL=0");
    assert_eq!(short[1].2, [Note::ArcTooShort]);
    assert_eq!(moves("MOVC C00001 V=10.0 PL=0")[0].2, [Note::ArcTooShort]);
    let uneven = moves("MOVC C00001 V=10.0 PL=0\nMOVC C00002 V=5.0 PL=0\nMOVC C00003 V=10.0 PL=0");
    assert_eq!(uneven[1].2, [Note::ArcSpeedsDiffer]);
}

#[test]
fn inputs_outputs_and_waits() {
    let mut world = TestWorld::default();
    world.inputs.insert((SignalKind::Input, 3), 1);
    world.inputs.insert((SignalKind::InputGroup, 2), 0x5a);
    let program = "DIN B000 IG#(2)
DOUT OG#(1) B000
IFTHEN IN#(3)=ON
DOUT OT#(1) INVERT
ENDIF
DIN B001 OG#(1)
PULSE OT#(9)
PULSE OT#(9) T=2.00
DOUT OGH#(3) 255
AOUT AO#(2) -7.50
SET OT#(20) LOGICEXP(IN#(3)=ON AND B001=91)
WAIT IN#(141)=ON T=3.00
WAIT B001=91 AND IN#(3)=OFF
SET I000 150
TIMER T=I000
SETUALM 8001 \"STOP\" 7";
    let (taken, error) = steps(vec![file(program)], &mut world, 100);
    assert_eq!(error, None);
    let actions: Vec<Action> = taken.into_iter().map(|s| s.action).collect();
    let digital = |kind, number, value| Action::Output(Output::Digital { kind, number, value });
    let pulse =
        |seconds| Action::Output(Output::Pulse { kind: SignalKind::Output, number: 9, value: 1, seconds });
    assert_eq!(
        actions[..7],
        [
            digital(SignalKind::OutputGroup, 1, 0x5a),
            digital(SignalKind::Output, 1, 1),
            pulse(0.3),
            pulse(2.0),
            digital(SignalKind::OutputHalfGroup, 3, 15),
            Action::Output(Output::Analog { number: 2, volts: -7.5 }),
            digital(SignalKind::Output, 20, 1),
        ]
    );
    let Action::Wait { condition, timeout_seconds } = &actions[7] else { panic!("a wait") };
    assert_eq!(*timeout_seconds, Some(3.0));
    assert!(condition.holds(&mut |kind, number| u32::from((kind, number) == (SignalKind::Input, 141))));
    assert!(!condition.holds(&mut |_, _| 0));
    // What is known already is decided: only the input is left to wait for.
    let Action::Wait { condition: Condition::Comparison { .. }, timeout_seconds: None } = &actions[8] else {
        panic!("a wait for the input alone");
    };
    assert_eq!(actions[9], Action::Dwell { seconds: 1.5 });
    let alarm = Action::Alarm { code: 8001, text: "STOP".into(), subcode: 7, stops: true };
    assert_eq!(actions[10..], [alarm]);
}

#[test]
fn what_is_not_executed_is_reported_or_refused_with_its_line() {
    let program = "REFP 1
MVOL C00001 V=1.0";
    let (taken, error) = steps(vec![file(program)], &mut TestWorld::default(), 100);
    assert_eq!(error, None);
    let short = |step: &Step| match &step.action {
        Action::Accepted { text, note } => format!("{} {text}: {note}", step.at),
        Action::Unsupported { text, reason } => format!("{} {text}! {reason}", step.at),
        other => format!("{} {other:?}", step.at),
    };
    let seen: Vec<String> = taken.iter().map(short).collect();
    assert_eq!(
        seen,
        [
            "TEST line 33 REFP 1: a weave takes its plane from the travel and the wire",
            "TEST line 34 MVOL C00001 V=1.0! this instruction is not known; did you mean `MOVL`?",
            "TEST line 35 End",
        ]
    );
}

#[test]
fn arc_conditions_carry_their_values() {
    let program =
        "ARCON AC=220 AVP=100 T=0.50 V=9.0\nARCSET AC=250\nARCOF AEF#(2)\nARCON ASF#(951) WELD2\nARCOF";
    let all = actions(program);
    let Action::ArcOn(first) = all[0] else { panic!("an arc") };
    assert_eq!((first.current, first.voltage_percent, first.seconds), (Some(220.0), Some(100.0), Some(0.5)));
    assert_eq!((first.speed_mm_s, first.file), (Some(9.0), None));
    assert!(matches!(all[1], Action::ArcSet(c) if c.current == Some(250.0)));
    assert!(matches!(all[2], Action::ArcOff(c) if c.file == Some(2)));
    assert!(matches!(all[3], Action::ArcOn(c) if c.file == Some(951) && c.power_source == Some(2)));
}

#[test]
fn weave_conditions_carry_their_values() {
    let all = actions("WVON WEV#(25)\nWVON RB1 AMP=5.0 FREQ=3.0 ANGL=45 DIR=1\nWVOF");
    let written = WeaveCondition {
        file: None,
        amplitude_mm: Some(5.0),
        frequency_hz: Some(3.0),
        angle_deg: Some(45.0),
        right_first: Some(true),
    };
    let file = WeaveCondition { file: Some(25), ..WeaveCondition::default() };
    assert_eq!(all[..3], [Action::WeaveOn(file), Action::WeaveOn(written), Action::WeaveOff]);
}

#[test]
fn after_the_end_there_is_nothing() {
    assert_eq!(actions("NOP"), [Action::End]);
    let text = "/JOB\n//NAME A\n//INST\nEND\n";
    let file = JobFile::parse("a.JBI", text.as_bytes()).unwrap();
    let (taken, error) = steps(vec![file], &mut TestWorld::default(), 10);
    assert_eq!((taken.len(), error), (1, None));
}
