//! The printed tables of the source.

use std::f64::consts::TAU;

use seamline::vibration::{Corner, Mode, Overlap, Prefilter, Ramp};

const TABLES: &str = include_str!("../data/cornering_tables.csv");
/// 9600 mm/min.
const FEEDRATE: f64 = 0.16;

struct Row {
    prefilter: Prefilter,
    /// In metres.
    permitted: f64,
    /// In degrees.
    angle: f64,
    /// t_DEC1, t_m, t_c, t_d as printed.
    printed: [f64; 4],
}

fn rows() -> Vec<Row> {
    let row = |line: &str| {
        let fields: Vec<_> = line.split(',').collect();
        let number = |n: usize| fields[n].parse::<f64>().expect("a number");
        Row {
            prefilter: Prefilter::from_name(fields[0]).expect("a prefilter"),
            permitted: number(1) * 1e-6,
            angle: number(2),
            printed: [number(3), number(4), number(5), number(6)],
        }
    };
    TABLES.lines().skip(1).map(row).collect()
}

fn solve(row: &Row) -> Overlap {
    let mode = Mode::try_new(TAU * 6.34, 0.022).unwrap();
    let ramp = Ramp::from_kernel(&row.prefilter.kernel(&mode).unwrap()).unwrap();
    let corner = Corner {
        deceleration: &ramp,
        acceleration: &ramp,
        first_feedrate: FEEDRATE,
        second_feedrate: FEEDRATE,
        angle: row.angle.to_radians(),
        longest: f64::INFINITY,
    };
    corner.overlap(row.permitted)
}

/// One printed value contradicts its own row, and the source's definition: t_m = 0.140 s, before the overlap begins at t_d = 0.144 s. Until then the
/// first segment alone moves, towards the corner, so that the nearest point comes at t_d at the earliest.
fn contradicts_itself(row: &Row) -> bool {
    let [_, nearest, _, delay] = row.printed;
    nearest < delay
}

#[test]
fn all_rows_within_a_millisecond() {
    let rows = rows();
    assert_eq!(rows.len(), 40);
    assert_eq!(rows.iter().filter(|row| contradicts_itself(row)).count(), 1);
    for row in &rows {
        let Overlap { deceleration, nearest, overlap, delay, error } = solve(row);
        let label = format!("{} {} {}", row.prefilter, row.permitted, row.angle);
        let [printed_deceleration, printed_nearest, printed_overlap, printed_delay] = row.printed;
        let close = |ours: f64, printed: f64| {
            assert!((ours - printed).abs() <= 1e-3, "{label}: {ours}, printed {printed}");
        };
        close(deceleration, printed_deceleration);
        close(nearest, if contradicts_itself(row) { printed_delay } else { printed_nearest });
        close(overlap, printed_overlap);
        close(delay, printed_delay);
        assert!(error <= row.permitted && error >= 0.9998 * row.permitted, "{label}: {error}");
    }
}
