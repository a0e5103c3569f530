//! Every form that INFORM files are known to have, with both line ends.

use seamline_cell::job::{
    Arithmetic, Coordinates, Data, Disposition, Expression, Flow, Frame, Instruction, Io, Job, JobFile,
    JobPosition, Node, PositionKind, PositionName, SpeedKind, Weld, disposition,
};

use crate::support::{FIRST_LINE, file, job};

/// What an instruction is, in short.
fn kind(instruction: &Instruction) -> String {
    let debug = match instruction {
        Instruction::Move(step) => {
            let extra = if step.others.is_empty() { "" } else { "+" };
            return format!("{}{extra}", step.word());
        }
        Instruction::Other { word } => return format!("Other {word}"),
        Instruction::Flow(inner) => format!("{inner:?}"),
        Instruction::Data(inner) => format!("{inner:?}"),
        Instruction::Io(inner) => format!("{inner:?}"),
        Instruction::Weld(inner) => format!("{inner:?}"),
        other => format!("{other:?}"),
    };
    debug.chars().take_while(|c| c.is_alphanumeric()).collect()
}

/// What a run does with it: `e`xecuted, `a`ccepted, `r`efused.
fn fate(instruction: &Instruction) -> char {
    match disposition(instruction) {
        Disposition::Executed => 'e',
        Disposition::Accepted(_) => 'a',
        Disposition::Refused(_) => 'r',
    }
}

/// Line, what it is read as, what a run does with it. Lines that need a partner have it in the same row.
const FORMS: &[(&str, &str, char)] = &[
    // Moves.
    ("MOVJ C00000 VJ=50.00 PL=0", "MOVJ", 'e'),
    ("MOVJ C00000 VJ=0.01", "MOVJ", 'e'),
    ("MOVJ C0 VJ=50.00 PL=0", "MOVJ", 'e'),
    ("MOVL C00001 V=211.7 PL=0", "MOVL", 'e'),
    ("MOVL C00001 V=211.7", "MOVL", 'e'),
    ("MOVL C00001 V=10.0 PL=8", "MOVL", 'e'),
    ("MOVL C00001 VR=30.0 PL=0", "MOVL", 'e'),
    ("MOVL C00001 VE=50.00 PL=0", "MOVL", 'e'),
    ("MOVL C00001 V=I000 PL=0", "MOVL", 'e'),
    ("MOVL C00001 V=100.0 CR=12.5", "MOVL", 'e'),
    ("MOVL C00001 V=100.0 PL=0 ACC=50 DEC=20", "MOVL", 'e'),
    ("MOVL C00001 V=100.0 PL=0 NWAIT", "MOVL", 'a'),
    ("MOVL C00001 V=100.0 PL=0 UNTIL IN#(1)=ON", "MOVL", 'r'),
    ("MOVL C00001 V=100.0 CONT", "MOVL", 'e'),
    ("MOVL C00001 PL=0", "MOVL", 'e'),
    ("MOVL P100 V=100.0 PL=0", "MOVL", 'e'),
    ("MOVL LP002 V=100.0 PL=0", "MOVL", 'e'),
    ("MOVL P[LI002] V=100.0 PL=0", "MOVL", 'e'),
    ("MOVL PX001 V=100.0 PL=0", "MOVL", 'e'),
    ("MOVC C00001 V=100.0 PL=0 FPT", "MOVC", 'e'),
    ("MOVS C00001 V=100.0 PL=0", "MOVS", 'e'),
    ("IMOV P100 V=100.0 PL=0 RF", "IMOV", 'e'),
    ("IMOV P100 V=100.0 PL=0 UF#(3)", "IMOV", 'e'),
    ("MOVL C00000 EC00000 V=100.0 PL=0", "MOVL", 'r'),
    ("MOVL P001 BP001 EX001 V=100.0 PL=0", "MOVL", 'r'),
    ("MOVJ EC00000 VJ=10.00", "MOVJ", 'r'),
    ("MOVL C00000 V=100.0  +MOVJ EC00000", "MOVL+", 'r'),
    ("MOVL C00000 V=100.0 UNTIL IN#(1)=ON  +MOVJ EC00000", "MOVL+", 'r'),
    ("SMOVL C00000 V=10.0  +MOVJ EC00000", "SMOVL+", 'r'),
    ("SMOVC C00000 V=10.0", "SMOVC", 'r'),
    ("MOVL LP001 V=3.4 SRCH RIN#(3)=ON DIS=20.0", "MOVL", 'r'),
    ("+MOVJ EC00000 VJ=10.00", "Other +MOVJ", 'r'),
    ("SPEED VJ=50.00 V=276.0 VR=30.0", "Speed", 'e'),
    ("SPEED VJ=I003 V=I002", "Speed", 'e'),
    // Flow.
    ("*SWEEP-A", "Label", 'e'),
    ("*1", "Label", 'e'),
    ("JUMP *L\n*L", "Jump", 'e'),
    ("JUMP *L IF B010<1\n*L", "Jump", 'e'),
    ("JUMP *L IF IN#(12)=ON\n*L", "Jump", 'e'),
    ("JUMP *L IFEXPRESS (IN#(1)=ON AND IN#(2)=ON)\n*L", "Jump", 'e'),
    ("JUMP JOB:TEST", "Jump", 'e'),
    ("JUMP LABEL:B000", "Other JUMP", 'r'),
    ("JUMP B000 IF IN#(14)=ON", "Other JUMP", 'r'),
    ("CALL JOB:TEST", "Call", 'e'),
    ("CALL JOB:TEST IF IN#(14)=ON", "Call", 'e'),
    ("CALL JOB:TEST ARGF1 ARGFB000 ARGF-2.5 ARGF\"x\"", "Call", 'e'),
    ("CALL JOB:TEST (1, 5, LI001) IF B000=1", "Call", 'e'),
    ("CALL JOB:TEST UF#(3)", "Other CALL", 'r'),
    ("CALL IG#(2)", "Other CALL", 'r'),
    ("RET", "Return", 'e'),
    ("RET IF IN#(12)=ON", "Return", 'e'),
    ("RET LI000", "Return", 'e'),
    ("RET LI000 IF B000=1", "Return", 'e'),
    ("PAUSE", "Pause", 'e'),
    ("PAUSE IF IN#(12)=ON", "Pause", 'e'),
    ("ABORT IF B000=1", "Abort", 'e'),
    ("IFTHEN IN#(1)=ON\nELSEIF B000>=2\nELSE\nENDIF", "If", 'e'),
    ("IFTHEN IN#(1)=ON ANDIF IN#(2)=ON ORIF B000=3\nENDIF", "If", 'e'),
    ("IFTHEN IN#(1)=ON\nANDIF IN#(2)=ON\nORIF B000=1\nENDIF", "If", 'e'),
    ("IFTHENEXP LI000=1 ANDEXP LB000<>2\nELSEIFEXP R000>0.5\nELSE\nENDIF", "If", 'e'),
    ("IFTHENEXP (I000+1)*2>=D000 AND NOT (B000=1 OR B001=1)\nENDIF", "If", 'e'),
    ("WHILE B000<3\nENDWHILE", "While", 'e'),
    ("WHILEEXP (B000<3 AND IN#(1)=OFF)\nENDWHILE", "While", 'e'),
    ("FOR I000=1 TO 10\nNEXT I000", "For", 'e'),
    ("FOR LI000 START= 1 TO 10 STEP=2\nNEXT LI000", "For", 'e'),
    ("FOR I000 = 10 TO 1 STEP -1\nNEXT I000", "For", 'e'),
    ("SWITCH I000\nCASE 1\nCASE 2,3\nDEFAULT\nENDSWITCH", "Switch", 'e'),
    // Data.
    ("SET B000 5", "Set", 'e'),
    ("SET I000 -32768", "Set", 'e'),
    ("SET D000 I000", "Set", 'e'),
    ("SET R000 -0.5", "Set", 'e'),
    ("SET S000 \"TEXT\"", "Set", 'e'),
    ("SET P000 P001", "Set", 'e'),
    ("SET LI000 EXPRESS LI000 / 0.6", "Set", 'e'),
    ("SET B000 (B001 + B002) / B003", "Set", 'e'),
    ("SET B[B001] 1", "Set", 'e'),
    ("SET OT#(1) LOGICEXP(IN#(1)=ON AND IN#(2)=ON)", "SetSignal", 'a'),
    ("SET FL0010 LOGICEXP(B000=1 OR I000=1)", "Other SET", 'r'),
    ("ADD I000 5", "Arithmetic", 'e'),
    ("SUB D000 LI001", "Arithmetic", 'e'),
    ("MUL R000 2.5", "Arithmetic", 'e'),
    ("DIV I000 3", "Arithmetic", 'e'),
    ("ADD P000 P001", "Arithmetic", 'e'),
    ("ADD P000 (3) D000", "Arithmetic", 'e'),
    ("DIV P000 (3) D000", "Arithmetic", 'e'),
    ("INC B000", "Step", 'e'),
    ("DEC LI001", "Step", 'e'),
    ("CLEAR B003 10", "Clear", 'e'),
    ("CLEAR D010 ALL", "Clear", 'e'),
    ("CLEAR STACK", "ClearStack", 'e'),
    ("CLEAR QUE", "Other CLEAR", 'a'),
    ("SQRT R000 2", "Function", 'e'),
    ("SIN R000 60", "Function", 'e'),
    ("COS R000 R001", "Function", 'e'),
    ("ATAN R000 60", "Function", 'e'),
    ("AND B000 B010", "Bitwise", 'e'),
    ("OR B000 10", "Bitwise", 'e'),
    ("XOR B000 1", "Bitwise", 'e'),
    ("NOT B000 B010", "Bitwise", 'e'),
    ("SETE LP000 (4) 0", "SetElement", 'e'),
    ("SETE P000 TL#(1)", "SetTool", 'e'),
    ("GETE D000 P000 (3)", "GetElement", 'e'),
    ("GETS LPX000 $PX000", "GetSystem", 'e'),
    ("GETS B000 $B002", "GetSystem", 'r'),
    ("GETS I001 $RV", "GetSystem", 'e'),
    ("CNVRT PX000 PX001 BF", "Convert", 'e'),
    ("CNVRT P000 P001 UF#(2) TL#(1)", "Convert", 'e'),
    ("GETARG LB000 IARG#(1)", "GetArgument", 'e'),
    ("MFRAME UF#(1) PX000 PX001 PX002", "Other MFRAME", 'r'),
    ("SFTON P032 UF#(1)", "Other SFTON", 'r'),
    ("SFTOF", "Other SFTOF", 'a'),
    ("MSHIFT PX010 BF PX000 PX001", "Other MSHIFT", 'r'),
    ("GETREG LI000 MREG#(5)", "Other GETREG", 'r'),
    ("SET LI000 MREG#(5)", "Set", 'r'),
    // Input and output.
    ("TIMER T=0.50", "Timer", 'e'),
    ("TIMER T=I002", "Timer", 'e'),
    ("WAIT IN#(141)=ON T=3.00", "Wait", 'a'),
    ("WAIT IGH#(2)<>5", "Wait", 'a'),
    ("WAIT SIN#(B000)=B002 T=I001", "Wait", 'a'),
    ("WAIT FOREXPRESS (IN#(1)=ON OR IN#(2)=OFF)", "Wait", 'a'),
    ("DOUT OT#(1) ON", "DigitalOutput", 'a'),
    ("DOUT OG#(26) 0", "DigitalOutput", 'a'),
    ("DOUT OGH#(2) B000", "DigitalOutput", 'a'),
    ("DOUT OT#(B000) INVERT", "DigitalOutput", 'a'),
    ("PULSE OT#(11) T=2.00", "Pulse", 'a'),
    ("PULSE OT#(128)", "Pulse", 'a'),
    ("PULSE OG#(3) B000 T=I000", "Pulse", 'a'),
    ("DIN B010 IGH#(5)", "DigitalInput", 'a'),
    ("DIN B016 IN#(12)", "DigitalInput", 'a'),
    ("AOUT AO#(1) I003", "AnalogOutput", 'a'),
    ("AOUT AO#(1) -7.50", "AnalogOutput", 'a'),
    ("MSG \"PART // MISSING\"", "Message", 'a'),
    ("MSG \"\"", "Message", 'a'),
    ("MSG S000", "Message", 'a'),
    ("SETUALM 8001 \"NO PART\" 0", "Alarm", 'a'),
    ("SETUALM 8000 \"ALM\" 0 SMODE=1", "Alarm", 'a'),
    ("SETUALM 8000 0", "Alarm", 'a'),
    ("PSTART JOB:SUB SUB1", "Other PSTART", 'a'),
    ("HAND HNO: 1 ON", "Other HAND", 'a'),
    // Arc and weave.
    ("ARCON ASF#(951)", "ArcOn", 'e'),
    ("ARCON AC=220 AVP=100 T=0.50", "ArcOn", 'e'),
    ("ARCON AC=220 AV=16.0 T=0.50 V=60.0", "ArcOn", 'e'),
    ("ARCON", "ArcOn", 'e'),
    ("ARCON WELD2", "ArcOn", 'e'),
    ("ARCON ASF#(B000) RETRY", "ArcOn", 'a'),
    ("ARCOF AEF#(953)", "ArcOff", 'e'),
    ("ARCOF AC=160 AVP=90 T=0.50", "ArcOff", 'e'),
    ("ARCOF", "ArcOff", 'e'),
    ("ARCSET AC=250", "ArcSet", 'e'),
    ("ARCSET ASF#(2) ACOND=1", "ArcSet", 'a'),
    ("WVON WEV#(25)", "WeaveOn", 'e'),
    ("WVON AMP=5.0 FREQ=3.0 ANGL=45 DIR=0", "WeaveOn", 'e'),
    ("WVON RB1 WEV#(2)", "WeaveOn", 'e'),
    ("WVOF", "WeaveOff", 'e'),
    ("REFP 1", "Other REFP", 'a'),
    ("COMARCON", "TrackOn", 'e'),
    ("COMARCON AMP=1.0 FREQ=3.0 U/D=200 L/R=1.0", "TrackOn", 'a'),
    ("COMARCOF", "TrackOff", 'e'),
    ("MEMON REC MPF#(1)", "MemoryOn", 'e'),
    ("MEMON PLY MPF#(B001)", "MemoryOn", 'e'),
    ("MEMOF", "MemoryOff", 'e'),
    ("MACRO1 MJ#(0) ARGF10", "Other MACRO1", 'r'),
    // The rest.
    ("NOP", "Nop", 'e'),
    ("'A COMMENT WITH *SIGNS: \"", "Nop", 'e'),
    ("COMM TIMER T=1.00", "Disabled", 'e'),
    ("\t DOUT OT#(1) ON", "DigitalOutput", 'a'),
    ("TIMER T=0.50 //crater", "Timer", 'e'),
    ("FROBNICATE X=1 @!", "Other FROBNICATE", 'r'),
];

#[test]
fn every_form_is_read_with_either_line_end() {
    for (line, expected, expected_fate) in FORMS {
        for end in ["\n", "\r\n"] {
            let text = job(line).replace('\n', end);
            let file = JobFile::parse("t.JBI", text.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{line}"));
            assert_eq!(file.bytes(), text.as_bytes());
            let statement = &file.jobs[0].program[1];
            assert_eq!(kind(&statement.instruction), *expected, "{line}");
            assert_eq!(fate(&statement.instruction), *expected_fate, "{line}");
            assert_eq!(statement.line, FIRST_LINE, "{line}");
        }
    }
    assert!(FORMS.len() >= 140);
}

fn first(program: &str) -> Instruction {
    file(program).jobs[0].program[1].instruction.clone()
}

fn number(expression: &Expression) -> f64 {
    match expression.node {
        Node::Number { value, .. } => value,
        _ => f64::NAN,
    }
}

#[test]
fn values_arrive_where_they_belong() {
    let Instruction::Move(step) =
        first("MOVL C00003 V=12.5 PL=3 CR=2.5 ACC=30 DEC=40 NWAIT  +MOVJ EC00000 VJ=7.5")
    else {
        panic!("a move");
    };
    let speed = step.speed.as_ref().unwrap();
    assert_eq!((speed.kind, number(&speed.value)), (SpeedKind::Linear, 12.5));
    let tags = [&step.position_level, &step.corner_radius, &step.acceleration, &step.deceleration];
    assert_eq!(tags.map(|tag| number(tag.as_ref().unwrap())), [3.0, 2.5, 30.0, 40.0]);
    assert!(step.no_wait && step.others.len() == 1 && step.others[0].external.len() == 1);

    let Instruction::Weld(Weld::ArcOn(arc)) = first("ARCON AC=220 AVP=100 T=0.50 V=60.0 WELD2") else {
        panic!("an arc");
    };
    assert_eq!(number(arc.current.as_ref().unwrap()), 220.0);
    assert_eq!(number(arc.voltage_percent.as_ref().unwrap()), 100.0);
    assert_eq!(number(arc.time.as_ref().unwrap()), 0.5);
    assert_eq!(arc.power_source, Some(2));

    let Instruction::Flow(Flow::Call { target, arguments, condition }) =
        first("CALL JOB:TEST ARGF1 ARGFB000 ARGF-2.5 IF B001=2")
    else {
        panic!("a call");
    };
    assert_eq!((target.name.as_str(), arguments.len()), ("TEST", 3));
    assert_eq!(number(&arguments[2]), -2.5);
    assert!(condition.is_some());

    let Instruction::Data(Data::Arithmetic { operation, element, .. }) = first("DIV P000 (3) D000") else {
        panic!("a division");
    };
    assert_eq!((operation, number(&element.unwrap())), (Arithmetic::Divide, 3.0));

    let Instruction::Io(Io::Alarm { code, text, subcode, .. }) = first("SETUALM 8001 \"NO PART\" 7") else {
        panic!("an alarm");
    };
    assert_eq!((number(&code), number(&subcode.unwrap())), (8001.0, 7.0));
    assert_eq!(text.unwrap().node, Node::Text(b"NO PART".to_vec()));
}

#[test]
fn comments_are_kept_as_bytes() {
    // "Welding" in Shift-JIS; the second byte of the last character is a backslash, as is common there.
    let comment = b"\x97n\x90\xda \x83\\";
    let mut text = job("@").into_bytes();
    let at = text.iter().position(|b| *b == b'@').unwrap();
    let mut line = b"TIMER T=0.50 //".to_vec();
    line.extend_from_slice(comment);
    line.extend_from_slice(b"\r\n'");
    line.extend_from_slice(comment);
    line.extend_from_slice(b"\r\nMSG \"");
    line.extend_from_slice(comment);
    line.push(b'"');
    text.splice(at..=at, line);
    let file = JobFile::parse("t.JBI", &text).unwrap();
    let program = &file.jobs[0].program;
    assert_eq!(kind(&program[1].instruction), "Timer");
    assert_eq!(program[1].text, "TIMER T=0.50");
    assert_eq!(program[1].comment.as_deref(), Some(&comment[..]));
    assert_eq!(program[2].comment.as_deref(), Some(&comment[..]));
    assert_eq!(kind(&program[3].instruction), "Message");
    assert_eq!(file.bytes(), text);
}

/// A file with every header line that is known.
const EVERYTHING: &[u8] = b"/JOB
//NAME 1-Weld_a
///FOLDERNAME SHOP
//POS
///NPOS 4,1,2,3,0,1
///USER 14
///TOOL 2
///POSTYPE USER
///RECTAN
///RCONF 1,0,1,0,1,0,0,0
C00000=812.345,-20.100,455.000,180.0000,-5.2500,0.0000
C00001=812.345,-20.100,455.000,180.00,-5.25,0.00,12.5000
///TOOL 3
///POSTYPE BASE
///RCONF 0,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0
P00001=1,2.5,.5,0,0,0
///POSTYPE PULSE
///PULSE
C00002=-3412,22651,0,0,0,0
BC00000=100
EC00000=100,-200
P00100=1,2,3,4,5,6,7,8
///POSTYPE ANGLE
///ANGLE
C00003=1.0000,2.0000,3.0000
EC00001=45.0000
EX00000=-90.0000,12.5000
///POSTYPE ROBOT
///RECTAN
///RCONF 1,1,1,1,1
P2=1,2,3,4,5,6
//ARGINFO
///ARGTYPE B,I,,,,,,
///COMMENT
part number
side

no slash
//INST
///DATE 2026/01/02 10:00
///COMM \x97n\x90\xda
///ATTR SC,RW,RJ
////FRAME USER 14
///GROUP1 RB1,BS1
///GROUP2 ST1
///LVARS 1,2,0,0,0,1,0,0
LB000 COUNT
NOP
'COMMENT
END
/JOB
//NAME OLD
//POS
///NPOS 1,0,0,0
///TOOL 0
///RCONF 0,0,0,0,0
C001=1,2,3,4,5,6
//INST
///DATE 95/01/02 10:00
///ATTR 1,2
///FRAME BASE
///GROUP1 RB1
NOP
MOVJ C001 VJ=10.00 CONT
END
\x1a";

fn position(job: &Job, kind: PositionKind, number: u32) -> &JobPosition {
    &job.positions[&PositionName { local: false, kind, number }]
}

#[test]
fn every_header_line_is_read() {
    let file = JobFile::parse("t.JBI", EVERYTHING).unwrap_or_else(|e| panic!("{e}"));
    let [job, old] = file.jobs.as_slice() else { panic!("two jobs") };
    assert_eq!((&*job.name, job.line, job.positions.len()), ("1-Weld_a", 2, 11));
    let header = &job.header;
    assert_eq!(header.folder.as_deref(), Some("SHOP"));
    assert_eq!(header.date.as_deref(), Some("2026/01/02 10:00"));
    assert_eq!(header.comment, b"\x97n\x90\xda");
    assert_eq!(header.attributes, ["SC", "RW", "RJ"]);
    assert_eq!(header.frame, Some(Frame::User(14)));
    assert_eq!(header.groups, [vec!["RB1", "BS1"], vec!["ST1"]]);
    assert_eq!(header.locals, Some([1, 2, 0, 0, 0, 1, 0, 0]));
    assert_eq!(header.argument_types[..2], ["B", "I"]);
    assert_eq!(header.argument_comments, [&b"part number"[..], b"side", b"", b"no slash"]);
    assert_eq!(job.program.len(), 3);

    let Coordinates::Rectangular(first) = &position(job, PositionKind::C, 0).coordinates else {
        panic!("rectangular");
    };
    assert_eq!(first.position_mm, [812.345, -20.1, 455.0]);
    assert_eq!(first.rotation_deg, [180.0, -5.25, 0.0]);
    assert_eq!(first.frame, Frame::User(14));
    assert!(first.configuration.no_flip && first.configuration.rear && first.configuration.t_beyond_180);
    assert!(!first.configuration.lower_arm);
    assert_eq!(position(job, PositionKind::C, 0).tool, 2);
    let Coordinates::Rectangular(seven) = &position(job, PositionKind::C, 1).coordinates else {
        panic!("rectangular");
    };
    assert_eq!(seven.elbow_deg, Some(12.5));
    let Coordinates::Rectangular(base) = &position(job, PositionKind::P, 1).coordinates else {
        panic!("rectangular");
    };
    assert_eq!((base.frame, position(job, PositionKind::P, 1).tool), (Frame::Base, 3));
    assert!(base.configuration.lower_arm && !base.configuration.no_flip);
    assert_eq!(base.position_mm, [1.0, 2.5, 0.5]);
    let coordinates = |kind, number| &position(job, kind, number).coordinates;
    assert_eq!(*coordinates(PositionKind::C, 2), Coordinates::Pulses(vec![-3412, 22651, 0, 0, 0, 0]));
    assert_eq!(*coordinates(PositionKind::Ec, 0), Coordinates::Pulses(vec![100, -200]));
    assert_eq!(*coordinates(PositionKind::Ec, 1), Coordinates::Angles(vec![45.0]));
    assert_eq!(*coordinates(PositionKind::Ex, 0), Coordinates::Angles(vec![-90.0, 12.5]));
    let Coordinates::Rectangular(robot) = coordinates(PositionKind::P, 2) else { panic!("rectangular") };
    assert_eq!(robot.frame, Frame::Robot);

    assert_eq!((&*old.name, old.header.frame), ("OLD", Some(Frame::Base)));
    assert_eq!(old.positions.len(), 1);
}

#[test]
fn writing_gives_the_bytes_back_and_crlf_for_controllers() {
    let file = JobFile::parse("t.JBI", EVERYTHING).unwrap();
    assert_eq!(file.bytes(), EVERYTHING);
    let crlf = file.to_crlf();
    let lines = EVERYTHING.iter().filter(|b| **b == b'\n').count();
    assert_eq!(crlf.len(), EVERYTHING.len() + lines);
    let again = JobFile::parse("t.JBI", &crlf).unwrap();
    assert_eq!(again.to_crlf(), crlf);
    assert_eq!(again.bytes(), crlf);
    assert_eq!(again.jobs, file.jobs);
}

#[test]
fn position_numbers_match_as_integers() {
    let file = file("MOVJ C3 VJ=1.00\nMOVJ C0000000003 VJ=1.00\nMOVJ P00001 VJ=1.00\nMOVJ P1 VJ=1.00");
    assert_eq!(file.jobs[0].program.len(), 6);
}
