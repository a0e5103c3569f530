//! Weaves between WVON and WVOF: planned, executed by the cycle, judged by an independent arm model.

use nalgebra::{Isometry3, Vector3};
use seamline::control::{Event, Mode};
use seamline_cell::cell::Cell;
use seamline_cell::job::{
    Action, ArcCondition, ArcPart, CircularArc, MovePath, Speed, Step, Target, WeaveCondition, Zone,
};
use seamline_cell::plan::Planned;

use crate::bench::{Bench, Random, commands, flexible, move_to, on_feedrate, planned, step};
use crate::chain::{Trace, Way};
use crate::weld::{at_random_instants, default_cell, go_on, track};

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
fn about_the_seam(way: &Way, tools: &[Isometry3<f64>]) -> Vec<[f64; 3]> {
    about_the_line(way, 1, tools)
}

/// The same about the line that begins at a point.
fn about_the_line(way: &Way, point: usize, tools: &[Isometry3<f64>]) -> Vec<[f64; 3]> {
    let (start, end) = (&way.poses[point], &way.poses[point + 1]);
    let x = (end.translation.vector - start.translation.vector).normalize();
    let y = x.cross(&(start.rotation * Vector3::z())).normalize();
    let z = x.cross(&y);
    let parts = |tool: &Isometry3<f64>| {
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

/// The cycles in which the tool goes from right to left over the line that begins at a point, at least 5 mm from its ends; with the share of the
/// cycle.
fn crossings(way: &Way, point: usize, trace: &Trace) -> Vec<f64> {
    let length = (way.poses[point + 1].translation.vector - way.poses[point].translation.vector).norm() * 1e3;
    let places = about_the_line(way, point, &trace.tools);
    let crosses = |k: &usize| {
        let ([x, from, _], [_, to, _]) = (places[k - 1], places[*k]);
        (5.0..length - 5.0).contains(&x) && from.abs() < 3.0 && from < 0.0 && to >= 0.0
    };
    let cycles = (1..places.len()).filter(crosses);
    cycles.map(|k| k as f64 - places[k][1] / (places[k][1] - places[k - 1][1])).collect()
}

/// How far apart crossings are, in periods of a frequency.
fn periods(crossings: &[f64], frequency: f64) -> Vec<f64> {
    crossings.windows(2).map(|pair| (pair[1] - pair[0]) * PERIOD * frequency).collect()
}

/// Points on one line, as far as pulses tell: the weave goes on over them with full amplitude, in step, and without a stop; so does a slight bend of
/// half a degree.
#[test]
fn a_weave_goes_on_over_points_on_a_line() {
    for bend in [0.0, 0.25] {
        let points = [
            ([20.0, 0.0], 0.0),
            ([50.0, 0.0], 0.0),
            ([80.0, bend], 0.0),
            ([110.0, bend], 0.0),
            ([130.0, bend], 0.0),
        ];
        let way = Way::in_cell(default_cell(), &points);
        let mut steps = way.lines(TRAVEL, Zone::Unspecified);
        steps[0] = way.step(1, MovePath::Linear, TRAVEL, Zone::Exact);
        steps.insert(1, step(11, Action::WeaveOn(wev(1))));
        let trace = way.run(&way.plan(&steps));
        let places = about_the_seam(&way, &trace.tools);
        for from in [15.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0, 85.0] {
            let here = places.iter().filter(|[x, ..]| (from..from + 5.0).contains(x));
            let middle = if from < 50.0 { 0.0 } else { bend };
            let [left, right] = here.fold([f64::MIN, f64::MAX], |[l, r], [_, y, _]| [l.max(*y), r.min(*y)]);
            let middle = if bend == 0.0 { middle } else { 0.5 * (left + right) };
            assert!(
                (left - middle - 2.0).abs() < 0.02 && (middle - right - 2.0).abs() < 0.02,
                "{left} {right}"
            );
        }
        let along: Vec<f64> = [1, 2, 3].iter().flat_map(|point| crossings(&way, *point, &trace)).collect();
        for count in periods(&along, 3.0) {
            assert!(count > 0.5 && (count - count.round()).abs() < 0.02, "{bend}: {count}");
        }
    }
}

/// Round a corner the weave is on the seam, and goes on behind it as if it had gone on all the time; so it does behind a stop.
#[test]
fn behind_a_corner_the_weave_is_in_step() {
    for zone in [Zone::Unspecified, Zone::Exact] {
        let (way, steps) = woven(wev(1), zone);
        let trace = way.run(&way.plan(&steps));
        let (before, after) = (crossings(&way, 1, &trace), crossings(&way, 2, &trace));
        assert!(before.len() > 15 && after.len() > 5, "{} {}", before.len(), after.len());
        let mut between = periods(&[before[before.len() - 1], after[0]], 3.0)[0];
        if zone == Zone::Exact {
            // The stop costs time on no way: the way is what counts.
            let corner = way.poses[2].translation.vector;
            let way_to = |cycle: f64| (trace.tools[cycle as usize].translation.vector - corner).norm() * 1e3;
            between = (way_to(before[before.len() - 1]) + way_to(after[0])) * 3.0 / TRAVEL;
        }
        assert!((between - between.round()).abs() < 0.03, "{zone:?}: {between}");
    }
}

/// A line, a half circle of `radius` mm to one side and a line, which lead into each other, with their conditions: the steps, with a weave from the
/// first point on.
fn round(way: &Way, mm_s: f64, condition: WeaveCondition) -> Vec<Step> {
    let target = |point: usize| {
        let speed = Speed::Linear { mm_s };
        let step = move_to(point as u32, MovePath::Linear, speed, &way.arm, &way.joints[point]);
        let Action::Move(r#move) = step.action else { unreachable!() };
        r#move.target
    };
    let points: [Target; 3] = [2, 3, 4].map(target);
    let arc = MovePath::Circular(Box::new(CircularArc { points, part: ArcPart::Whole }));
    vec![
        way.step(1, MovePath::Linear, mm_s, Zone::Exact),
        step(11, Action::WeaveOn(condition)),
        way.step(2, MovePath::Linear, mm_s, Zone::Unspecified),
        way.step(4, arc, mm_s, Zone::Unspecified),
        way.step(5, MovePath::Linear, mm_s, Zone::Exact),
    ]
}

fn half_circle(cell: Cell, radius: f64, side: f64) -> Way {
    let points = [
        ([10.0, 0.0], 0.0),
        ([40.0, 0.0], 0.0),
        ([40.0 + radius, side * radius], 0.0),
        ([40.0, side * 2.0 * radius], 0.0),
        ([10.0, side * 2.0 * radius], 0.0),
    ];
    Way::in_cell(cell, &points)
}

/// From a line into an arc and out again the weave goes on: its distance from the seam, by the arm model, has the amplitude all along, and the
/// tool crosses the seam in step.
#[test]
fn a_weave_follows_the_tangent_of_an_arc() {
    let radius = 30.0;
    let way = half_circle(default_cell(), radius, 1.0);
    let trace = way.run(&way.plan(&round(&way, TRAVEL, wev(1))));
    let centre = 0.5 * (way.poses[2].translation.vector + way.poses[4].translation.vector);
    let axis = (way.poses[2].translation.vector - way.poses[1].translation.vector).normalize();
    let across = (way.poses[4].translation.vector - centre).normalize();
    let mut offsets: Vec<(f64, f64)> = Vec::new();
    for tool in &trace.tools {
        let off = (tool.translation.vector - centre) * 1e3;
        let (x, y) = (off.dot(&axis), off.dot(&across));
        // Where it is along the seam, the travel there, and the seam's place.
        let (place, travel, seam) = if x > 0.0 {
            let (sin, cos) = y.atan2(x).sin_cos();
            let place = 30.0 + radius * (y.atan2(x) + std::f64::consts::FRAC_PI_2);
            (place, across * cos - axis * sin, (axis * cos + across * sin) * radius)
        } else {
            let place = if y < 0.0 { 30.0 + x } else { 30.0 + radius * std::f64::consts::PI - x };
            (place, -axis * y.signum(), axis * x + across * radius * y.signum())
        };
        let left = travel.cross(&(tool.rotation * Vector3::z())).normalize();
        let (aside, rest) = ((off - seam).dot(&left), off - seam - left * (off - seam).dot(&left));
        assert!(
            rest.norm() < 0.05 || aside.abs() > 3.0,
            "at {place} mm: {rest} beside the weave's direction"
        );
        offsets.push((place, aside));
    }
    let whole = 60.0 + radius * std::f64::consts::PI;
    let mut from = 10.0;
    while from + 5.0 < whole - 10.0 {
        let here = offsets.iter().filter(|(place, _)| (from..from + 5.0).contains(place));
        let [left, right] = here.fold([0.0_f64; 2], |[l, r], (_, off)| [l.max(*off), r.max(-off)]);
        assert!((left - 2.0).abs() < 0.03 && (right - 2.0).abs() < 0.03, "at {from} mm: {left} {right}");
        from += 2.5;
    }
}

/// The greatest jerk of the tool in m/s³, by third differences over several cycles.
fn greatest_jerk(tools: &[Isometry3<f64>]) -> f64 {
    const STEP: usize = 3;
    let h = STEP as f64 * PERIOD;
    let at = |k: usize| tools[k].translation.vector;
    let third = |k: usize| at(k + 3 * STEP) - 3.0 * at(k + 2 * STEP) + 3.0 * at(k + STEP) - at(k);
    (0..tools.len() - 3 * STEP).map(|k| third(k).norm() / (h * h * h)).fold(0.0, f64::max)
}

/// On an arc of 10 mm radius a circular weave that would do on a straight seam is refused at the arc, with the turn and an amplitude that works; with that
/// the tool's jerk, by the arm model and differences, stays within the limit, and the straight seam's bound is passed.
#[test]
fn a_bend_counts_in_what_a_weave_asks_for() {
    let (mm_s, frequency) = (20.0, 5.0);
    let text = "[[weave]]\nnumber = 1\npattern = \"circular\"\namplitude_mm = 1.0\nfrequency_hz = 5.0\n\
                [cartesian]\nweave_jerk_mm_s3 = 36000\n[job]\n";
    let cell = Cell::parse(text, "cell.toml").unwrap();
    let mut jerks = Vec::new();
    for side in [1.0, -1.0] {
        let way = half_circle(cell.clone(), 10.0, side);
        let error = planned(&cell, &way.arm, &round(&way, mm_s, wev(1))).unwrap_err().to_string();
        assert!(error.contains("seam and wire turn by") && error.contains("weave_jerk_mm_s3"), "{error}");
        let numbers: Vec<f64> = error.split(' ').filter_map(|word| word.parse().ok()).collect();
        let amplitude = numbers[numbers.len() - 2];
        assert!(amplitude < 1.0, "{error}");
        let milder = WeaveCondition { amplitude_mm: Some(amplitude), ..wev(1) };
        let trace = way.run(&way.plan(&round(&way, mm_s, milder)));
        // Segments: the way to it, the line, the bend into the arc, the arc, the bend out of it, the line.
        let on_arc = |segment: &u32| (3..=5).contains(segment);
        let first = trace.segments.iter().position(on_arc).unwrap();
        let last = trace.segments.iter().rposition(on_arc).unwrap();
        let jerk = greatest_jerk(&trace.tools[first..=last]);
        let straight = amplitude * 1e-3 * (std::f64::consts::TAU * frequency).powi(3);
        println!("{side}: {amplitude} mm, jerk {jerk} m/s³, on a straight seam {straight} m/s³");
        assert!(jerk <= 36.0, "{jerk}");
        jerks.push(jerk / straight);
    }
    assert!(jerks.iter().any(|share| *share > 1.2), "{jerks:?}");
}

fn notices(parts: &[Planned<6>]) -> Vec<&String> {
    parts.iter().flat_map(|part| &part.notices).collect()
}

/// Behind a prefilter a weave is narrower, by what the remark says within 1 %; the joints' limits hold, and travel is as programmed. One of which
/// less than half would be left is refused.
#[test]
fn what_a_prefilter_leaves_of_a_weave_is_said() {
    for (name, mode, pattern) in
        [("zv", 8.0, "sine"), ("zvd", 12.0, "sine"), ("fir", 9.0, "triangle"), ("ei", 10.0, "circular")]
    {
        let plain = flexible(name, &[mode]);
        let text = format!(
            "[[weave]]\nnumber = 1\npattern = \"{pattern}\"\namplitude_mm = 2.0\nfrequency_hz = 2.5\n"
        );
        let mut cell = Cell::parse(&text, "cell.toml").unwrap();
        (cell.vibration, cell.arc) = (plain.vibration.clone(), plain.arc);
        let (way, steps) = woven(wev(1), Zone::Exact);
        let parts = planned(&cell, &way.arm, &steps).unwrap();
        let said = notices(&parts).into_iter().find(|text| text.contains("the prefilter leaves")).unwrap();
        let left: f64 = said.split(' ').nth(3).unwrap().parse().unwrap();
        let trace = Way { cell: cell.clone(), ..way.clone() }.run(&parts);
        let middle = about_the_seam(&way, &trace.tools);
        let middle = middle.iter().filter(|[x, y, _]| (20.0..70.0).contains(x) && y.abs() < 5.0);
        let [first, second] = middle.fold([0.0_f64; 2], |[l, r], [_, y, _]| [l.max(*y), r.max(-y)]);
        println!("{name}: {said}: {first} {second}");
        assert!((first - left).abs() < 0.02 && (second - left).abs() < 0.02, "{said}: {first} {second}");
        let along = crossings(&way, 1, &trace);
        let travel = periods(&along, 2.5).iter().map(|count| (count - 1.0).abs()).fold(0.0, f64::max);
        assert!(travel < 0.01, "{name}: {travel}");
    }
    let fast =
        WeaveCondition { frequency_hz: Some(6.0), amplitude_mm: Some(0.5), ..WeaveCondition::default() };
    let (way, steps) = woven(fast, Zone::Exact);
    let error = planned(&flexible("zvd", &[8.0]), &way.arm, &steps).unwrap_err().to_string();
    assert!(error.contains("the prefilter leaves") && error.contains("expected at least 50 %"), "{error}");
}

/// A prefilter on the feedrate leaves a weave its size, and nothing need be said.
#[test]
fn a_prefilter_on_the_feedrate_leaves_a_weave_as_it_is() {
    for name in ["zv", "fir-zvd"] {
        let cell = on_feedrate(name, &[8.0]);
        let (way, steps) = woven(wev(1), Zone::Exact);
        let parts = planned(&cell, &way.arm, &steps).unwrap();
        assert_eq!(notices(&parts), Vec::<&String>::new());
        let trace = Way { cell: cell.clone(), ..way.clone() }.run(&parts);
        let middle = about_the_seam(&way, &trace.tools);
        let middle = middle.iter().filter(|[x, y, _]| (20.0..70.0).contains(x) && y.abs() < 5.0);
        let [first, second] = middle.fold([0.0_f64; 2], |[l, r], [_, y, _]| [l.max(*y), r.max(-y)]);
        assert!((first - 2.0).abs() < 0.02 && (second - 2.0).abs() < 0.02, "{name}: {first} {second}");
    }
}

/// A MOVJ within a weave is said to go without.
#[test]
fn a_joint_move_goes_without_weave() {
    let (way, mut steps) = woven(wev(1), Zone::Exact);
    steps.insert(3, move_to(12, MovePath::Joint, Speed::JointPercent(20.0), &way.arm, &way.joints[1]));
    let parts = way.plan(&steps);
    assert!(
        notices(&parts).iter().any(|text| text.contains("MOVJ goes without weave")),
        "{:?}",
        notices(&parts)
    );
    assert_eq!(notices(&way.plan(&woven(wev(1), Zone::Exact).1)), Vec::<&String>::new());
}

/// A weld with a weave round a corner, interrupted at random instants: pause and resume, back along the path for a random time, or an override.
/// The arm keeps to the path of the run that nothing interrupts (1 µm, 4 µrad) and to its limits; every twentieth job is run to its end.
fn interrupted(seed: u64, count: usize) {
    let (way, mut steps) = woven(wev(1), Zone::Unspecified);
    let condition = ArcCondition { file: Some(1), ..ArcCondition::default() };
    steps.push(step(16, Action::ArcOff(condition)));
    steps.insert(1, step(10, Action::ArcOn(condition)));
    let mut bench = Bench::welding(&way.cell, &way.arm, commands(&way.plan(&steps)));
    bench.cycle_with(Event::Start);
    let track = track(&bench);
    let mut backed = 0.0_f64;
    at_random_instants(&bench, &track, &mut Random(seed), count, |k, mut ride, random| {
        if k % 3 == 2 {
            ride.bench.input.speed_override = random.within(0.1, 1.0);
            (0..(random.unit() * 1_000.0) as usize).for_each(|_| {
                ride.cycle(Some(&track));
            });
            ride.bench.input.speed_override = 1.0;
            (0..200).for_each(|_| {
                ride.cycle(Some(&track));
            });
        } else {
            ride.ask(&track, Event::Hold);
            ride.until(&track, 1_000, |_, output| output.status.at_rest);
            let stopped = ride.way;
            if k % 3 == 1 {
                ride.ask(&track, Event::BackUp);
                (0..(random.unit() * 2_000.0) as usize).for_each(|_| {
                    ride.cycle(Some(&track));
                });
                backed = backed.max(stopped - ride.way);
                if ride.bench.cycle.mode() == Mode::Backing {
                    ride.ask(&track, Event::Hold);
                }
                ride.until(&track, 1_000, |_, output| output.status.at_rest);
            }
            go_on(&mut ride, &track, Event::Resume);
        }
        if k % 20 == 0 && ride.bench.cycle.mode() == Mode::Running {
            ride.until(&track, 40_000, |_, output| output.status.mode == Mode::Standstill);
            assert_eq!(ride.rows.last(), track.rows.last());
        }
        ride.assert_within_limits(&way.arm);
    });
    println!("{count} interruptions; back by up to {:.1} mm", backed * 1e3);
    assert!(backed > 0.02, "{backed}");
}

#[test]
fn an_interrupted_weave_keeps_to_its_path() {
    interrupted(31, 90);
}

/// `cargo test --release -p seamline-cell --test machine hundreds_of -- --ignored --nocapture`.
#[test]
#[ignore = "takes a minute"]
fn hundreds_of_interruptions_of_a_weave() {
    interrupted(32, 900);
}
