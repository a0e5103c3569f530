//! Records of passes as files.

use seamline::seam::{LaneKey, LaneMemory, MEMORY_POINTS, Offset, RecordedWeld};
use seamline_cell::sensor::passes::{HEADER, KeptLane, of_memory, read, write};

use crate::Random;

fn lane(random: &mut Random) -> KeptLane {
    let (spacing, first, count) =
        (random.within(1e-3, 5e-3), random.below(100) as i64 - 2, 3 + random.below(200));
    let start = (first as f64 + random.within(1.0, 1.1)) * spacing;
    let length = (count - 3) as f64 * random.within(0.5, 0.99) * spacing;
    let weld = RecordedWeld { start, length, speed: random.within(1e-3, 0.1) };
    let mut point = || Offset::new(random.within(-0.02, 0.02), random.within(-1e-7, 1e-7));
    KeptLane { weld, spacing, first, points: (0..count + 1).map(|_| point()).collect() }
}

/// 300 files of up to five welds: text, and a memory with another file beside it, give them back bit for bit.
#[test]
fn a_record_comes_back_as_it_was() {
    let mut random = Random(4);
    for _ in 0..300 {
        let welds = 1 + random.below(5);
        let lanes: Vec<KeptLane> = (0..welds).map(|_| lane(&mut random)).collect();
        assert_eq!(read(&write(&lanes)), Ok(lanes.clone()));
        let mut memory = LaneMemory::new();
        for (weld, lane) in (0..).zip(&lanes) {
            memory.insert(LaneKey { file: 7, weld }, &lane.record()).unwrap();
            memory.insert(LaneKey { file: 8, weld }, &lanes[0].record()).unwrap();
        }
        assert_eq!(of_memory(&memory, 7), lanes);
    }
}

#[test]
fn mistakes_are_named_with_line_and_column() {
    let file = |rows: &str| format!("{HEADER}\n{rows}");
    let many: String = (0..=MEMORY_POINTS).map(|k| format!("0,0,300,10,2,{k},0,0\n")).collect();
    for (text, message) in [
        ("weld\n".to_owned(), format!("line 1: `weld`: expected the columns {HEADER}")),
        (file("0,0,300,10,2,-1,0\n"), format!("line 2: 7 columns: expected 8, {HEADER}")),
        (file("1,0,300,10,2,-1,0,0\n"), "column 1 (weld): `1`: expected the weld of the row before".into()),
        (
            file("0,0,300,10,2,-1,0,0\n0,0,310,10,2,0,0,0\n"),
            "line 3, column 1 (weld): `0`: expected start".into(),
        ),
        (
            file("0,0,300,10,2,-1,0,0\n0,0,300,10,2,1,0,0\n"),
            "line 3, column 6 (point): `1`: expected the number after".into(),
        ),
        (file("0,0,300,10,2,-1,0,nan\n"), "column 8 (height_mm): `nan`: expected from -100 to 100 mm".into()),
        (file("0,0,300,10,2,-1,,0\n"), "column 7 (lateral_mm): ``: expected from -100 to 100 mm".into()),
        (file("0,0,300,10,2,-1,100.1,0\n"), "column 7 (lateral_mm): `100.1`: expected".into()),
        (file("0,0,300,10,0,-1,0,0\n"), "column 5 (spacing_mm): `0`: expected from 0.1 to 100 mm".into()),
        (file("0,0,300,0,2,-1,0,0\n"), "column 4 (travel_mm_s): `0`: expected a speed".into()),
        (file("0,0,300,10,2,1e3,0,0\n"), "column 6 (point): `1e3`: expected a whole number".into()),
        (
            file("0,0,4,10,2,-1,0,0\n0,0,4,10,2,0,0,0\n1,0,4,10,2,-1,0,0\n"),
            "line 3, column 6 (point): `0`: expected control points up to the weld's end".into(),
        ),
        (file(&many), "line 2050, column 6 (point): `2048`: expected no more control points".into()),
    ] {
        let found = read(&text).unwrap_err().to_string();
        assert!(found.contains(&message), "{found}: expected {message}");
    }
}
