// Draws `page`: { title, facts, tables: [{ title, columns, rows }], charts: [{ title, x, y, series, marks, levels, equal, log, wide }] }.

const COLOURS = ["#2f6fb3", "#d9480f", "#2b8a3e", "#7048c8", "#b08800", "#0b8794", "#c2255c", "#5f6c7b", "#111111", "#82c91e"];
const FONT = '11px system-ui, "Segoe UI", Roboto, Arial, "DejaVu Sans", sans-serif';
// How many powers of ten below the greatest value are shown.
const DECADES = 5;
const FRAME = { left: 58, top: 18, right: 12, bottom: 34 };

function make(host, tag, text) {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  host.append(element);
  return element;
}

// Round values, about one per `room` of `count` places.
function ticks(low, high, count) {
  const rough = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * 0.999);
  const made = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) made.push(k * step);
  return { made, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

const powers = (low, high) => {
  const made = [];
  for (let k = Math.ceil(low); k <= high; k++) made.push(10 ** k);
  return { made, digits: null };
};

const readout = (value) => (value === 0 ? "0" : Math.abs(value) < 1e-3 ? value.toExponential(2) : value.toPrecision(4));

// The value of a line at x, or null beside it.
function valueAt(points, x) {
  let low = 0, high = points.length - 1;
  if (high < 0 || x < points[0][0] || x > points[high][0]) return null;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (points[middle][0] <= x) low = middle; else high = middle;
  }
  const [x0, y0] = points[low], [x1, y1] = points[high];
  return x1 > x0 ? y0 + ((y1 - y0) * (x - x0)) / (x1 - x0) : y1;
}

class LineChart {
  constructor(chart) {
    this.chart = chart;
    const host = make(document.querySelector("main"), "section");
    if (chart.wide) host.className = "wide";
    make(host, "h2", chart.title);
    this.legend = make(host, "div");
    this.legend.className = "legend";
    this.values = chart.series.map((series, index) => {
      const item = make(this.legend, "span");
      make(item, "i").style.borderColor = COLOURS[index % COLOURS.length];
      item.append(series.name + " ");
      return make(item, "b");
    });
    this.canvas = make(host, "canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${chart.title}: ${chart.y} over ${chart.x}`);
    this.cursor = null;
    this.canvas.addEventListener("pointermove", (event) => this.point(event.offsetX));
    this.canvas.addEventListener("pointerleave", () => this.point(null));
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  // Places have no single value at an x.
  point(offset) {
    this.cursor = offset === null || this.chart.equal ? null : this.xAt(offset);
    this.values.forEach((value, index) => {
      const at = this.cursor === null ? null : valueAt(this.chart.series[index].points, this.cursor);
      value.textContent = at === null ? "" : readout(at);
    });
    this.draw();
  }

  // Upward, what is drawn is the value or its power of ten.
  up(value) {
    return this.chart.log ? Math.log10(Math.max(value, 1e-300)) : value;
  }

  range(axis) {
    const { series, marks, levels } = this.chart;
    let low = Infinity, high = -Infinity;
    const take = (number) => {
      const value = axis === 1 ? this.up(number) : number;
      low = Math.min(low, value);
      high = Math.max(high, value);
    };
    for (const { points } of series) for (const point of points) take(point[axis]);
    for (const [value] of axis === 0 ? marks : levels) take(value);
    if (!(high > low)) { low -= 0.5; high += 0.5; }
    if (axis === 0 && !this.chart.equal) return [low, high];
    if (this.chart.log) low = Math.max(low, high - DECADES);
    const margin = 0.05 * (high - low);
    return [low - margin, high + margin];
  }

  layout() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    const box = { left: FRAME.left, top: FRAME.top, right: width - FRAME.right, bottom: height - FRAME.bottom };
    let [x0, x1] = this.range(0), [y0, y1] = this.range(1);
    if (this.chart.equal) {
      const scale = Math.max((x1 - x0) / (box.right - box.left), (y1 - y0) / (box.bottom - box.top));
      const widen = (low, high, room) => [0.5 * (low + high - scale * room), 0.5 * (low + high + scale * room)];
      [x0, x1] = widen(x0, x1, box.right - box.left);
      [y0, y1] = widen(y0, y1, box.bottom - box.top);
    }
    const x = (value) => box.left + ((value - x0) / (x1 - x0)) * (box.right - box.left);
    const y = (value) => box.bottom - ((this.up(value) - y0) / (y1 - y0)) * (box.bottom - box.top);
    return { width, height, box, x0, x1, y0, y1, x, y };
  }

  xAt(offset) {
    const { box, x0, x1 } = this.layout();
    return Math.min(x1, Math.max(x0, x0 + ((offset - box.left) / (box.right - box.left)) * (x1 - x0)));
  }

  draw() {
    const place = this.layout();
    if (place.width < 60) return;
    const dense = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(place.width * dense);
    this.canvas.height = Math.round(place.height * dense);
    const g = this.canvas.getContext("2d");
    g.scale(dense, dense);
    g.font = FONT;
    this.drawAxes(g, place);
    g.save();
    g.beginPath();
    g.rect(place.box.left, place.box.top, place.box.right - place.box.left, place.box.bottom - place.box.top);
    g.clip();
    this.chart.series.forEach(({ points }, index) => {
      g.beginPath();
      points.forEach(([px, py], n) => (n ? g.lineTo(place.x(px), place.y(py)) : g.moveTo(place.x(px), place.y(py))));
      g.strokeStyle = COLOURS[index % COLOURS.length];
      g.lineWidth = 1.6;
      g.lineJoin = "round";
      g.stroke();
    });
    g.restore();
    this.drawMarks(g, place);
  }

  drawAxes(g, { width, box, x0, x1, y0, y1, x, y }) {
    const across = ticks(x0, x1, (box.right - box.left) / 80), up = this.chart.log ? powers(y0, y1) : ticks(y0, y1, (box.bottom - box.top) / 40);
    g.fillStyle = "#5f6c7b";
    g.textAlign = "center";
    g.textBaseline = "top";
    for (const value of across.made) {
      stroke(g, x(value), box.top, x(value), box.bottom, "#e8ecf1");
      g.fillText(value.toFixed(across.digits), x(value), box.bottom + 4);
    }
    g.textAlign = "right";
    g.textBaseline = "middle";
    for (const value of up.made) {
      stroke(g, box.left, y(value), box.right, y(value), Math.abs(value) < 1e-12 ? "#9aa7b5" : "#e8ecf1");
      g.fillText(up.digits === null ? value.toExponential(0) : value.toFixed(up.digits), box.left - 5, y(value));
    }
    g.strokeStyle = "#9aa7b5";
    g.strokeRect(box.left + 0.5, box.top + 0.5, box.right - box.left - 1, box.bottom - box.top - 1);
    g.fillStyle = "#1f2933";
    g.textBaseline = "top";
    g.fillText(this.chart.x, width - FRAME.right, box.bottom + 19);
    g.textAlign = "left";
    g.fillText(this.chart.y, 2, 2);
  }

  drawMarks(g, { box, x, y }) {
    g.fillStyle = "#1f2933";
    g.textBaseline = "bottom";
    // A label that would run into the one before goes a line lower.
    let end = -Infinity, row = 0;
    for (const [value, label] of [...this.chart.marks].sort((a, b) => a[0] - b[0])) {
      stroke(g, x(value), box.top, x(value), box.bottom, "#5f6c7b", [4, 3]);
      const room = g.measureText(label).width, left = Math.min(x(value) + 3, box.right - room - 2);
      row = left < end ? row + 1 : 0;
      end = left + room + 6;
      g.textAlign = "left";
      g.fillText(label, left, box.top + 15 + 13 * row);
    }
    for (const [value, label] of this.chart.levels) {
      stroke(g, box.left, y(value), box.right, y(value), "#c0262d", [4, 3]);
      g.textAlign = "right";
      g.fillText(label, box.right - 3, y(value) - 2);
    }
    if (this.cursor !== null) {
      stroke(g, x(this.cursor), box.top, x(this.cursor), box.bottom, "#9aa7b5", [2, 2]);
      g.textAlign = "right";
      g.fillText(readout(this.cursor), box.right, box.top - 3);
    }
  }
}

function stroke(g, x1, y1, x2, y2, colour, dash) {
  g.beginPath();
  g.setLineDash(dash || []);
  g.moveTo(x1, y1);
  g.lineTo(x2, y2);
  g.strokeStyle = colour;
  g.lineWidth = 1;
  g.stroke();
  g.setLineDash([]);
}

document.title = page.title + " – Seamline";
document.querySelector("h1").textContent = page.title;
for (const [label, value] of page.facts) {
  const fact = make(document.querySelector("dl"), "div");
  make(fact, "dt", label);
  make(fact, "dd", value);
}
for (const table of page.tables) {
  const section = make(document.querySelector("main"), "section");
  make(section, "h2", table.title);
  const body = make(section, "table");
  const heading = make(body, "tr");
  for (const column of table.columns) make(heading, "th", column);
  for (const row of table.rows) {
    const line = make(body, "tr");
    for (const cell of row) make(line, "td", cell);
  }
}
for (const chart of page.charts) new LineChart(chart);
