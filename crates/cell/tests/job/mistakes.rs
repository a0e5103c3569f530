//! Wrong files, each with the one message that it gives.

use seamline_cell::job::{JobFile, JobSet};

use crate::support::{file, job, other};

/// A line of the program at line 33 of the file, and the message behind `t.JBI:`.
const LINES: &[(&str, &str)] = &[
    // Numbers.
    ("MOVJ C00000 VJ=5O.00", "33:16: `5O.00` is not a number: expected a number or variable"),
    ("MOVL C00001 V=1.2.3", "33:15: `1.2.3` is not a number: expected a number or variable"),
    ("MOVL C00001 V=1e3", "33:15: `1e3` is not a number: expected a number or variable"),
    ("TIMER T=", "33:9: found the end of the line, expected a number or variable"),
    ("DOUT OT#(1.5) ON", "33:10: `1.5` is not a number: expected a whole number"),
    ("MOVL C00001 V=10.0 PL=1.5", "33:23: `1.5` is not a number: expected a whole number"),
    ("SET B99999999999 1", "33:5: `B99999999999` is not a number: expected a variable such as B000 or LI010"),
    // Ranges.
    ("MOVJ C00000 VJ=120.00", "33:16: VJ (%) is 120, expected 0.01 to 100"),
    ("MOVL C00001 V=0.0", "33:15: V is 0, expected 0.01 to 10000"),
    ("MOVL C00001 V=-5.0", "33:15: V is -5, expected 0.01 to 10000"),
    ("MOVL C00001 V=10.0 PL=9", "33:23: PL is 9, expected 0 to 8"),
    ("MOVL C00001 V=10.0 ACC=10", "33:24: ACC (%) is 10, expected 20 to 100"),
    ("MOVL C00001 V=10.0 CR=0.0", "33:23: CR (mm) is 0, expected 0.1 to 6553.5"),
    ("TIMER T=700.00", "33:9: T (s) is 700, expected 0 to 655.35"),
    ("SET B000 256", "33:10: the value of a B variable is 256, expected 0 to 255"),
    ("SET I000 -32769", "33:10: the value of an I variable is -32769, expected -32768 to 32767"),
    ("ARCON AC=1200", "33:10: AC (A) is 1200, expected 1 to 999"),
    ("ARCON AV=80.0", "33:10: AV (V) is 80, expected 0.1 to 50"),
    ("WVON AMP=200.0", "33:10: AMP (mm) is 200, expected 0.1 to 99.9"),
    ("SETUALM 7000 \"X\" 0", "33:9: the alarm code is 7000, expected 8000 to 8999"),
    ("GETE D000 P001 (9)", "33:17: the element is 9, expected 1 to 8"),
    ("AOUT AO#(1) 20.0", "33:13: the output (V) is 20, expected -14 to 14"),
    // Missing and surplus parts.
    ("MOVL V=10.0", "33:12: MOVL has no target position, expected one such as C00001 or P001"),
    ("MOVL C00001 C00002 V=10.0", "33:13: found a second target position, expected a tag such as V= or PL="),
    ("MOVL C00001 V=10.0 V=20.0", "33:20: `V=` stands here, but V= was already given"),
    ("MOVL C00001 PL=1 PL=2", "33:18: `PL=` stands here, but PL= was already given"),
    ("MOVL C00001 VJ=10.0", "33:13: found `VJ`, expected V=, VR= or VE= for a move along a path"),
    ("MOVJ C00001 V=10.0", "33:13: found `V`, expected VJ= for a joint move"),
    ("MOVL C00001 10.0", "33:13: found `10.0`, expected a position or a tag such as V= or PL="),
    ("MOVL C00001 V 10.0", "33:15: found `10.0`, expected `=` and a value"),
    ("SPEED", "33:6: found the end of the line, expected VJ=, V=, VR= or VE="),
    ("TIMER 0.5", "33:7: found `0.5`, expected T= and a time in seconds"),
    ("TIMER T=0.50 X", "33:14: found `X`, expected the end of the instruction"),
    ("WAIT IN#(1)", "33:6: found a number, expected a comparison such as B000=1"),
    ("WAIT IN#(1=ON", "33:10: found a condition, expected a number"),
    ("WAIT IN(1)=ON", "33:8: found `(`, expected `#(` and a number"),
    ("DOUT IN#(1) ON", "33:6: found `IN`, expected an output such as OT#(1) or OG#(1)"),
    ("DOUT OT#(1)", "33:12: found the end of the line, expected a number, a variable, a signal or `(`"),
    ("MSG \"ABC", "33:5: found an open quote, expected a closing quote"),
    ("MSG B000", "33:5: found a number, expected a text in quotes or a string variable"),
    ("SET B000", "33:9: found the end of the line, expected a number, a variable, a signal or `(`"),
    ("SET X 1", "33:5: found `X`, expected a variable such as B000 or LI010"),
    ("SET B000 \"TEXT\"", "33:10: found a text, expected a number"),
    ("SET P000 5", "33:10: found a number, expected a position variable"),
    ("SET B000 (1+2", "33:14: found the end of the line, expected `)` or an operator"),
    ("SET B000 1+\"A\"", "33:12: found a text, expected a number"),
    ("INC S000", "33:5: found `S000`, expected a B, I or D variable"),
    ("AND I000 1", "33:5: found `I000`, expected a byte variable such as B000"),
    ("ADD S000 1", "33:5: found `S000`, expected a variable that holds a number or a position"),
    ("MUL P000 2", "33:10: found `2`, expected `(` and a number"),
    ("GETS B000 B002", "33:11: found `B002`, expected a system variable such as $PX000"),
    ("CNVRT P000 P001 XF", "33:17: found `XF`, expected a coordinate system: BF, RF, TF, UF#(n) or MTF"),
    ("GETARG LB000 1", "33:14: found `1`, expected IARG#(n)"),
    ("DIV I000 0", "33:10: division by zero"),
    ("SET I000 I001/0", "33:15: division by zero"),
    ("SQRT R000 -4", "33:11: square root of -4, expected a number that is not negative"),
    ("123 GO", "33:1: found `123`, expected an instruction"),
    ("*", "33:2: found the end of the line, expected the label's name"),
    // Flow.
    ("JUMP", "33:5: found the end of the line, expected a label such as *START or JOB: and a name"),
    ("*STRAT\nJUMP *START", "34:6: there is no label `*START`; did you mean `*STRAT`?"),
    ("JUMP *NOWHERE IF B000=1", "33:6: there is no label `*NOWHERE`"),
    ("*A\n*A", "34:1: label `*A` is already defined in line 33"),
    ("CALL JOB:", "33:10: found the end of the line, expected a job's name"),
    ("CALL JOB:TEST (1,2", "33:19: found the end of the line, expected `,` or `)`"),
    ("CALL JOB:TEST (1,2,3,4,5,6,7,8,9)", "33:15: the call has 9 arguments, expected at most 8"),
    ("IFTHEN B000=1", "33:1: IFTHEN without ENDIF"),
    ("IFTHEN B000\nENDIF", "33:8: found a number, expected a comparison such as B000=1"),
    ("IFTHEN B000=S000\nENDIF", "33:13: found a text, expected a number"),
    ("ENDIF", "33:1: ENDIF without IFTHEN"),
    ("ELSE", "33:1: ELSE without IFTHEN"),
    ("IFTHEN B000=1\nELSE\nELSE\nENDIF", "35:1: ELSE without IFTHEN"),
    (
        "IFTHEN B000=1\nNOP\nANDIF B001=1\nDOUT OT#(1) ON\nANDIF B001=1\nENDIF",
        "37:1: ANDIF without IFTHEN, ELSEIF or WHILE above it",
    ),
    ("WHILE B000<1\nENDIF\nENDWHILE", "34:1: ENDIF without IFTHEN"),
    ("WHILE B000<1", "33:1: WHILE without ENDWHILE"),
    ("ENDWHILE", "33:1: ENDWHILE without WHILE"),
    ("FOR I000=1 TO 3\nNEXT I001", "34:1: NEXT I001 closes the FOR of line 33, which counts I000"),
    ("FOR I000=1", "33:11: found the end of the line, expected TO and the last value"),
    ("FOR I000=1 TO 3 STEP=0\nNEXT I000", "33:22: found a step of 0, expected a step that counts"),
    ("NEXT I000", "33:1: NEXT without FOR"),
    ("CASE 1", "33:1: CASE without SWITCH"),
    ("SWITCH B000\nDEFAULT\nCASE 1\nENDSWITCH", "35:1: CASE without SWITCH"),
    // References.
    ("MOVL C00021 V=10.0", "33:6: there is no position `C00021`; did you mean `C00001`?"),
    ("MOVL C00001 V=10.0  +MOVJ EC00005", "33:27: there is no position `EC00005`; did you mean `EC00000`?"),
    ("SET LB004 1", "33:5: `LB004` is not declared: ///LVARS gives 4 of this kind"),
    ("IMOV LP010 V=10.0 RF", "33:6: `LP010` is not declared: ///LVARS gives 4 of this kind"),
    ("SET LB[LI009] 1", "33:8: `LI009` is not declared: ///LVARS gives 4 of this kind"),
    // After the end, and header lines in the program.
    ("END\nMOVL C00001 V=10.0", "34:1: found `MOVL`, expected /JOB or the end of the file after END"),
    ("///TOOL 3", "33:1: found `///TOOL`, expected an instruction or END"),
];

#[test]
fn each_wrong_line_gives_its_one_message() {
    let mut wrong = Vec::new();
    for (line, expected) in LINES {
        let text = job(line);
        // What follows END is a second mistake of that row only.
        let text =
            if line.starts_with("END\n") { text.strip_suffix("END\n").unwrap().to_owned() } else { text };
        for end in ["\n", "\r\n"] {
            let text = text.replace('\n', end);
            let message = match JobFile::parse("t.JBI", text.as_bytes()) {
                Ok(_) => "read without a mistake".to_owned(),
                Err(errors) => errors.to_string(),
            };
            if message != format!("t.JBI:{expected}") {
                wrong.push(format!("{line}\n  gives    {message}\n  expected t.JBI:{expected}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Changes of the good file's outline: what is replaced by what, and the message behind `t.JBI:`.
const OUTLINE: &[(&str, &str, &str)] = &[
    ("/JOB\n", "", "1:1: found `//NAME`, expected /JOB"),
    ("//NAME TEST\n", "", "1:1: the job has no //NAME, expected it before //POS"),
    ("//NAME TEST", "//NAME", "2:7: found the end of the line, expected the job's name"),
    (
        "//NAME TEST",
        "//NAME A B",
        "2:10: found `B`, expected the end of the line: a job's name has no blanks",
    ),
    (
        "//NAME TEST",
        "//NAME ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456",
        "2:8: the job's name has 33 characters, expected at most 32",
    ),
    ("//NAME TEST", "//NAME TEST\n//NAME OTHER", "3:8: name `TEST` is already defined in line 2"),
    ("///NPOS 12,", "///NPOS 13,", "4:1: ///NPOS announces 13 C positions, but the list has 12"),
    (
        "///NPOS 12,0,1,3,0,0",
        "///NPOS 12,0,1",
        "4:9: ///NPOS has 3 values, expected 6: C, BC, EC, P, BP, EX (or 4, in old files)",
    ),
    ("///NPOS 12,", "///NPOS 1x2,", "4:9: `1x2` is not a number: expected a count of positions"),
    ("///TOOL 1", "///TOOL X", "5:9: found `X`, expected the number of a tool"),
    (
        "///POSTYPE ROBOT",
        "///POSTYPE WORLD",
        "6:12: found `WORLD`, expected PULSE, BASE, ROBOT, TOOL, USER, MTOOL or ANGLE",
    ),
    (
        "///POSTYPE ROBOT",
        "///POSTYPE USER",
        "6:12: the job has no ///USER, expected it before ///POSTYPE USER",
    ),
    ("///RCONF 1,0,0,0,0,0", "///RCONF 1,0,2,0,0,0", "8:14: found `2`, expected 0 or 1"),
    ("///RCONF 1,0,0,0,0,0", "///RCONF 1,0,0", "8:10: ///RCONF has 3 values, expected 5 to 24"),
    (
        "C00000=900.000,0.000,",
        "C00000=900.000,",
        "9:8: the position has 5 values, expected 6 (x, y, z, Rx, Ry, Rz), or 7 on an arm of seven axes",
    ),
    ("C00000=900.000,0.000,", "C00000=900.000,O.000,", "9:16: found `O`, expected a number"),
    ("C00000=900.000,0.000,", "C00000=900.000,0..0,", "9:16: `0..0` is not a number: expected a number"),
    (
        "C00000=900.000,0.000,",
        "C00000=900.000 0.000,",
        "9:16: found `0.000`, expected `,` or the end of the line",
    ),
    ("C00000=900.000", "C00000 900.000", "9:8: found `900.000`, expected `=` and the position's values"),
    ("C00000=900.000", "CX000=900.000", "9:1: found `CX000`, expected a position such as C00001= or P001="),
    ("C00001=1000", "C00000=1000", "10:1: position `C00000` is already defined in line 9"),
    (
        "EC00000=1000,-2000",
        "EC00000=1000,-20.5",
        "25:14: `-20.5` is not a number: expected a whole number of pulses",
    ),
    (
        "P00002=1000,2000",
        "P00002=99999999999,2000",
        "26:8: `99999999999` is not a number: expected a whole number of pulses",
    ),
    (
        "P00002=1000,2000,",
        "P00002=1000,",
        "26:8: the position has 5 values, expected 6 (S, L, U, R, B, T), up to 8 with further axes, or 4 on an arm of four axes",
    ),
    ("//INST\n", "", "31:1: the job has no //INST, expected it before the program"),
    (
        "///LVARS 4,4,4,4,4,4,0,0",
        "///LVARS 4,4,4",
        "31:10: ///LVARS has 3 values, expected 8: B, I, D, R, S, P, BP, EX",
    ),
    ("\nEND\n", "\n", "33:1: the job `TEST` has no END"),
    (
        "///POSTYPE PULSE",
        "/POSTYPE PULSE",
        "23:1: found `/POSTYPE`, expected /JOB, //NAME, //POS or another header line",
    ),
    ("///POSTYPE PULSE", "///", "23:1: found `///`, expected /JOB, //NAME, //POS or another header line"),
];

#[test]
fn each_wrong_outline_gives_its_one_message() {
    let mut wrong = Vec::new();
    for (old, new, expected) in OUTLINE {
        let good = job("NOP");
        assert!(good.contains(old), "{old}");
        let message = match JobFile::parse("t.JBI", good.replacen(old, new, 1).as_bytes()) {
            Ok(_) => "read without a mistake".to_owned(),
            Err(errors) => errors.to_string(),
        };
        if message != format!("t.JBI:{expected}") {
            wrong.push(format!("{new}\n  gives    {message}\n  expected t.JBI:{expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_without_a_job_and_with_two_of_a_name() {
    let message = |bytes: &[u8]| JobFile::parse("t.JBI", bytes).unwrap_err().to_string();
    assert_eq!(message(b""), "t.JBI:1:1: the file holds no job, expected /JOB");
    assert_eq!(message(b"\r\n \r\n"), "t.JBI:1:1: the file holds no job, expected /JOB");
    assert_eq!(message(b"\x7fELF\x00\x01"), "t.JBI:1:1: found `\x7fELF\0\x01`, expected /JOB");
    let twice = format!("{0}{0}", job("NOP"));
    assert_eq!(message(twice.as_bytes()), "t.JBI:36:1: job `TEST` is already defined in line 2");
}

#[test]
fn every_wrong_line_is_told_and_in_order() {
    let text = job("MOVL V=1.0\nTIMER T=0.5\nTIMER T=X\nJUMP *A\nDIV I000 0");
    let errors = JobFile::parse("t.JBI", text.as_bytes()).unwrap_err();
    let lines: Vec<u32> = errors.iter().map(|e| e.line).collect();
    assert_eq!(lines, [33, 35, 36, 37]);
}

#[test]
fn unknown_jobs_are_found_before_the_run() {
    let caller = file("CALL JOB:WELDD\nJUMP JOB:HOME IF B000=1");
    let errors = JobSet::from_files(vec![caller, other("WELD", "RET")]).unwrap_err();
    assert_eq!(
        errors.to_string(),
        "t.JBI:33:10: there is no job `WELDD`; did you mean `WELD`?\nt.JBI:34:10: there is no job `HOME`"
    );
    let errors = JobSet::from_files(vec![other("WELD", "RET"), other("WELD", "RET")]).unwrap_err();
    assert_eq!(errors.to_string(), "WELD.JBI:2:1: job `WELD` is already defined in line 2");
}

#[test]
fn deep_nesting_is_refused_and_ends() {
    let parentheses = format!("SET B000 {}1{}", "(".repeat(60), ")".repeat(60));
    let minus = format!("SET I000 {}1", "-".repeat(60));
    let index = format!("SET {}0{} 1", "B[".repeat(60), "]".repeat(60));
    for line in [parentheses, minus, index] {
        let errors = JobFile::parse("t.JBI", job(&line).as_bytes()).unwrap_err();
        assert!(errors.to_string().ends_with("nested more than 32 deep"), "{errors}");
    }
    let blocks = "IFTHEN B000=1\n".repeat(40) + &"ENDIF\n".repeat(40);
    let errors = JobFile::parse("t.JBI", job(&blocks).as_bytes()).unwrap_err();
    assert!(errors.to_string().starts_with("t.JBI:65:1: nested more than 32 deep"), "{errors}");
    let long = format!("SET B000 1{}", "+1".repeat(600));
    let errors = JobFile::parse("t.JBI", job(&long).as_bytes()).unwrap_err();
    assert!(errors.to_string().contains("the line has 1210 characters"), "{errors}");
}

#[test]
fn there_are_more_than_a_hundred_kinds_of_mistakes() {
    assert!(LINES.len() + OUTLINE.len() > 100);
}
