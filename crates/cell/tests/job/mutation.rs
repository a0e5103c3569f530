//! Damaged files: never a panic, never without end.

use proptest::prelude::*;
use seamline_cell::job::{Interpreter, JobFile, JobSet, LinearSpeedUnit};

use crate::support::{TestWorld, job};

/// Programs that between them use most of the language.
const PROGRAMS: &[&str] = &[
    "MOVJ C00000 VJ=50.00 PL=0\nMOVL C00001 V=211.7\nARCON AC=220 AVP=100 T=0.50\nMOVC C00001 V=8.0\nMOVC C00002 V=8.0 FPT\nMOVC C00003 V=8.0\nARCOF AEF#(1)\nTIMER T=0.50\nIMOV P100 V=10.0 RF",
    "FOR I000=1 TO 3 STEP=1\nSWITCH I000\nCASE 1\nSET B000 (B001 + 2) * 3\nCASE 2,3\nMSG \"B\"\nDEFAULT\nNOP\nENDSWITCH\nNEXT I000\nWHILEEXP B000>0 ANDEXP NOT I000=9\nDEC B000\nENDWHILE",
    "*A\nINC LB000\nIFTHEN LB000<5\nANDIF IN#(1)=OFF\nJUMP *A\nELSEIF B[LB000]=1\nCALL JOB:TEST ARGF1 (2)\nENDIF\nSET P000 P001\nADD P000 P100\nGETE D000 P000 (3)\nSETE P000 (3) D000\nCNVRT P003 P000 UF#(1)",
    "DIN B000 IG#(2)\nDOUT OG#(1) B000\nDOUT OT#(1) INVERT\nPULSE OT#(9) T=2.00\nWAIT IN#(3)=ON T=3.00\nAOUT AO#(2) -7.50\nSETUALM 8001 \"X\" 7 SMODE=1\nSET LI000 EXPRESS LI000 / 0.6\nSQRT R000 2\nSMOVL C00000 V=10.0  +MOVJ EC00000\n'text\nFROB 1",
];

/// Reads the bytes and, where they are a job, runs at most a few hundred steps of it. True where it ran.
fn survives(bytes: &[u8]) -> bool {
    let Ok(file) = JobFile::parse("t.JBI", bytes) else { return false };
    assert_eq!(file.bytes(), bytes);
    let Ok(set) = JobSet::from_files(vec![file]) else { return false };
    let mut interpreter = Interpreter::new(&set, LinearSpeedUnit::default());
    let mut world = TestWorld::default();
    for _ in 0..300 {
        match interpreter.next(&mut world) {
            Ok(Some(_)) => {}
            Ok(None) | Err(_) => break,
        }
    }
    true
}

/// Numerical Recipes' linear congruential generator: the same files on every machine.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit.max(1)
    }
}

/// 8,000 damaged jobs: one to three bytes changed, dropped, doubled, or lines swapped. Each is read, and run where it
/// can be.
#[test]
fn damaged_jobs_are_read_or_refused() {
    let mut random = Random(7);
    let interesting = b"0123456789=,.-+*/()[]#<>:\"' \t\r\nABCDEFILMNOPRSTUVXYJ\x00\x1a\x82\xff";
    let mut ran = 0;
    for round in 0..8_000 {
        let mut bytes = job(PROGRAMS[round % PROGRAMS.len()]).into_bytes();
        for _ in 0..=random.below(3) {
            if bytes.is_empty() {
                break;
            }
            let at = random.below(bytes.len());
            match random.below(13) {
                0..=3 => bytes[at] = interesting[random.below(interesting.len())],
                4..=6 => drop(bytes.remove(at)),
                7..=9 => bytes.insert(at, interesting[random.below(interesting.len())]),
                10 | 11 => {
                    let end = (at + random.below(40)).min(bytes.len());
                    let piece = bytes[at..end].to_vec();
                    let to = random.below(bytes.len());
                    bytes.splice(to..to, piece);
                }
                _ => bytes.truncate(at.max(1)),
            }
        }
        ran += usize::from(survives(&bytes));
    }
    // Enough of them still run for the interpreter to be tried too.
    assert!(ran > 500, "{ran}");
}

/// Words in any order, as instructions: 8,000 programs of up to six lines.
#[test]
fn shuffled_words_are_read_or_refused() {
    let words: Vec<&str> = PROGRAMS.iter().flat_map(|p| p.split([' ', '\n'])).collect();
    let mut random = Random(11);
    for _ in 0..8_000 {
        let mut program = String::new();
        for _ in 0..=random.below(6) {
            for _ in 0..=random.below(6) {
                program.push_str(words[random.below(words.len())]);
                program.push(' ');
            }
            program.push('\n');
        }
        survives(job(&program).as_bytes());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(512) })]

    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        survives(&bytes);
        let mut program = b"/JOB\n//NAME A\n//INST\n".to_vec();
        program.extend_from_slice(&bytes);
        survives(&program);
    }
}
