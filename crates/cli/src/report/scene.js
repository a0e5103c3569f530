// The tool path in space: orthographic, turned by dragging.

class Scene {
  constructor(host, bar) {
    this.canvas = host.querySelector("canvas");
    this.path = data.tool_path;
    this.turn = this.iso();
    this.zoom = 1;
    this.shift = [0, 0];
    this.target = "all";
    this.buttons(bar);
    this.listen();
    this.fit();
    pictures.push(this);
  }

  buttons(bar) {
    const add = (text, title, act) => {
      const button = document.createElement("button");
      button.textContent = text;
      button.title = title;
      button.addEventListener("click", () => { act(); redraw(); });
      bar.append(button);
      return button;
    };
    const turn = (yaw, pitch) => () => { this.turn = { yaw, pitch }; this.fit(); };
    add("Iso", "From the front, above", () => { this.turn = this.iso(); this.fit(); });
    add("Top", "x to the right, y up", turn(-90, 90));
    add("Front", "x to the right, z up", turn(-90, 0));
    add("Side", "y to the right, z up", turn(0, 0));
    if (this.path.arc.includes(1)) {
      add("Weld", "Only where the arc is on", () => { this.target = "weld"; this.fit(); });
      add("All", "The whole path", () => { this.target = "all"; this.fit(); });
    }
    add("+", "Nearer", () => { this.zoom *= 1.3; });
    add("−", "Further", () => { this.zoom /= 1.3; });
  }

  listen() {
    const canvas = this.canvas;
    let drag = null;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      drag = { x: event.offsetX, y: event.offsetY };
    });
    canvas.addEventListener("pointermove", (event) => {
      if (drag) {
        const dx = event.offsetX - drag.x, dy = event.offsetY - drag.y;
        drag = { x: event.offsetX, y: event.offsetY };
        if (event.shiftKey) {
          this.shift = [this.shift[0] + dx, this.shift[1] + dy];
        } else {
          this.turn.yaw -= dx * 0.4;
          this.turn.pitch = Math.min(90, Math.max(-90, this.turn.pitch + dy * 0.4));
        }
      } else {
        view.cursor = this.timeNear(event.offsetX, event.offsetY);
      }
      redraw();
    });
    canvas.addEventListener("pointerup", () => { drag = null; });
    canvas.addEventListener("pointerleave", () => { view.cursor = null; redraw(); });
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.zoom *= Math.exp(-event.deltaY * 0.002);
      redraw();
    }, { passive: false });
  }

  // Slantwise from above, with the longer way of the path across the screen.
  iso() {
    const { low, high } = this.bounds();
    return { yaw: high[1] - low[1] > high[0] - low[0] ? -28 : -62, pitch: 28 };
  }

  // The part of the path to show.
  bounds() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const { position, arc } = this.path;
    for (let i = 0; i < arc.length; i++) {
      if (this.target === "weld" && !arc[i]) continue;
      for (let axis = 0; axis < 3; axis++) {
        low[axis] = Math.min(low[axis], position[3 * i + axis]);
        high[axis] = Math.max(high[axis], position[3 * i + axis]);
      }
    }
    return arc.length ? { low, high } : { low: [0, 0, 0], high: [1, 1, 1] };
  }

  fit() {
    this.zoom = 1;
    this.shift = [0, 0];
    redraw();
  }

  // The map from space (mm) to the canvas.
  projection(width, height) {
    const yaw = (this.turn.yaw * Math.PI) / 180, pitch = (this.turn.pitch * Math.PI) / 180;
    const right = [-Math.sin(yaw), Math.cos(yaw), 0];
    const up = [-Math.sin(pitch) * Math.cos(yaw), -Math.sin(pitch) * Math.sin(yaw), Math.cos(pitch)];
    const dot = (a, x, y, z) => a[0] * x + a[1] * y + a[2] * z;
    const { low, high } = this.bounds();
    const step = niceStep(Math.max(high[0] - low[0], high[1] - low[1], 1), 8);
    const floor = { step, low: [0, 0, low[2]], high: [0, 0, high[2]] };
    for (const axis of [0, 1]) {
      const [first, last] = [Math.floor(low[axis] / step), Math.ceil(high[axis] / step)];
      const aside = last - first < 3 ? 1 : 0;
      floor.low[axis] = (first - aside) * step;
      floor.high[axis] = (last + aside) * step;
    }
    const corners = [];
    for (let i = 0; i < 8; i++) corners.push([0, 1, 2].map((axis) => ((i >> axis) & 1 ? floor.high : floor.low)[axis]));
    const xs = corners.map((c) => dot(right, ...c)), ys = corners.map((c) => dot(up, ...c));
    const extent = (values) => Math.max(...values) - Math.min(...values);
    const scale = this.zoom * Math.min((width - 170) / Math.max(extent(xs), 1), (height - 140) / Math.max(extent(ys), 1));
    const middle = (values) => (Math.max(...values) + Math.min(...values)) / 2;
    const [cx, cy] = [middle(xs), middle(ys)];
    return {
      floor,
      at: (x, y, z) => [
        width / 2 + this.shift[0] + (dot(right, x, y, z) - cx) * scale,
        height / 2 - 6 + this.shift[1] - (dot(up, x, y, z) - cy) * scale,
      ],
    };
  }

  timeNear(x, y) {
    const { at } = this.projection(this.canvas.clientWidth, this.canvas.clientHeight);
    const { time, position } = this.path;
    let best = 12, found = null;
    for (let i = 0; i < time.length; i++) {
      const [px, py] = at(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
      const distance = Math.hypot(px - x, py - y);
      if (distance < best) { best = distance; found = time[i]; }
    }
    return found;
  }

  draw() {
    const { g, width, height } = context(this.canvas);
    if (width < 20) return;
    const map = this.projection(width, height);
    this.drawFloor(g, map);
    this.drawCommanded(g, map);
    this.drawProgrammed(g, map);
    this.drawEvents(g, map);
    this.drawAxes(g, width);
    this.drawCursor(g, map);
  }

  // A grid below the path, with its coordinates along two edges.
  drawFloor(g, { at, floor: { step, low, high } }) {
    const [[x0, y0, z], [x1, y1]] = [low, high];
    const segment = (a, b) => line(g, ...at(...a), ...at(...b), "#e3e9ef", 1);
    for (let x = x0; x <= x1 + step / 2; x += step) segment([x, y0, z], [x, y1, z]);
    for (let y = y0; y <= y1 + step / 2; y += step) segment([x0, y, z], [x1, y, z]);
    if (Math.abs(this.turn.pitch) < 5) return;
    // The edge that is lower on the screen carries the labels.
    const lower = (a, b) => at(...a)[1] > at(...b)[1];
    const edgeY = lower([x0, y0, z], [x0, y1, z]) ? y0 : y1, edgeX = lower([x0, y0, z], [x1, y0, z]) ? x0 : x1;
    const outward = (place, opposite) => {
      const [[px, py], [qx, qy]] = [at(...place), at(...opposite)];
      const distance = Math.hypot(px - qx, py - qy) || 1;
      return [((px - qx) / distance) * 20, ((py - qy) / distance) * 13];
    };
    g.fillStyle = COLOURS.soft;
    g.font = FONT;
    g.textAlign = "center";
    g.textBaseline = "middle";
    const label = (text, place, [dx, dy]) => { const [px, py] = at(...place); g.fillText(text, px + dx, py + dy); };
    for (let x = x0; x <= x1 + step / 2; x += step) {
      label(String(Math.round(x)), [x, edgeY, z], outward([x, edgeY, z], [x, y0 + y1 - edgeY, z]));
    }
    for (let y = y0; y <= y1 + step / 2; y += step) {
      label(String(Math.round(y)), [edgeX, y, z], outward([edgeX, y, z], [x0 + x1 - edgeX, y, z]));
    }
  }

  drawCommanded(g, { at }) {
    const { position, arc } = this.path;
    for (const lit of [0, 1]) {
      g.beginPath();
      for (let i = 1; i < arc.length; i++) {
        if (arc[i - 1] !== lit) continue;
        g.moveTo(...at(position[3 * i - 3], position[3 * i - 2], position[3 * i - 1]));
        g.lineTo(...at(position[3 * i], position[3 * i + 1], position[3 * i + 2]));
      }
      g.strokeStyle = lit ? COLOURS.weld : COLOURS.travel;
      g.lineWidth = lit ? 4 : 1.8;
      g.lineCap = "round";
      g.stroke();
    }
  }

  drawProgrammed(g, { at }) {
    g.beginPath();
    for (const { position } of data.programmed) {
      g.moveTo(...at(...position.slice(0, 3)));
      for (let i = 3; i < position.length; i += 3) g.lineTo(...at(...position.slice(i, i + 3)));
    }
    g.strokeStyle = "#111";
    g.lineWidth = 1;
    g.setLineDash([4, 4]);
    g.stroke();
    g.setLineDash([]);
  }

  drawEvents(g, { at }) {
    const colours = { "arc on": COLOURS.weld, "arc off": "#7a2e0e", dwell: "#8a3ea8", fault: COLOURS.limit };
    const taken = [];
    g.font = "600 " + FONT;
    g.textAlign = "left";
    g.textBaseline = "middle";
    const shown = data.events.filter((event) => event.position && colours[event.kind]);
    for (const event of shown) {
      const [x, y] = at(...event.position);
      g.fillStyle = colours[event.kind];
      g.beginPath();
      g.arc(x, y, event.kind === "fault" ? 7 : 4.5, 0, 7);
      g.fill();
      g.strokeStyle = "#fff";
      g.lineWidth = 1.5;
      g.stroke();
      if (shown.length > 40 && event.kind !== "fault") continue;
      const text = event.kind + (event.kind === "dwell" ? " " + event.text : "");
      let below = y - 12;
      while (taken.some(([tx, ty]) => Math.abs(tx - x) < 90 && Math.abs(ty - below) < 14)) below += 14;
      taken.push([x, below]);
      g.lineWidth = 3;
      g.strokeStyle = "rgba(255, 255, 255, 0.85)";
      g.strokeText(text, x + 9, below);
      g.fillText(text, x + 9, below);
    }
  }

  // Directions of the robot frame.
  drawAxes(g, width) {
    const yaw = (this.turn.yaw * Math.PI) / 180, pitch = (this.turn.pitch * Math.PI) / 180;
    const [ox, oy, length] = [width - 58, 62, 34];
    const axes = [
      ["x", -Math.sin(yaw), -Math.sin(pitch) * Math.cos(yaw), "#c0262d"],
      ["y", Math.cos(yaw), -Math.sin(pitch) * Math.sin(yaw), "#2b7a3d"],
      ["z", 0, Math.cos(pitch), "#2f6fb3"],
    ];
    g.font = "600 " + FONT;
    g.textAlign = "center";
    g.textBaseline = "middle";
    for (const [name, dx, dy, colour] of axes) {
      line(g, ox, oy, ox + dx * length, oy - dy * length, colour, 2);
      g.fillStyle = colour;
      if (Math.hypot(dx, dy) > 0.2) g.fillText(name, ox + dx * (length + 9), oy - dy * (length + 9));
    }
  }

  drawCursor(g, { at }) {
    if (view.cursor === null) return;
    const { time, position } = this.path;
    let i = 0;
    for (let low = 0, high = time.length; low < high;) {
      const middle = (low + high) >> 1;
      if (time[middle] <= view.cursor) { i = middle; low = middle + 1; } else high = middle;
    }
    const [x, y] = at(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
    g.beginPath();
    g.arc(x, y, 6, 0, 7);
    g.strokeStyle = "#111";
    g.lineWidth = 2;
    g.stroke();
    const place = position.slice(3 * i, 3 * i + 3).map((value) => value.toFixed(2)).join(", ");
    g.font = FONT;
    g.textAlign = "left";
    g.textBaseline = "top";
    g.fillStyle = COLOURS.ink;
    g.fillText("t = " + view.cursor.toFixed(3) + " s · " + place + " mm", 10, 40);
  }
}
