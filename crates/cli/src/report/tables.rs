//! The parts of the page that need no script.

use seamline_cell::record::{Incident, MoveFigures, Summary, TimeFigures, Verdict, rounded};

/// Text with nothing that HTML would read as markup.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            other => escaped.push(other),
        }
    }
    escaped
}

pub(super) fn header(summary: &Summary) -> String {
    let class = if summary.verdict == Verdict::Ok { "ok" } else { "over" };
    let sum =
        |value: fn(&MoveFigures) -> f64| summary.moves.iter().filter(|of| of.arc).map(value).sum::<f64>();
    let weld_time = sum(|of| of.end_s - of.start_s);
    let weld_length = sum(|of| of.length_mm.unwrap_or(0.0));
    let mut facts = vec![(format!("{:.2} s", summary.duration_s), "motion")];
    if weld_time > 0.0 {
        facts.push((format!("{weld_time:.2} s"), "arc on"));
        facts.push((format!("{} mm", rounded(weld_length)), "weld length"));
    }
    facts.push((summary.cycles.to_string(), "cycles"));
    facts.push((format!("{} ms", summary.period_ms), "period"));
    if let Some(factor) = summary.real_time_factor {
        facts.push((format!("{} ×", rounded(factor)), "real time"));
    }
    let fact = |(value, name): &(String, &str)| format!("<div><b>{value}</b><span>{name}</span></div>");
    format!(
        "<header><div class=\"name\"><h1>{}</h1><span>on {}</span></div><span class=\"verdict {class}\">{}</span>\
        <div class=\"facts\">{}</div><nav><a href=\"#path\">Path</a><a href=\"#joints\">Joints</a>\
        <a href=\"#moves\">Moves</a><a href=\"#times\">Times</a></nav></header>",
        escaped(&summary.job),
        escaped(&summary.robot),
        summary.verdict.name(),
        facts.iter().map(fact).collect::<String>(),
    )
}

pub(super) fn checks(summary: &Summary) -> String {
    let row = |check: &seamline_cell::record::Check| {
        let (class, sign) = if check.ok { ("ok", "✓") } else { ("over", "✗") };
        // A bar that is full at the bound.
        let bar = if check.bound > 0.0 {
            let share = 100.0 * (check.value / check.bound).clamp(0.0, 1.0);
            format!("<div class=\"used\"><i style=\"width:{share:.1}%\"></i></div>")
        } else {
            String::new()
        };
        format!(
            "<tr class=\"{class}\"><td class=\"sign\">{sign}</td><td>{}<small>{}</small></td>\
            <td class=\"number\">{}{bar}</td>\
            <td class=\"number\">≤ {}</td><td class=\"unit\">{}</td></tr>",
            check.name,
            escaped(&check.place),
            rounded(check.value),
            check.bound,
            check.unit
        )
    };
    format!(
        "<div class=\"panel\"><table class=\"checks\"><thead><tr><th></th><th>figure</th><th class=\"number\">worst</th>\
        <th class=\"number\">bound</th><th></th></tr></thead><tbody>{}</tbody></table></div>",
        summary.checks.iter().map(row).collect::<String>()
    )
}

/// Faults and notices, faults first.
pub(super) fn incidents(summary: &Summary) -> String {
    let row = |class: &str, incident: &Incident| {
        format!(
            "<p class=\"{class}\"><b>{class}</b> at {:.3} s, line {}: {}</p>",
            incident.time_s,
            incident.line,
            escaped(&incident.text)
        )
    };
    let mut rows: String = summary.faults.iter().map(|incident| row("fault", incident)).collect();
    if summary.overruns > 0 {
        let text = format!("{} of {} cycles were late by a period or more", summary.overruns, summary.cycles);
        rows += &format!("<p class=\"notice\"><b>overruns</b>: {text}</p>");
    }
    rows += &summary.notices.iter().map(|incident| row("notice", incident)).collect::<String>();
    if rows.is_empty() { rows } else { format!("<div class=\"incidents\">{rows}</div>") }
}

pub(super) fn moves(summary: &Summary) -> String {
    let cell = |value: Option<f64>| {
        value.map_or_else(
            || "<td></td>".to_owned(),
            |value| format!("<td class=\"number\">{}</td>", rounded(value)),
        )
    };
    let row = |of: &MoveFigures| {
        let class = if of.arc { " class=\"arc\"" } else { "" };
        [
            format!("<tr{class} data-from=\"{}\" data-to=\"{}\">", of.start_s, of.end_s),
            format!("<td class=\"number\">{}</td><td>{}</td>", of.line, of.kind),
            format!("<td>{}</td>", if of.arc { "on" } else { "" }),
            format!("<td class=\"number\">{:.3}</td>", of.start_s),
            format!("<td class=\"number\">{:.3}</td>", of.end_s - of.start_s),
            cell(of.length_mm),
            cell(of.speed_programmed_mm_s),
            cell(of.speed_min_mm_s),
            cell(of.speed_max_mm_s),
            cell(of.path_deviation_max_mm().or(of.corner_error_mm).map(|mm| mm * 1e3)),
            cell(of.orientation_deviation_max_rad.map(|rad| rad * 1e6)),
            "</tr>".to_owned(),
        ]
        .concat()
    };
    format!(
        "<section id=\"moves\"><h2>Moves</h2><p class=\"hint\">Click a row to see it in the plots. \
        Deviations are the greatest from the programmed line or arc, and from the programmed orientation; of a corner, how \
        near it was passed. Speeds are the least and greatest in the constant part.</p>\
        <div class=\"panel scroll\"><table><thead><tr><th class=\"number\">line</th><th>move</th><th>arc</th>\
        <th class=\"number\">start s</th><th class=\"number\">time s</th><th class=\"number\">length mm</th>\
        <th class=\"number\">programmed mm/s</th><th class=\"number\">least mm/s</th>\
        <th class=\"number\">greatest mm/s</th><th class=\"number\">deviation µm</th>\
        <th class=\"number\">orientation µrad</th></tr></thead><tbody>{}</tbody></table></div></section>",
        summary.moves.iter().map(row).collect::<String>()
    )
}

pub(super) fn computing_times(summary: &Summary) -> String {
    let times: Vec<_> = summary.stage_times_us.iter().chain(&summary.lateness_us).collect();
    if times.is_empty() {
        return String::new();
    }
    let edges = || times.iter().flat_map(|of| of.bins.iter().map(|bin| bin.0.log2()));
    let from = edges().reduce(f64::min).unwrap_or(0.0).floor();
    let to = edges().reduce(f64::max).unwrap_or(1.0).ceil() + 1.0;
    let row = |of: &&TimeFigures| {
        let figures = [of.p50, of.p99, of.p99_9, of.max];
        let cells = figures.map(|figure| format!("<td class=\"number\">{}</td>", rounded(figure))).concat();
        format!("<tr><td>{}</td>{cells}<td>{}</td></tr>", of.name, histogram(of, from, to))
    };
    format!(
        "<section id=\"times\"><h2>Computing time</h2><p class=\"hint\">Microseconds. Each histogram counts cycles on a \
        logarithmic scale, over time on a logarithmic scale from {} to {} µs; the black line is the median, the red one p99.9.</p>\
        <div class=\"panel\"><table class=\"times\"><thead><tr><th>stage</th><th class=\"number\">p50</th>\
        <th class=\"number\">p99</th><th class=\"number\">p99.9</th><th class=\"number\">max</th>\
        <th>{}</th></tr></thead><tbody>{}</tbody></table></div></section>",
        from.exp2(),
        to.exp2(),
        axis(from, to),
        times.iter().map(row).collect::<String>()
    )
}

/// Size of a histogram.
const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 34.0;

fn histogram(of: &TimeFigures, from: f64, to: f64) -> String {
    let most = of.bins.iter().map(|bin| bin.1).max().unwrap_or(1) as f64;
    let x = |us: f64| WIDTH * (us.log2() - from) / (to - from);
    let bar = |&(edge, count): &(f64, u64)| {
        let height = (HEIGHT - 4.0) * (1.0 + count as f64).ln() / (1.0 + most).ln();
        format!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{height:.1}\"><title>from {} µs: {count}</title></rect>",
            x(edge),
            HEIGHT - height,
            WIDTH * 0.25 / (to - from) - 1.0,
            rounded(edge)
        )
    };
    let mark = |us: f64, class: &str| {
        let x = x(us.max(from.exp2()));
        format!("<line class=\"{class}\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"0\" y2=\"{HEIGHT}\"/>")
    };
    let marks = mark(of.p50, "p50") + &mark(of.p99_9, "p999");
    let bars: String = of.bins.iter().map(bar).collect();
    format!("<svg width=\"{WIDTH}\" height=\"{HEIGHT}\" class=\"histogram\">{bars}{marks}</svg>")
}

/// Powers of ten above the histograms.
fn axis(from: f64, to: f64) -> String {
    let label = |power: i32| {
        let us = 10f64.powi(power);
        let x = WIDTH * (us.log2() - from) / (to - from);
        (0.0..WIDTH - 30.0).contains(&x).then(|| format!("<text x=\"{x:.1}\" y=\"12\">{us} µs</text>"))
    };
    let labels: String = (-2..8).filter_map(label).collect();
    format!("<svg width=\"{WIDTH}\" height=\"16\" class=\"axis\">{labels}</svg>")
}
