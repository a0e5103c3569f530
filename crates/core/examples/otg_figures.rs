//! Draws the figures of docs/otg.md: `cargo run --features std --example otg_figures -- docs/figures`.
#![allow(clippy::print_stdout)] // a program

mod chart;

use std::path::Path;

use chart::{BOLD, Chart, DASHED, GREY, RED};

/// Duration and displacement of the members of the family for start (v0, a0) and end (vf, af), limits of acceleration `limit` either way, jerk
/// limit 1 (equation 2 of docs/otg.md), for valleys from the first possible one on.
fn arc(v0: f64, a0: f64, vf: f64, af: f64, limit: f64) -> Vec<(f64, f64)> {
    let (first, last) = (v0 - a0 * a0 / 2.0, vf - af * af / 2.0);
    let k = last * af + af.powi(3) / 6.0 - first * a0 - a0.powi(3) / 6.0;
    let bump = |root: f64| if root.abs() <= limit { 2.0 * root } else { limit + root * root / limit };
    let c = last - first;
    let from = if c >= 0.0 { -af } else { -a0 };
    (0..=400)
        .map(|i| from + 3.0 * f64::from(i) / 400.0)
        .map(|root| {
            // The smaller of peak and valley is the parameter.
            let other = (root * root + c.abs()).sqrt();
            let (x, n) = if c >= 0.0 { (other, root) } else { (root, other) };
            let (w, t_peak, t_valley) = (last + n * n, bump(x), bump(n));
            let p = (first + w) / 2.0 * t_peak + (w + last) / 2.0 * t_valley + k;
            (t_peak + t_valley + af - a0, p)
        })
        .collect()
}

/// Figure 1: the reachable interval of an axis that passes its start and its target at the same speed.
fn interval(folder: &Path) -> std::io::Result<()> {
    let (v, limit) = (1.0, 1.0);
    let up = arc(v, 0.0, v, 0.0, limit);
    let down: Vec<_> = arc(-v, 0.0, -v, 0.0, limit).into_iter().map(|(t, p)| (t, -p)).collect();
    let mut chart = Chart::new((0.0, 7.0), (-1.5, 5.0));
    let inside = |p: &&(f64, f64)| p.0 <= 7.0 && p.1 <= 5.0 && p.1 >= -1.5;
    let mut outline: Vec<_> = up.iter().filter(inside).copied().collect();
    outline.push((7.0, 5.0));
    outline.push((7.0, -1.5));
    outline.extend(down.iter().filter(inside).rev());
    chart.area(&outline, GREY);
    let curve = |points: &[(f64, f64)]| points.iter().filter(inside).copied().collect::<Vec<_>>();
    chart.line(&curve(&up), BOLD);
    chart.line(&curve(&down), BOLD);
    chart.axes("T", "displacement");
    let asked = 0.9;
    chart.line(&[(0.0, asked), (7.0, asked)], RED);
    chart.text((5.9, asked + 0.15), "asked for");
    chart.text((1.3, 4.0), "P⁺(T)");
    chart.text((3.2, -0.9), "P⁻(T)");
    chart.write(&folder.join("interval.svg"))
}

/// Figure 2: the acceleration of a member of the family.
fn family(folder: &Path) -> std::io::Result<()> {
    let (a0, x, n, af) = (0.4, 1.2, 0.8, -0.2);
    let (hold_x, hold_n) = (0.7, 0.5);
    let mut t = 0.0;
    let mut points = vec![(t, a0)];
    for (duration, a) in [(x - a0, x), (hold_x, x), (x + n, -n), (hold_n, -n), (n + af, af)] {
        t += duration;
        points.push((t, a));
    }
    let mut chart = Chart::new((-0.8, t + 0.8), (-1.4, 1.7));
    chart.axes("t", "a");
    chart.line(&[(-0.8, x), (t + 0.8, x)], DASHED);
    chart.line(&[(-0.8, -n), (t + 0.8, -n)], DASHED);
    chart.line(&[(-a0, 0.0), (0.0, a0)], DASHED);
    chart.line(&[(t, af), (t - af, 0.0)], DASHED);
    chart.line(&points, BOLD);
    chart.text((0.9, x + 0.1), "peak x");
    chart.text((3.5, -n - 0.2), "valley −n");
    chart.text((-0.55, -0.18), "v*");
    chart.text((t - af, 0.1), "v⁺");
    chart.text((x - a0 + hold_x + x, 0.1), "w");
    chart.text((0.05, a0 - 0.1), "a₀");
    chart.text((t + 0.05, af - 0.15), "a_f");
    chart.write(&folder.join("family.svg"))
}

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "docs/figures".into());
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    interval(folder)?;
    family(folder)?;
    println!("written to {}", folder.display());
    Ok(())
}
