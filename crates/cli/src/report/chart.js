// Plots over time. All of them share one window of time and one cursor.

const data = JSON.parse(document.getElementById("data").textContent);

const COLOURS = {
  ink: "#1f2933", soft: "#5f6c7b", grid: "#e9eef3", frame: "#cfd8e1", limit: "#c0262d",
  weld: "#d9480f", travel: "#2f6fb3", shade: "rgba(217, 72, 15, 0.09)",
  series: ["#2f6fb3", "#d9480f", "#2b8a3e", "#8a3ea8", "#b58900", "#0f8b8d", "#6b7280"],
};
const FONT = "11px system-ui, 'Segoe UI', Roboto, Arial, 'DejaVu Sans', sans-serif";

const view = { from: 0, to: data.duration || 1, cursor: null };
const pictures = [];

let pending = false;
function redraw() {
  if (pending) return;
  pending = true;
  requestAnimationFrame(() => {
    pending = false;
    for (const picture of pictures) picture.draw();
  });
}

function setView(from, to) {
  const least = 20 * data.period;
  const length = Math.min(Math.max(to - from, least), data.duration || 1);
  const middle = (from + to) / 2;
  view.from = Math.max(0, Math.min(middle - length / 2, (data.duration || 1) - length));
  view.to = view.from + length;
  redraw();
}

function resetView() {
  setView(0, data.duration || 1);
}

// A step of 1, 2 or 5 times a power of ten that gives about `count` steps.
function niceStep(range, count) {
  const raw = range / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].map((f) => f * power).find((step) => step >= raw * 0.999) || raw;
}

function ticks(from, to, count) {
  if (!(to > from)) return [];
  const step = niceStep(to - from, count);
  const found = [];
  for (let i = Math.ceil(from / step - 1e-9); i * step <= to + 1e-9 * step && found.length < 100; i++) found.push(i * step);
  return found;
}

function tickText(value, range) {
  const magnitude = Math.max(Math.abs(value), range);
  if (value === 0) return "0";
  if (magnitude >= 1e4) return +(value / 1000).toFixed(magnitude >= 1e5 ? 0 : 1) + "k";
  const digits = Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(range / 2 || 1))));
  return String(+value.toFixed(digits));
}

function readout(value) {
  const magnitude = Math.abs(value);
  if (magnitude === 0) return "0";
  return magnitude >= 100 ? value.toFixed(1) : magnitude >= 1e-3 ? value.toPrecision(3) : value.toExponential(1);
}

// Sets a canvas to the size of its element in device pixels; returns a cleared context in CSS pixels.
function context(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const g = canvas.getContext("2d");
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  g.clearRect(0, 0, width, height);
  g.font = FONT;
  return { g, width, height };
}

// Index of the first point of [time, value, …] at or after `time`.
function firstAfter(points, time) {
  let low = 0, high = points.length / 2;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (points[2 * middle] < time) low = middle + 1; else high = middle;
  }
  return low;
}

// Stretches of time with the arc on.
const arcSpans = (() => {
  const spans = [];
  let start = null;
  for (const event of data.events) {
    if (event.kind === "arc on" && start === null) start = event.time;
    if (event.kind === "arc off" && start !== null) { spans.push([start, event.time]); start = null; }
  }
  if (start !== null) spans.push([start, data.duration]);
  return spans;
})();
const faultTimes = data.events.filter((event) => event.kind === "fault").map((event) => event.time);

// The part of a trace where the arc is on.
function whileWelding(points) {
  const kept = [];
  let span = 0;
  for (let i = 0; i < points.length; i += 2) {
    while (span < arcSpans.length && arcSpans[span][1] < points[i]) span++;
    if (span < arcSpans.length && points[i] >= arcSpans[span][0]) kept.push(points[i], points[i + 1]);
  }
  return kept;
}

// Neighbouring points further apart than this are two stretches, not one line.
function gapOf(points) {
  const steps = [];
  for (let i = 2; i < points.length; i += 2) steps.push(points[i] - points[i - 2]);
  steps.sort((a, b) => a - b);
  return steps.length ? 8 * steps[steps.length >> 1] + 4 * data.period : Infinity;
}

// A plot over time. `options`: title, unit, height, small; series [{ name, points, colour, gaps }],
// spans [[from, to, value]] (a programmed value), limits [values], bands [[time, word]], range() → [low, high] to show.
class TimeChart {
  constructor(host, options) {
    Object.assign(this, { height: 150, series: [], spans: [], limits: [], title: "", unit: "" }, options);
    this.canvas = document.createElement("canvas");
    this.canvas.style.height = this.height + "px";
    host.append(this.canvas);
    for (const series of this.series) series.gap = series.gaps ? gapOf(series.points) : Infinity;
    this.listen();
    pictures.push(this);
  }

  frame(width) {
    const left = this.small ? 44 : 56;
    return { left, top: 20, right: width - 10, bottom: this.height - (this.small ? 15 : 18) };
  }

  timeAt(x) {
    const { left, right } = this.frame(this.canvas.clientWidth);
    return view.from + ((x - left) / (right - left)) * (view.to - view.from);
  }

  listen() {
    const canvas = this.canvas;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.drag = { x: event.offsetX, from: view.from, to: view.to, shift: event.shiftKey };
    });
    canvas.addEventListener("pointermove", (event) => {
      view.cursor = Math.min(Math.max(this.timeAt(event.offsetX), 0), data.duration);
      if (this.drag) this.drag.now = event.offsetX;
      if (this.drag && this.drag.shift) {
        const { left, right } = this.frame(canvas.clientWidth);
        const by = ((this.drag.x - event.offsetX) / (right - left)) * (this.drag.to - this.drag.from);
        setView(this.drag.from + by, this.drag.to + by);
      }
      redraw();
    });
    canvas.addEventListener("pointerup", (event) => {
      const drag = this.drag;
      this.drag = null;
      if (drag && !drag.shift && Math.abs(event.offsetX - drag.x) > 4) {
        const ends = [this.timeAt(drag.x), this.timeAt(event.offsetX)].sort((a, b) => a - b);
        setView(Math.max(0, ends[0]), Math.min(data.duration, ends[1]));
      }
      redraw();
    });
    canvas.addEventListener("pointerleave", () => { view.cursor = null; redraw(); });
    canvas.addEventListener("dblclick", resetView);
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      const at = this.timeAt(event.offsetX), factor = Math.exp(event.deltaY * 0.002);
      setView(at - (at - view.from) * factor, at + (view.to - at) * factor);
    }, { passive: false });
  }

  // What the value axis shows: all that is visible, and what the chart wants in sight.
  valueRange() {
    let low = Infinity, high = -Infinity;
    const take = (value) => { low = Math.min(low, value); high = Math.max(high, value); };
    for (const { points } of this.series) {
      const first = Math.max(0, firstAfter(points, view.from) - 1);
      for (let i = first; 2 * i < points.length; i++) {
        take(points[2 * i + 1]);
        if (points[2 * i] > view.to) break;
      }
    }
    for (const [from, to, value] of this.spans) if (to >= view.from && from <= view.to) take(value);
    if (this.range) this.range(low, high).forEach(take);
    if (!(low <= high)) { low = 0; high = 1; }
    const spread = high - low;
    const least = Math.max(1e-9, 1e-4 * Math.max(Math.abs(low), Math.abs(high)));
    if (spread < least) { low -= least; high += least; }
    const margin = 0.06 * (high - low);
    return [low - margin, high + margin];
  }

  draw() {
    const { g, width } = context(this.canvas);
    if (width < 20) return;
    const frame = this.frame(width);
    const { left, top, right, bottom } = frame;
    const [low, high] = this.valueRange();
    const x = (time) => left + ((time - view.from) / (view.to - view.from)) * (right - left);
    const y = (value) => bottom - ((value - low) / (high - low)) * (bottom - top);
    this.drawGrid(g, frame, x, y, low, high);
    g.save();
    g.beginPath();
    g.rect(left, top, right - left, bottom - top);
    g.clip();
    for (const limit of this.limits) line(g, left, y(limit), right, y(limit), COLOURS.limit, 1, [5, 4]);
    for (const [from, to, value] of this.spans) line(g, x(from), y(value), x(to), y(value), "#111", 1.2, [4, 3]);
    for (const series of this.series) this.drawSeries(g, series, x, y);
    if (this.drag && this.drag.now !== undefined && !this.drag.shift) {
      g.fillStyle = "rgba(47, 111, 179, 0.15)";
      g.fillRect(Math.min(this.drag.x, this.drag.now), top, Math.abs(this.drag.now - this.drag.x), bottom - top);
    }
    if (view.cursor !== null) line(g, x(view.cursor), top, x(view.cursor), bottom, COLOURS.soft, 1, [2, 2]);
    g.restore();
    this.drawTitle(g, frame);
  }

  drawGrid(g, { left, top, right, bottom }, x, y, low, high) {
    g.fillStyle = COLOURS.shade;
    for (const [from, to] of arcSpans) {
      const a = Math.max(left, x(from)), b = Math.min(right, x(to));
      if (b > a) g.fillRect(a, top, b - a, bottom - top);
    }
    if (this.bands) this.drawBands(g, { left, right, top, bottom }, x);
    g.fillStyle = COLOURS.soft;
    g.textAlign = "right";
    g.textBaseline = "middle";
    for (const value of ticks(low, high, (bottom - top) / (this.small ? 15 : 19))) {
      line(g, left, y(value), right, y(value), Math.abs(value) < 1e-12 ? COLOURS.frame : COLOURS.grid, 1);
      g.fillText(tickText(value, high - low), left - 5, y(value));
    }
    g.textAlign = "center";
    g.textBaseline = "top";
    const times = ticks(view.from, view.to, (right - left) / 80);
    for (const time of times) {
      line(g, x(time), top, x(time), bottom, COLOURS.grid, 1);
      const last = time === times[times.length - 1] && x(time) > right - 20;
      g.fillText(tickText(time, view.to - view.from) + (this.small || last ? "" : " s"), x(time), bottom + 3);
    }
    g.strokeStyle = COLOURS.frame;
    g.lineWidth = 1;
    g.strokeRect(left + 0.5, top + 0.5, right - left - 1, bottom - top - 1);
    for (const time of faultTimes) {
      if (time >= view.from && time <= view.to) line(g, x(time), top, x(time), bottom, COLOURS.limit, 1.5);
    }
  }

  drawBands(g, { left, right, top, bottom }, x) {
    const colours = { holding: "#fde9b8", stopping: "#f9d3c0", fault: "#f6b9bb", standstill: "#e6ebf0", disabled: "#d5dbe1" };
    this.bands.forEach(([from, word], index) => {
      const to = index + 1 < this.bands.length ? this.bands[index + 1][0] : data.duration;
      const a = Math.max(left, x(from)), b = Math.min(right, x(to));
      if (b <= a || !colours[word]) return;
      g.fillStyle = colours[word];
      g.fillRect(a, top, Math.max(b - a, 1), bottom - top);
      g.fillStyle = COLOURS.ink;
      g.textAlign = "left";
      g.textBaseline = "bottom";
      if (g.measureText(word).width + 6 < b - a) g.fillText(word, a + 3, bottom - 2);
    });
  }

  drawSeries(g, { points, colour, gap }, x, y) {
    g.beginPath();
    let previous = -Infinity;
    for (let i = Math.max(0, firstAfter(points, view.from) - 1); 2 * i < points.length; i++) {
      const time = points[2 * i];
      if (i === 0 || time - previous > gap || previous === -Infinity) g.moveTo(x(time), y(points[2 * i + 1]));
      else g.lineTo(x(time), y(points[2 * i + 1]));
      previous = time;
      if (time > view.to) break;
    }
    g.strokeStyle = colour || COLOURS.travel;
    g.lineWidth = 1.2;
    g.lineJoin = "round";
    g.stroke();
  }

  drawTitle(g, { left, right }) {
    g.textBaseline = "middle";
    g.textAlign = "left";
    let at = left;
    const write = (text, colour, bold) => {
      g.font = (bold ? "600 " : "") + FONT;
      g.fillStyle = colour;
      g.fillText(text, at, 10);
      at += g.measureText(text).width + 10;
    };
    if (this.title) write(this.title, COLOURS.ink, true);
    for (const series of this.series) {
      const value = view.cursor === null ? null : valueAt(series, view.cursor);
      const shown = value === null ? "" : readout(value) + " " + this.unit;
      const text = [series.name, shown].filter(Boolean).join(" ");
      if (text) write(text, series.colour || COLOURS.travel, false);
    }
    if (this.spans.length) write("– – programmed", COLOURS.ink, false);
    const note = view.cursor === null || this.small ? this.note : "t = " + view.cursor.toFixed(3) + " s";
    if (note) {
      g.font = FONT;
      g.textAlign = "right";
      g.fillStyle = this.noteColour || COLOURS.soft;
      if (at < right - g.measureText(note).width) g.fillText(note, right, 10);
    }
  }
}

function line(g, x1, y1, x2, y2, colour, width, dash) {
  g.beginPath();
  g.setLineDash(dash || []);
  g.moveTo(x1, y1);
  g.lineTo(x2, y2);
  g.strokeStyle = colour;
  g.lineWidth = width;
  g.stroke();
  g.setLineDash([]);
}

// The value of a series at a time, or null where it has none.
function valueAt({ points, gap }, time) {
  const next = firstAfter(points, time), count = points.length / 2;
  if (count === 0 || (next === 0 && points[0] - time > 2 * data.period) || next === count) {
    return next === count && count > 0 && time - points[2 * count - 2] < 2 * data.period ? points[2 * count - 1] : null;
  }
  if (next === 0) return points[1];
  const [t0, v0, t1, v1] = points.slice(2 * next - 2, 2 * next + 2);
  if (t1 - t0 > gap) return null;
  return t1 > t0 ? v0 + ((v1 - v0) * (time - t0)) / (t1 - t0) : v1;
}
