//! `report.html`: a run as one page that opens anywhere, offline.
//!
//! The tables are plain HTML. The plots are drawn by a small script on canvases from data in the page itself, so that
//! the page needs nothing but a browser; a content security policy keeps it from asking for anything else.

mod data;
mod tables;

use std::io;
use std::path::Path;

use seamline_cell::record::{EventKind, PlotData, RunInfo, SegmentInfo, Summary, write_whole};

const STYLE: &str = include_str!("report.css");
const SCRIPTS: [&str; 3] = [include_str!("chart.js"), include_str!("scene.js"), include_str!("page.js")];

/// Writes the report, whole or not at all.
///
/// # Errors
/// Those of the file system.
pub(crate) fn write_report(
    path: &Path,
    run: &RunInfo,
    summary: &Summary,
    segments: &[SegmentInfo],
    plot: &PlotData,
) -> io::Result<()> {
    write_whole(path, page(run, summary, segments, plot)?.as_bytes())
}

fn page(run: &RunInfo, summary: &Summary, segments: &[SegmentInfo], plot: &PlotData) -> io::Result<String> {
    let data = serde_json::to_string(&data::Data::new(run, summary, segments, plot))?;
    let has_weld = plot.events.iter().any(|(event, _)| event.kind == EventKind::ArcOn);
    let has_seam = summary.seam.is_some();
    Ok([
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">",
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">",
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; ",
        "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">",
        &format!("<title>{} – Seamline</title>", tables::escaped(&summary.job)),
        "<style>",
        STYLE,
        "</style></head><body>",
        &tables::header(summary),
        "<main>",
        &overview(summary),
        &along_the_path(has_weld, has_seam),
        &joints(),
        &tables::moves(summary),
        &tables::computing_times(summary),
        "</main><script type=\"application/json\" id=\"data\">",
        // `<` could end the element; as an escape it means the same.
        &data.replace('<', "\\u003c"),
        "</script><script>\"use strict\";\n",
        &SCRIPTS.concat(),
        "</script></body></html>\n",
    ]
    .concat())
}

fn overview(summary: &Summary) -> String {
    let plot = "<div class=\"panel scene\" id=\"scene\"><div class=\"bar\" id=\"scene-bar\"></div>\
        <canvas></canvas><div class=\"legend\">\
        <span><i class=\"programmed\"></i>programmed</span><span><i class=\"weld\"></i>commanded, arc on</span>\
        <span><i class=\"travel\"></i>commanded, arc off</span>\
        <span class=\"hint\">mm, robot frame · drag: turn · shift-drag: move · ctrl-wheel: zoom</span></div></div>";
    let script = "<noscript><p class=\"fault\">The plots need JavaScript, which is off in this browser. \
        The tables do not.</p></noscript>";
    format!(
        "<section id=\"overview\" class=\"overview\"><div class=\"side\">{script}{}{}</div>{plot}</section>",
        tables::checks(summary),
        tables::incidents(summary)
    )
}

fn along_the_path(has_weld: bool, has_seam: bool) -> String {
    let chart = |wanted: bool, id: &str| {
        if wanted { format!("<div class=\"panel chart\" id=\"{id}\"></div>") } else { String::new() }
    };
    let charts = [
        chart(true, "speed"),
        chart(has_weld, "weld-speed"),
        chart(true, "deviation"),
        chart(has_seam, "seam"),
        chart(true, "override"),
    ];
    format!(
        "<section id=\"path\"><h2>Along the path</h2>\
        <p class=\"hint\">All plots over time share one axis: drag to zoom, double-click for the whole run, \
        shift-drag to move. Shaded where the arc is on.</p>\
        {}</section>",
        charts.concat()
    )
}

fn joints() -> String {
    "<section id=\"joints\"><h2>Joints</h2><div class=\"bar\" id=\"joint-bar\"></div>\
        <p class=\"hint\">Commands, and their derivatives by finite differences of the recorded commands. \
        Limits dashed in red.</p>\
        <div class=\"grid\" id=\"joint-grid\"></div><div class=\"panel chart\" id=\"following\"></div></section>"
        .to_owned()
}

#[cfg(test)]
mod tests;
