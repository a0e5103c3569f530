//! The limits of a move along its path, from the move's speed and the cell's limits.

use seamline::geometry::Vector3;
use seamline::path::{Measure, Path};

use super::error::Problem;
use super::timing::PathLimits;
use crate::cell::CartesianLimits;
use crate::job::{Move, Speed};

/// At weld speeds the acceleration limits of the cell would be reached and left within a few cycles, for no gain in
/// time. So the acceleration is at most what gains the programmed speed in `GAIN`, and builds up in `BUILD_UP` (seconds).
const GAIN: f64 = 0.02;
const BUILD_UP: f64 = 0.01;

/// A path that could be run so many times as fast as programmed hardly bends.
const STRAIGHT: f64 = 2.0;
/// Places at which the bends of a path are looked at.
const LOOKS: u32 = 8;
/// Share of the cell's limits that is left to the motion along a path that bends, and to that across it, so that both together keep them.
const ON_BENDS: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// The highest speed at which the tool has no more acceleration and jerk across the path, on its bends, than these limits permit.
pub(super) fn on_bends(path: &Path, limits: &PathLimits) -> f64 {
    let at = |look: u32| path.jet(path.length() * f64::from(look) / f64::from(LOOKS)).linear;
    let of = |most: [f64; 2], [_, second, third]: [Vector3; 3]| {
        [most[0].max(second.norm_squared()), most[1].max(third.norm_squared())]
    };
    let [second, third] = (0..=LOOKS).map(at).fold([0.0; 2], of).map(f64::sqrt);
    // Without bends both are infinite.
    (limits.acceleration / second).sqrt().min((limits.jerk / third).cbrt())
}

/// What a path that bends leaves of the cell's limits to the motion along it, and to that across it.
pub(super) fn shared(limits: &PathLimits) -> PathLimits {
    PathLimits { acceleration: ON_BENDS * limits.acceleration, jerk: ON_BENDS * limits.jerk, ..*limits }
}

/// The limits of a path that bends: as slow as its bends ask for.
pub(super) fn bending(path: &Path, limits: &PathLimits) -> PathLimits {
    let shared = shared(limits);
    let across = on_bends(path, &shared);
    // Where it hardly bends, they are what they were.
    if across > STRAIGHT * limits.speed {
        return *limits;
    }
    PathLimits { speed: limits.speed.min(across), ..shared }
}

/// These limits, with no more acceleration and jerk along the path than its speed is worth.
pub(super) fn gentle(limits: &PathLimits) -> PathLimits {
    let acceleration = limits.speed / GAIN;
    let jerk = acceleration / BUILD_UP;
    PathLimits { acceleration: limits.acceleration.min(acceleration), jerk: limits.jerk.min(jerk), ..*limits }
}

/// The tag that a speed is written with.
pub(super) fn tag(speed: &Speed) -> &'static str {
    match speed {
        Speed::JointPercent(_) => "VJ=",
        Speed::Linear { .. } => "V=",
        Speed::Rotation { .. } => "VR=",
        Speed::ExternalPercent(_) => "VE=",
    }
}

/// Limits along the path coordinate: the move's speed, and no more than the cell permits to the tool centre point and
/// to its turning. A turn on the spot that only has a speed in mm/s turns at the cell's speed of turning.
pub(super) fn path_limits(path: &Path, r#move: &Move, cell: &CartesianLimits) -> Result<PathLimits, Problem> {
    let turn = path.pose(0.0).rotation.angle_to(&path.pose(path.length()).rotation);
    // Radians of turning per unit of the path coordinate.
    let turning = match path.measure() {
        Measure::Angle => 1.0,
        Measure::Length => turn / path.length(),
    };
    let permitted = |length: f64, rotation: f64| match path.measure() {
        Measure::Angle => rotation,
        Measure::Length if turning > 0.0 => length.min(rotation / turning),
        Measure::Length => length,
    };
    let asked = match (r#move.speed, path.measure()) {
        (Speed::Linear { mm_s }, Measure::Length) => mm_s / 1000.0,
        (Speed::Linear { .. }, Measure::Angle) => cell.rotation_speed,
        (Speed::Rotation { deg_s }, Measure::Angle) => deg_s.to_radians(),
        (Speed::Rotation { deg_s }, Measure::Length) if turning > 0.0 => deg_s.to_radians() / turning,
        (speed, _) => {
            return Err(Problem::Speed { found: tag(&speed), expected: "V=, or VR= where the tool turns" });
        }
    };
    let speed = asked.min(permitted(cell.speed, cell.rotation_speed));
    // The timing has one acceleration limit for both directions: the gentler of ACC and DEC.
    let share = r#move.acceleration.min(r#move.deceleration);
    let acceleration = share * permitted(cell.acceleration, cell.rotation_acceleration);
    let jerk = share * permitted(cell.jerk, cell.rotation_jerk);
    Ok(PathLimits { speed, acceleration, jerk })
}
