#[path = "../tests/common/mod.rs"]
mod common;
use common::{Kind, Random, random_move};
use seamline_cell::plan::timing::JointPath;
fn main() {
    let mut random = Random(1);
    let want: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let at: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
    for index in 0..=want {
        let kind = match index % 5 {
            0 => Kind::Arc,
            1 => Kind::BesideWrist,
            2 => Kind::BesideShoulder,
            _ => Kind::Line,
        };
        let mut job = random_move(&mut random, kind);
        if index == want {
            for k in -12..=12i32 {
                let d =
                    if k == 0 { 0.0 } else { f64::from(k.signum()) * 10f64.powf(-14.0 + f64::from(k.abs())) };
                if at + d < 0.0 || at + d > job.path.length() {
                    continue;
                }
                match job.path.jet(at + d) {
                    Ok(j) => println!(
                        "{d:.1e} q {:.6?} d1 {:.3?} d2 {:.2?}",
                        j.position, j.velocity, j.acceleration
                    ),
                    Err(e) => println!("{d:.1e} {e:?}"),
                }
            }
        }
    }
}
