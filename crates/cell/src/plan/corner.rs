//! How one move runs on into the next.

use seamline::geometry::Vector3;
use seamline::path::Path;
use seamline::path::corner::{Blend, Corner, CornerZone, MustStop};

use super::route::Route;
use super::run::Stops;
use super::smear::{Bend, Smear};
use super::smeared_corner::Passing;
use super::speed::{gentle, on_bends, shared};
use super::timing::{PathLimits, least};

/// A zone reaches from its point as far as the faster move goes in this time, in seconds, but within these multiples of the permitted
/// error. So a slight bend between two long moves is rounded near the point only, and gently at speed.
const REACH_TIME: f64 = 0.1;
const REACH: [f64; 2] = [5.0, 20.0];
/// Share of a move that its zones at either end may take.
pub(super) const SHARE: f64 = 0.45;

/// Shares of the permitted error that a blend may have where prefilters add to it, the preferred one first: what is left serves the
/// corners next to it too.
pub(super) const BLEND_SHARES: [f64; 3] = [0.5, 0.375, 0.25];

pub(super) const NOTHING_PERMITTED: &str = "the cell permits no corner error here";

/// How a move passes into the next, at most `error` metres from the point between: nothing where they may run on as they are, otherwise
/// a blend. `paths` are what is left of the two moves, `lengths` those of the whole moves, `speed` the faster one's.
///
/// # Errors
/// Why the robot must stop between.
pub(super) fn passing(
    [before, after]: [&Path; 2],
    lengths: [f64; 2],
    speed: f64,
    error: f64,
) -> Result<Option<Blend>, Stops> {
    let [least, most] = REACH.map(|times| times * error);
    let reach = (REACH_TIME * speed).clamp(least, most);
    let [first, second] = lengths.map(|length| (SHARE * length).min(reach));
    let zone = CornerZone { position: error, orientation: None, room: [first.min(before.length()), second] };
    match Corner::between(before, after, &zone) {
        Corner::Smooth => Ok(None),
        Corner::Blend(blend) => Ok(Some(blend)),
        Corner::Stop(reason) => Err(Stops(match reason {
            MustStop::Apart => "the next move begins elsewhere",
            MustStop::OnTheSpot => "the next move turns on the spot",
            MustStop::Reversal => "the path turns back",
            MustStop::NothingPermitted => NOTHING_PERMITTED,
        })),
    }
}

/// The time that a blend by itself costs, with what prefilters add to its error; `speeds` are the greatest of the moves next to it and of
/// the blend, `hardest` their acceleration and jerk.
pub(super) fn lost_time(
    blend: &Blend,
    corner: Vector3,
    permitted: f64,
    (fastest, speed, hardest): (f64, f64, [f64; 2]),
    smear: &Smear,
    arc: bool,
) -> f64 {
    let mut route = Route::default();
    [blend.before, blend.path, blend.after].into_iter().for_each(|path| route.push(path));
    let ends = [route.start_of(1), route.start_of(2)];
    let passing = Passing { route: &route, blend: ends, corner, permitted, limits: hardest, fastest };
    passing.lost(&passing.pass(smear, &[Bend::default(); 2], arc), speed)
}

/// Whether a blend costs more time than to stop at the point, with limits along it, beside moves of which the slower one has this speed: then it
/// is so sharp that it is passed at next to no speed.
pub(super) fn takes_longer_than_a_stop(
    blend: &Blend,
    limits: &PathLimits,
    slower: f64,
    smear: Option<Smear>,
) -> bool {
    let lost = blend.path.length() * (1.0 / limits.speed - 1.0 / slower);
    let stop = slower / limits.acceleration + limits.acceleration / limits.jerk;
    lost > stop + smear.map_or(0.0, |smear| smear.length)
}

/// The gentler limits of both neighbours, as slow as the corner asks for: `permitted` is what the cell permits to either.
pub(super) fn limits(blend: &Blend, permitted: [&PathLimits; 2]) -> PathLimits {
    let least = least(permitted[0], permitted[1]);
    let shared = shared(&least);
    // Between two looks a sharp tip may bend more.
    let across = (shared.acceleration / blend.greatest_curvature).sqrt().min(on_bends(&blend.path, &shared));
    let along = gentle(&least);
    PathLimits {
        speed: least.speed.min(across),
        acceleration: along.acceleration.min(shared.acceleration),
        jerk: along.jerk.min(shared.jerk),
    }
}
