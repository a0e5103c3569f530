//! Weaves between WVON and WVOF: planned, executed by the cycle, judged by an independent arm model.

use nalgebra::Vector3;
use seamline_cell::cell::Cell;
use seamline_cell::job::{Action, Step, WeaveCondition, Zone};

use crate::bench::{planned, step};
use crate::chain::Way;

/// Travel in mm/s, in cycles of 1 ms.
const TRAVEL: f64 = 10.0;
const PERIOD: f64 = 1e-3;

/// A move to the seam, 90 mm that are woven, and 40 mm round a corner.
fn woven(condition: WeaveCondition, end: Zone) -> (Way, Vec<Step>) {
    let way = Way::in_cell(
        Cell::default_cell().unwrap(),
        &[([20.0, 0.0], 0.0), ([110.0, 0.0], 0.0), ([110.0, 40.0], 0.0)],
    );
    let zones = [Zone::Exact, end, Zone::Exact];
    let line = |(point, zone): (usize, &Zone)| way.lines(TRAVEL, *zone).swap_remove(point);
    let mut steps: Vec<Step> = zones.iter().enumerate().map(line).collect();
    steps.push(step(15, Action::WeaveOff));
    steps.insert(1, step(11, Action::WeaveOn(condition)));
    (way, steps)
}

fn wev(number: u32) -> WeaveCondition {
    WeaveCondition { file: Some(number), ..WeaveCondition::default() }
}

/// The tool along the seam, to its left and above it, in mm, from the second point on.
fn about_the_seam(way: &Way, tools: &[nalgebra::Isometry3<f64>]) -> Vec<[f64; 3]> {
    let (start, end) = (&way.poses[1], &way.poses[2]);
    let x = (end.translation.vector - start.translation.vector).normalize();
    let y = x.cross(&(start.rotation * Vector3::z())).normalize();
    let z = x.cross(&y);
    let parts = |tool: &nalgebra::Isometry3<f64>| {
        let off = (tool.translation.vector - start.translation.vector) * 1000.0;
        [off.dot(&x), off.dot(&y), off.dot(&z)]
    };
    tools.iter().map(parts).collect()
}

/// The sine of the default cell, 2 mm and 3 Hz at 10 mm/s: its amplitude, its frequency and the speed of travel
/// within 1 % away from its ends, no height, the joints' limits kept, and the seam's points themselves at its ends.
#[test]
fn a_sine_has_its_amplitude_its_frequency_and_its_travel() {
    let (way, steps) = woven(wev(1), Zone::Exact);
    let trace = way.run(&way.plan(&steps));
    for point in [1, 2] {
        assert!(trace.distance(&way.poses[point]) < 2e-3, "{}", trace.distance(&way.poses[point]));
    }
    let places = about_the_seam(&way, &trace.tools);
    let middle: Vec<_> = places.into_iter().filter(|[x, ..]| (15.0..75.0).contains(x)).collect();
    let middle: Vec<_> = middle.into_iter().filter(|[_, y, _]| y.abs() < 5.0).collect();
    let edges = middle.iter().fold([0.0_f64; 2], |[l, r], [_, y, _]| [l.max(*y), r.max(-y)]);
    assert!(edges.iter().all(|edge| (edge - 2.0).abs() < 0.02), "{edges:?}");
    let height = middle.iter().map(|[_, _, z]| z.abs()).fold(0.0, f64::max);
    assert!(height < 0.01, "{height}");
    let crossings: Vec<usize> =
        (1..middle.len()).filter(|&k| middle[k - 1][1] < 0.0 && middle[k][1] >= 0.0).collect();
    let periods = (crossings.len() - 1) as f64;
    let frequency = periods / ((crossings[crossings.len() - 1] - crossings[0]) as f64 * PERIOD);
    assert!(periods > 10.0 && (frequency - 3.0).abs() < 0.03, "{frequency}");
    let worst =
        middle.windows(2).map(|p| ((p[1][0] - p[0][0]) / PERIOD / TRAVEL - 1.0).abs()).fold(0.0, f64::max);
    assert!(worst < 0.01, "{worst}");
}

/// Past a corner the torch does not stop, and passes on the seam: the corner's error is the permitted one.
#[test]
fn a_corner_is_passed_without_weave_and_without_stop() {
    let (way, steps) = woven(wev(1), Zone::Unspecified);
    let trace = way.run(&way.plan(&steps));
    let error = trace.distance(&way.poses[2]);
    assert!((0.3..=0.501).contains(&error), "{error}");
    let speeds = trace.speeds();
    let at =
        trace.tools.iter().map(|tool| (tool.translation.vector - way.poses[2].translation.vector).norm());
    let nearest = at.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap().0;
    assert!(speeds[nearest - 50..nearest + 50].iter().all(|speed| *speed > 0.98 * TRAVEL));
}

/// All four patterns go, with dwells and tilt and elevation where they have them; each reaches its edges.
#[test]
fn every_pattern_reaches_its_edges() {
    for (pattern, dwell) in [("sine", 0.05), ("triangle", 0.05), ("figure_eight", 0.0), ("circular", 0.0)] {
        let text = format!(
            "[[weave]]\nnumber = 1\npattern = \"{pattern}\"\namplitude_mm = 1.5\nfrequency_hz = 2.0\n\
             dwell_left_s = {dwell}\ndwell_right_s = {dwell}\nelevation_mm = 0.5\n"
        );
        let (way, steps) = woven(wev(1), Zone::Exact);
        let cell = Cell::parse(&text, "cell.toml").unwrap();
        let parts = planned(&cell, &way.arm, &steps).unwrap();
        let places = about_the_seam(&way, &way.run(&parts).tools);
        let middle = places.iter().filter(|[x, y, _]| (20.0..70.0).contains(x) && y.abs() < 5.0);
        let [left, right, height] =
            middle.fold([0.0_f64; 3], |[l, r, h], [_, y, z]| [l.max(*y), r.max(-y), h.max(*z)]);
        assert!((left - 1.5).abs() < 0.015 && (right - 1.5).abs() < 0.015, "{pattern}: {left} {right}");
        assert!((height - 0.5).abs() < 0.02, "{pattern}: {height}");
    }
}

/// A weave that shakes harder than the cell permits is refused at its move, with what would agree; and that does.
#[test]
fn what_does_not_agree_is_refused_with_what_would() {
    let hard =
        WeaveCondition { amplitude_mm: Some(4.0), frequency_hz: Some(6.0), ..WeaveCondition::default() };
    let (way, steps) = woven(hard, Zone::Exact);
    let cell = Cell::default_cell().unwrap();
    let error = planned(&cell, &way.arm, &steps).unwrap_err().to_string();
    assert!(error.contains("weave_jerk_mm_s3") && error.contains("it works with an amplitude of"), "{error}");
    let numbers: Vec<f64> = error.split(' ').filter_map(|word| word.parse().ok()).collect();
    let [amplitude, frequency] = [numbers[numbers.len() - 2], numbers[numbers.len() - 1]];
    for milder in [
        WeaveCondition { amplitude_mm: Some(amplitude), ..hard },
        WeaveCondition { frequency_hz: Some(frequency), ..hard },
    ] {
        let (way, steps) = woven(milder, Zone::Exact);
        assert!(planned(&cell, &way.arm, &steps).is_ok(), "{milder:?}");
    }
}

/// A condition that the cell does not have, and none at all.
#[test]
fn a_weave_without_condition_is_refused() {
    for (condition, text) in [
        (wev(7), "WEV#(7) is not in the cell file"),
        (WeaveCondition::default(), "WVON has no condition: expected WEV#(n), or AMP= and FREQ="),
    ] {
        let (way, steps) = woven(condition, Zone::Exact);
        let error = planned(&Cell::default_cell().unwrap(), &way.arm, &steps).unwrap_err().to_string();
        assert!(error.contains(text), "{error}");
    }
}
