// Puts the plots into the page.

const byId = (id) => document.getElementById(id);

new Scene(byId("scene"), byId("scene-bar"));

new TimeChart(byId("speed"), {
  title: "Speed of the tool centre point, mm/s", unit: "mm/s", height: 150,
  series: [{ points: data.speed }], spans: data.programmed_speed, range: () => [0],
});
if (arcSpans.length) {
  const welds = data.programmed_speed.filter(([from, to]) => arcSpans.some((span) => from < span[1] && to > span[0]));
  new TimeChart(byId("weld-speed"), {
    title: "Speed with the arc on, mm/s", unit: "mm/s", height: 130,
    series: [{ points: whileWelding(data.speed), gaps: true, colour: COLOURS.weld }], spans: welds,
    range: () => [0, 1.1 * Math.max(0, ...welds.map((weld) => weld[2]))],
  });
}
new TimeChart(byId("deviation"), {
  title: "Distance from the programmed path, µm", unit: "µm", height: 120,
  series: [{ points: data.deviation, gaps: true }],
  limits: [data.deviation_bound], range: () => [0, data.deviation_bound], note: "bound " + data.deviation_bound + " µm",
});
if (data.seam) {
  new TimeChart(byId("seam"), {
    title: "Seam correction, mm", unit: "mm", height: 150,
    series: [
      { name: "lateral", points: data.seam.lateral, colour: COLOURS.series[0] },
      { name: "height", points: data.seam.height, colour: COLOURS.series[2] },
      { name: "distance from the seam", points: data.seam.error, colour: COLOURS.series[1], gaps: true },
    ],
  });
}
new TimeChart(byId("override"), {
  title: "Override in effect, %, and mode", unit: "%", height: 96,
  series: [{ points: data.override }], bands: data.modes, range: () => [0, 100],
});

// One row a joint, one column an order of derivative.
const units = [...new Set(data.joints.map((joint) => joint.unit))];
const inUnits = (quantity, per) => quantity + " " + units.map((unit) => unit + per).join(" or ");
const ORDERS = [
  inUnits("position", ""), inUnits("velocity", "/s"), inUnits("acceleration", "/s²"), inUnits("jerk", "/s³"),
];
// Where there are several, the joint's name says its own.
const nameOf = (joint) => (units.length > 1 ? joint.name + " (" + joint.unit + ")" : joint.name);
let scaleToLimits = true;
const grid = byId("joint-grid");
grid.style.gridTemplateColumns = "18px repeat(4, minmax(0, 1fr))";
const element = (name, text) => {
  const made = document.createElement("div");
  made.className = name;
  made.textContent = text;
  grid.append(made);
  return made;
};
element("", "");
for (const title of ORDERS) element("title", title);
for (const joint of data.joints) {
  element("name", nameOf(joint));
  joint.traces.forEach(({ limits: all, used, points }, order) => {
    // A joint without a limit has null.
    const limits = all.filter(Number.isFinite);
    const bound = order === 3 ? 1.01 : 1;
    new TimeChart(element("cell", ""), {
      small: true, height: 104, unit: "", series: [{ points }], limits,
      range: () => (scaleToLimits ? limits : []),
      note: (100 * used).toFixed(used < 0.1 ? 1 : 0) + " % of " + (order === 0 ? "range" : "limit"),
      noteColour: used > bound + 1e-4 ? COLOURS.limit : COLOURS.soft,
    });
  });
}
const bar = byId("joint-bar");
for (const [text, limits] of [["Scale to limits", true], ["Scale to data", false]]) {
  const button = document.createElement("button");
  button.textContent = text;
  button.className = limits === scaleToLimits ? "on" : "";
  button.addEventListener("click", () => {
    scaleToLimits = limits;
    for (const other of bar.children) other.className = other === button ? "on" : "";
    redraw();
  });
  bar.append(button);
}
new TimeChart(byId("following"), {
  title: inUnits("Following error,", ""), unit: units.length > 1 ? "" : units[0], height: 150,
  series: data.joints.map((joint, index) => ({
    name: nameOf(joint), points: joint.following, colour: COLOURS.series[index % COLOURS.series.length],
  })),
});

for (const row of document.querySelectorAll("#moves tbody tr")) {
  row.addEventListener("click", () => {
    const from = +row.dataset.from, to = +row.dataset.to, margin = 0.08 * (to - from) + 0.02;
    setView(from - margin, to + margin);
    byId("path").scrollIntoView({ behavior: "smooth" });
  });
}

new ResizeObserver(redraw).observe(document.body);
redraw();
