// Charts over time, all with the same axis: what robots do, their batteries, how near they are, how high they are.

const LABELS = 64; // pixels left of every chart
const AXIS = 18; // pixels below
const MOST_PAIRS = 15;
const LABEL_HEIGHT = 12;
const ganttPicture = document.getElementById("gantt");
const distancePicture = document.getElementById("distance-chart");
const batteryPicture = document.getElementById("battery-chart");
const heightPicture = document.getElementById("height-chart");
let cursors = [];

function drawCharts() {
  cursors = [];
  drawGantt();
  document.getElementById("distances").hidden = !nearest;
  document.getElementById("heights").hidden = !data.spatial;
  document.getElementById("batteries").hidden = !robots.some(({ level }) => level);
  if (robots.some(({ level }) => level)) drawBatteries();
  if (nearest) drawDistances();
  if (data.spatial) drawHeights();
}

function timeScale(width) {
  const room = Math.max(width - LABELS - 10, 1);
  return (now) => LABELS + (room * now) / Math.max(duration, 1e-9);
}

function timeAt(picture, event) {
  const box = picture.getBoundingClientRect();
  const share = (event.clientX - box.left - LABELS) / Math.max(box.width - LABELS - 10, 1);
  return Math.min(Math.max(share, 0), 1) * duration;
}

function timeAxis(picture, width, height) {
  const x = timeScale(width);
  const step = tickStep(Math.max(duration, 1e-3), Math.max((width - LABELS) / 80, 1));
  for (let now = 0; now <= duration * 1.0001; now += step) {
    picture.append(svg("line", { class: "tick", x1: x(now), x2: x(now), y1: 0, y2: height - AXIS }));
    const anchor = now === 0 ? "start" : x(now) + 26 > width ? "end" : "middle";
    picture.append(svg("text", { x: x(now), y: height - 4, "text-anchor": anchor }, tickText(now)));
  }
}

function addCursor(picture, width, height) {
  const line = svg("line", { class: "cursor", y1: 0, y2: height - AXIS });
  picture.append(line);
  cursors.push({ line, x: timeScale(width) });
}

function showCharts(now) {
  for (const { line, x } of cursors) {
    line.setAttribute("x1", x(now));
    line.setAttribute("x2", x(now));
  }
}

// Bars of what robots do

const BAR_SHARES = { travel: 0.2, waiting: 0.55, traffic: 0.4, work: 0.8, service: 0.8 };

function drawGantt() {
  const row = Math.min(Math.max(220 / robots.length, 2.5), 24);
  ganttPicture.style.height = `${row * robots.length + AXIS}px`;
  const [width, height] = fitted(ganttPicture);
  picturedAs(ganttPicture, `Time chart of ${robots.length} robots: travel, waiting, waiting in traffic, work and service at stations`);
  timeAxis(ganttPicture, width, height);
  const patterns = svg("defs");
  ganttPicture.append(patterns);
  const every = Math.ceil(LABEL_HEIGHT / row);
  robots.forEach((robot, k) => {
    patterns.append(hatching(robot));
    const middle = (k + 0.5) * row;
    if (k % every === 0) ganttPicture.append(rowLabel(robot.id, middle));
  });
  const x = timeScale(width);
  ganttPicture.append(...markShapes(["window"], x, row));
  const traffic = ({ kind }) => Number(kind === "traffic"); // lies upon work
  for (const span of [...spans].sort((a, b) => traffic(a) - traffic(b))) ganttPicture.append(bar(span, x, row));
  ganttPicture.append(...markShapes(["late", "deadline", "due", "team"], x, row));
  fillLegend();
  addCursor(ganttPicture, width, height);
}

function hatching(robot) {
  const stripe = svg("path", { d: "M-1 1 1 -1M0 5 5 0M4 6 6 4", stroke: robot.color, "stroke-width": 1 });
  return svg("pattern", { id: `hatch-${robot.index}`, width: 5, height: 5, patternUnits: "userSpaceOnUse" }, stripe);
}

function rowLabel(name, middle) {
  const short = name.length > 9 ? `${name.slice(0, 8)}…` : name;
  return svg("text", { x: LABELS - 6, y: middle + 4, "text-anchor": "end" }, short, svg("title", {}, name));
}

function bar({ robot, task, kind, from, until }, x, row) {
  const height = Math.max(row * BAR_SHARES[kind], 1.5);
  const { color } = robots[robot];
  const shape = svg("rect", {
    class: kind,
    "data-task": task,
    x: x(from),
    y: (robot + 0.5) * row - height / 2,
    width: Math.max(x(until) - x(from), kind === "work" || kind === "service" ? 1.6 : 0.6),
    height,
    ...(kind === "traffic" || kind === "service" ? {} : { fill: kind === "waiting" ? `url(#hatch-${robot})` : color }),
    ...(kind === "waiting" ? { stroke: color, "stroke-width": 0.8 } : {}),
  });
  const doing = DOING[kind];
  const title = `${robots[robot].id} ${doing} ${task || "its end"}: ${timeText(from)} to ${timeText(until)}`;
  shape.append(svg("title", {}, title));
  return shape;
}

// Lines

function picturedAs(picture, label) {
  picture.setAttribute("role", "img");
  picture.setAttribute("aria-label", label);
}

// Axes of a chart of lines from `low` to `high`; returns how values become the points of a line.
function lineChart(picture, low, high, unit) {
  picture.style.height = "130px";
  const [width, height] = fitted(picture);
  const x = timeScale(width);
  const y = (value) => 6 + ((height - AXIS - 6) * (high - value)) / Math.max(high - low, 1e-9);
  timeAxis(picture, width, height);
  const step = niceStep(high - low || 1, 4);
  for (let value = Math.ceil(low / step) * step; value <= high; value += step) {
    picture.append(svg("line", { class: "tick", x1: LABELS, x2: width - 10, y1: y(value), y2: y(value) }));
    const label = `${Number(value.toPrecision(6))} ${unit}`;
    picture.append(svg("text", { x: LABELS - 6, y: y(value) + 3, "text-anchor": "end" }, label));
  }
  const line = (values, attributes, moments = times) => {
    let pen = "M";
    let d = "";
    values.forEach((value, k) => {
      if (value === null) { pen = "M"; return; }
      d += `${pen}${x(moments[k]).toFixed(1)} ${y(Math.min(value, 2 * high - low)).toFixed(1)}`;
      pen = "L";
    });
    picture.append(svg("path", { d: d || "M0 0", ...attributes }));
  };
  return { line, end: () => addCursor(picture, width, height) };
}

function between(first, second) {
  return times.map((_, k) => (first.x[k] === null || second.x[k] === null ? null : Math.hypot(
    first.x[k] - second.x[k],
    first.y[k] - second.y[k],
    first.z ? first.z[k] - second.z[k] : 0,
  )));
}

function drawDistances() {
  const most = nearest.metres.reduce((a, b) => Math.max(a, b ?? 0), 0);
  const widest = nearest.touch.reduce((a, b) => Math.max(a, b), 0);
  const { line, end } = lineChart(distancePicture, 0, Math.max(most * 1.25, widest * 2, 0.1), "m");
  if ((robots.length * (robots.length - 1)) / 2 <= MOST_PAIRS) {
    robots.forEach((first, k) => robots.slice(k + 1).forEach((second) => line(between(first, second), { class: "pair" })));
  }
  if (widest > 0) line(nearest.touch, { class: "touch" });
  line(nearest.metres, { class: "least" });
  end();
  const least = nearest.metres.reduce((a, b) => (b === null ? a : Math.min(a, b)), Infinity);
  picturedAs(distancePicture, `Distance of the nearest two robots over time; least ${least.toFixed(2)} m`);
}

// What each battery holds; the greatest reserve as a thin line.
function drawBatteries() {
  const { line, end } = lineChart(batteryPicture, 0, 100, "%");
  const reserve = Math.max(...robots.map((robot) => robot.reserve ?? 0));
  if (reserve) line([100 * reserve, 100 * reserve], { class: "reserve" }, [0, duration]);
  for (const { level, color, id } of robots) {
    if (level) line(level.map(([, share]) => share), { class: "level", stroke: color, "data-robot": id }, level.map(([at]) => at));
  }
  end();
  picturedAs(batteryPicture, `Batteries of ${robots.filter(({ level }) => level).length} robots over time, per cent`);
}

function drawHeights() {
  const all = robots.flatMap((robot) => robot.z.filter((value) => value !== null));
  const high = all.reduce((a, b) => Math.max(a, b), 1);
  const low = all.reduce((a, b) => Math.min(a, b), 0);
  const { line, end } = lineChart(heightPicture, low, high * 1.08, "m");
  for (const robot of robots) line(robot.z, { class: "height", stroke: robot.color });
  end();
  picturedAs(heightPicture, `Height of ${robots.length} robots over time`);
}
