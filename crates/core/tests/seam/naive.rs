//! The naive tracker: each reading is added to the position at once as the target of the generator. No look-ahead, no filter, no
//! feed-forward of what the seam does.

use seamline::otg::{Generator, Input, Limits, Output, State};
use seamline::path::SeamFrame;
use seamline::seam::TaughtPath;

use crate::simulation::{Figures, PERIOD, Seam, Torch, World};

const MM: f64 = 1e-3;

/// Runs a weld so. Along the path the torch travels at `speed` throughout, which is kind to it.
pub(crate) fn run<P: TaughtPath, S: Seam>(world: &mut World<'_, P, S>, speed: f64, from: f64) -> Figures {
    let (first, last) = world.path.span();
    let mut torch = Torch::new(first, world.delay);
    let mut figures = Figures::default();
    let limits = Limits::symmetric([500.0 * MM; 2], [5000.0 * MM; 2], [20_000.0 * MM; 2]);
    let at_rest = State::at_rest([0.0; 2]);
    let mut input = Input::new(at_rest, at_rest, limits);
    let (mut generator, mut output) = (Generator::new(PERIOD), Output::default());
    while torch.s < last {
        generator.update(&input, &mut output).expect("a finite target");
        output.pass_to_input(&mut input);
        let mut command = world.path.jet(torch.s).pose;
        let frame = SeamFrame::of(&world.path.jet(torch.s)).expect("a frame");
        let offset = input.current.position;
        command.translation.vector += frame.y * offset[0] + frame.z * offset[1];
        let (near, measured) = torch.follow(&command);
        for reading in world.readings(torch.time, torch.s, &measured) {
            input.target.position = [offset[0] + reading.lateral, offset[1] + reading.height];
        }
        world.score(&mut figures, &measured, near, from);
        torch.motion_figures(&mut figures, speed);
        torch.s += PERIOD * speed;
        torch.time += PERIOD;
    }
    figures
}
