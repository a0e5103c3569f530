//! Polar coordinates of a moving point, also through their centre.

use super::STILL;
use crate::math::float::sin_cos;
use crate::math::taylor::Taylor;

/// A radius below this part of its full size is zero but for rounding.
const VANISHING: f64 = 1e-12;

/// Radius (with a sign: the point lies at radius·(cos angle, sin angle)) and angle of a moving point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Polar {
    pub(crate) radius: Taylor,
    pub(crate) angle: Taylor,
    /// The point rests at the centre: its angle could be any.
    pub(crate) at_rest: bool,
}

impl Polar {
    /// Of a point that moves as (x, y), at these values of radius and angle, which are taken to be known better than the
    /// point itself. `size` is the radius' full size, `variation` the whole motion's relative to it.
    ///
    /// At the centre the angle has derivatives only where the point passes straight through it (the radius then changes
    /// its sign, and the angle stands still) or rests there. Otherwise there is no answer.
    #[inline]
    pub(crate) fn of(
        [x, y]: [Taylor; 2],
        radius: f64,
        angle: f64,
        size: f64,
        variation: f64,
    ) -> Option<Self> {
        let (sin, cos) = sin_cos(angle);
        let along = (x * cos + y * sin).with_value(radius);
        let across = (y * cos - x * sin).with_value(0.0);
        if radius.abs() > VANISHING * size {
            let turned = Taylor::angle(along, across, 0.0);
            // The component along the turning direction: no square of a small radius, no root.
            let (sin_turned, cos_turned) = turned.sin_cos();
            let radius = along * cos_turned + across * sin_turned;
            return Some(Self { radius, angle: turned + angle, at_rest: false });
        }
        let still = STILL * size * variation;
        (across.variation() <= still).then(|| Self {
            radius: along,
            angle: Taylor::constant(angle),
            at_rest: along.variation() <= still,
        })
    }
}
