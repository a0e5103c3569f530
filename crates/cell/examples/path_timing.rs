//! Times random moves and prints planning time against motion time.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use common::{Kind, Random, joint_limits, random_move};
use seamline_cell::plan::timing::{JointPath, TimingKind, time_path};

fn main() {
    let joints = joint_limits();
    let mut random = Random(1);
    let count: usize = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(250);
    for index in 0..count {
        let kind = match index % 5 {
            0 => Kind::Arc,
            1 => Kind::BesideWrist,
            2 => Kind::BesideShoulder,
            _ => Kind::Line,
        };
        let mut job = random_move(&mut random, kind);
        let begun = Instant::now();
        let result = time_path(&mut job.path, &joints, &job.limits);
        let took = begun.elapsed().as_secs_f64();
        match result {
            Ok(timing) => {
                println!(
                    "{index} {kind:?} L {:.4} v {:.4} {:?} T {:.4} pieces {} ratio {:.0} {}",
                    job.path.length(),
                    job.limits.speed,
                    timing.kind(),
                    timing.duration(),
                    timing.pieces().len(),
                    timing.duration() / took,
                    if timing.kind() == TimingKind::Stretched { "STRETCHED" } else { "" }
                );
                for s in timing.slowdowns() {
                    println!("   {s:.5?}");
                }
            }
            Err(error) => println!(
                "{index} {kind:?} L {:.4} v {:.4} ERROR {error:?}",
                job.path.length(),
                job.limits.speed
            ),
        }
    }
}
