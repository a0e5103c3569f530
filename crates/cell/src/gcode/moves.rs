//! Steps of the program's moves.

use seamline::geometry::Vector3;

use crate::job::{
    Action, ArcPart, CircularArc, Configuration, Coordinates, CurvePiece, Frame, JobPosition, Location, Move,
    MovePath, Rectangular, Speed, SpeedOrigin, Step, Target, Zone,
};

/// Orientation of the tool in the work frame, as Rx, Ry, Rz: its z axis points down, its x axis along the frame's.
const DOWN_DEG: [f64; 3] = [180.0, 0.0, 0.0];
/// The tool that the program moves.
const TOOL: u32 = 0;

/// What all points of a program have in common at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Holding {
    /// User frame of the cell.
    pub(super) frame: u32,
    pub(super) configuration: Configuration,
}

/// How a move goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Manner {
    pub(super) speed: Speed,
    pub(super) zone: Zone,
}

impl Holding {
    fn target(&self, point: &Vector3) -> Target {
        let rectangular = Rectangular {
            position_mm: (*point).into(),
            rotation_deg: DOWN_DEG,
            elbow_deg: None,
            frame: Frame::User(self.frame),
            configuration: self.configuration,
        };
        let position = JobPosition { coordinates: Coordinates::Rectangular(rectangular), tool: TOOL };
        Target { name: None, position }
    }

    fn step(&self, at: Location, path: MovePath, end: &Vector3, manner: &Manner) -> Step {
        let motion = Move {
            path,
            target: self.target(end),
            speed: manner.speed,
            speed_origin: SpeedOrigin::Written,
            zone: manner.zone,
            acceleration: 1.0,
            deceleration: 1.0,
            no_wait: false,
        };
        Step { at, action: Action::Move(Box::new(motion)), notes: Vec::new() }
    }

    /// All joints together.
    pub(super) fn joint(&self, at: Location, end: &Vector3, manner: &Manner) -> Step {
        self.step(at, MovePath::Joint, end, manner)
    }

    pub(super) fn line(&self, at: Location, end: &Vector3, manner: &Manner) -> Step {
        self.step(at, MovePath::Linear, end, manner)
    }

    /// Part of a circle.
    pub(super) fn circle(&self, at: Location, [start, via, end]: [&Vector3; 3], manner: &Manner) -> Step {
        let points = [start, via, end].map(|point| self.target(point));
        let path = MovePath::Circular(Box::new(CircularArc { points, part: ArcPart::Whole }));
        self.step(at, path, end, manner)
    }

    pub(super) fn curve(&self, at: Location, curve: CurvePiece, manner: &Manner) -> Step {
        self.step(at, MovePath::Curve(Box::new(curve)), &curve.end.position_mm, manner)
    }
}
