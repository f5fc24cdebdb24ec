// The map: walls and zones, planned routes, trails, tasks and robots as they are at a time.

const MARGIN = 26; // pixels around what is shown
const MOST_NAMED_TASKS = 80;
const MOST_NAMED_ROBOTS = 30;
const MOST_NAMED_STATIONS = 40;
const TASK_SCALE = Math.min(Math.max(Math.sqrt(MOST_NAMED_TASKS / tasks.length), 0.3), 1); // smaller in a crowd
const ROBOT_SCALE = Math.min(Math.max(Math.sqrt(MOST_NAMED_ROBOTS / robots.length), 0.4), 1);
const mapPicture = document.getElementById("map");
let project = null; // metres to pixels: {x, y, scale}
let trails = [];
let exploredPart = null;
let exploredMap = null; // that robots have built by the time that is shown
let shownGrowth = -1;
let routes = null;
let shownPlan = -1;
let robotMarks = [];
let taskMarks = [];
let taskPlaces = []; // at the time that is shown, metres; null: it is not there yet
let taskSpots = []; // of their marks, pixels
let stillNames = null; // of tasks and stations
let stationMarks = [];
let zoneParts = []; // of zones

function drawMap() {
  const [width, height] = fitted(mapPicture);
  project = projection(width, height);
  exploredPart = svg("g");
  [exploredMap, shownGrowth] = [null, -1];
  routes = svg("g");
  shownPlan = -1;
  zoneParts = [];
  stationMarks = stations.map(stationMark);
  taskPlaces = [];
  mapPicture.append(...floorParts(), exploredPart, routes, ...stationMarks);
  trails = robots.map(trail);
  taskMarks = tasks.map(taskMark);
  robotMarks = robots.map(robotMark);
  const marks = [...trails.map((one) => one.path), ...taskMarks, ...robotMarks];
  mapPicture.append(...marks, scaleBar(height));
}

function projection(width, height) {
  const xs = [];
  const ys = [];
  const add = (x, y) => { if (x !== null) { xs.push(x); ys.push(y); } };
  for (const task of tasks) for (const [, x, y] of task.places) add(x, y);
  for (const robot of robots) for (let k = 0; k < robot.x.length; k += 1) add(robot.x[k], robot.y[k]);
  for (const { place: [x, y] } of stations) add(x, y);
  for (const [x, y] of mapCorners()) add(x, y);
  const least = (values) => values.reduce((a, b) => Math.min(a, b), Infinity);
  const most = (values) => values.reduce((a, b) => Math.max(a, b), -Infinity);
  const [west, east, south, north] = xs.length ? [least(xs), most(xs), least(ys), most(ys)] : [0, 1, 0, 1];
  const room = (pixels, metres) => Math.max(pixels - 2 * MARGIN, 10) / Math.max(metres, 1e-3);
  const scale = Math.min(room(width, east - west), room(height, north - south));
  const left = (width - scale * (east - west)) / 2 - scale * west;
  const foot = (height + scale * (north - south)) / 2 + scale * south;
  return { scale, x: (metres) => left + scale * metres, y: (metres) => foot - scale * metres };
}

function mapCorners() {
  const metres = (corner) => corner.map((value) => value / 1000);
  const covered = data.areas.flatMap(([outline]) => outline).map(metres);
  if (!data.map) return covered;
  const outlines = [...(data.map.boundary ?? []), ...data.map.zones.flatMap((zone) => zone.corners)];
  const corners = [...covered, ...outlines.map(metres)];
  if (!data.map.image) return corners;
  const { columns, rows, resolution, origin: [x, y, yaw] } = data.map.image;
  const [c, s] = [Math.cos(yaw) * resolution, Math.sin(yaw) * resolution];
  const at = (column, row) => [x + c * column - s * row, y + s * column + c * row];
  return [...corners, at(0, 0), at(columns, 0), at(0, rows), at(columns, rows)];
}

function points(corners) {
  return corners.map(([x, y]) => `${project.x(x / 1000).toFixed(1)},${project.y(y / 1000).toFixed(1)}`).join(" ");
}

function areaPart(rings) {
  return svg("path", { class: "area", d: rings.map((ring) => `M${points(ring)}Z`).join("") });
}

function floorParts() {
  const areas = data.areas.map(areaPart);
  if (!data.map) return areas;
  const parts = data.map.image ? [walls(data.map.image), ...areas] : areas;
  if (data.map.boundary) parts.push(svg("polygon", { class: "boundary", points: points(data.map.boundary) }));
  for (const zone of data.map.zones) {
    zoneParts.push(svg("polygon", { class: "zone", points: points(zone.corners) }, svg("title", {}, zone.label)));
  }
  return [...parts, ...zoneParts];
}

// Blocked cells as pixels of a picture, laid on the ground where origin and yaw say.
function walls({ rows, columns, resolution, origin: [x, y, yaw], runs }) {
  const canvas = html("canvas", { width: columns, height: rows });
  const context = canvas.getContext("2d");
  const pixels = context.createImageData(columns, rows);
  let cell = 0;
  runs.forEach((length, k) => {
    if (k % 2) for (let i = cell; i < cell + length; i += 1) pixels.data.set([128, 130, 136, 255], 4 * i);
    cell += length;
  });
  context.putImageData(pixels, 0, 0);
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)].map((part) => part * resolution * project.scale);
  return cellsPart("wall", canvas, [c, -s, -s, -c, project.x(x), project.y(y)]);
}

function cellsPart(name, canvas, transform) {
  const { width, height } = canvas;
  return svg("image", { class: name, href: canvas.toDataURL(), width, height, transform: `matrix(${transform.join(" ")})` });
}

// The map that robots have built at a time: events are applied in order, and from the first on where time goes back.
function showExplored(now) {
  const current = lastUntil(growths, now, (one) => one.at);
  if (current === shownGrowth) return;
  if (current < shownGrowth) [exploredMap, shownGrowth] = [null, -1];
  for (const { grows } of growths.slice(shownGrowth + 1, current + 1)) exploredMap = grows && grownMap(exploredMap, grows);
  shownGrowth = current;
  const parts = exploredMap ? [cellsPart("explored", pictureOf(exploredMap, themeColors()), layOf(exploredMap, project))] : [];
  exploredPart.replaceChildren(...parts);
}

function themeColors() {
  const style = getComputedStyle(document.documentElement);
  return { quiet: style.getPropertyValue("--quiet"), ink: style.getPropertyValue("--ink") };
}

function scaleBar(height) {
  const step = niceStep(110 / project.scale, 1.5);
  const [x, y, length] = [12, height - 12, step * project.scale];
  const bar = svg("path", { d: `M${x} ${y - 4}v4h${length}v-4`, fill: "none", stroke: "var(--quiet)" });
  return svg("g", {}, bar, svg("text", { x: x + length + 6, y: y + 3 }, `${step} m`));
}

// The whole way of a robot, of which as much is shown as it has gone: `lengths` in pixels at each moment.
function trail(robot) {
  const lengths = [];
  let steps = "";
  let last = null;
  let length = 0;
  for (let k = 0; k < times.length; k += 1) {
    if (robot.x[k] !== null) {
      const here = [project.x(robot.x[k]), project.y(robot.y[k])];
      if (!last || Math.hypot(here[0] - last[0], here[1] - last[1]) > 0.3) {
        if (last) length += Math.hypot(here[0] - last[0], here[1] - last[1]);
        steps += `${last ? "L" : "M"}${here[0].toFixed(1)} ${here[1].toFixed(1)}`;
        last = here;
      }
    }
    lengths.push(length);
  }
  const look = { stroke: robot.color, "stroke-width": 2.2 * ROBOT_SCALE, opacity: 0.85 * ROBOT_SCALE };
  const path = svg("path", { class: "trail", d: steps || "M0 0", ...look });
  return { path, lengths };
}

function showRoutes(now) {
  const current = lastUntil(plans, now, (plan) => plan.at);
  if (current === shownPlan) return;
  shownPlan = current;
  const lines = current < 0 ? [] : plans[current].routes;
  routes.replaceChildren(...lines.map(([robot, flat]) => {
    const width = data.spatial ? 3 : 2;
    const corners = [];
    for (let k = 0; k < flat.length; k += width) corners.push([flat[k], flat[k + 1]]);
    return svg("polyline", { class: "route", points: points(corners), stroke: robots[robot].color });
  }));
}

const TASK_RADIUS = 5.5;
const STATION_RADIUS = 8;
const TASK_SHAPES = [
  ["circle", { r: TASK_RADIUS }],
  ["path", { class: "check", d: "M-2.8 .2 -.8 2.4 3 -2" }],
  ["path", { class: "cross", d: "M-3 -3 3 3M-3 3 3 -3" }],
];

function taskShapes() {
  return TASK_SHAPES.map(([name, attributes]) => svg(name, attributes));
}

function taskMark(task) {
  const shapes = svg("g", { transform: `scale(${TASK_SCALE})` }, ...taskShapes());
  const mark = svg("g", { class: "task", "data-task": task.id }, shapes, svg("title"));
  if (tasks.length <= MOST_NAMED_TASKS) mark.append(svg("text", { x: 8, y: 4 }, task.id));
  return mark;
}

function stationMark({ sign, place: [x, y], label }) {
  const cross = svg("path", { d: "M3-8V-3H8V3H3V8H-3V3H-8V-3H-3V-8Z" });
  const strike = svg("path", { class: "strike", d: "M-7-7 7 7M-7 7 7-7" });
  const transform = `translate(${project.x(x)} ${project.y(y)})`;
  const mark = svg("g", { class: "station", "data-station": sign, transform }, cross, strike, svg("title", {}, label));
  if (stations.length <= MOST_NAMED_STATIONS) mark.append(svg("text", { x: 10, y: 4 }, sign));
  return mark;
}

const robotRadius = (robot) => Math.max(robot.radius * project.scale, 6 * ROBOT_SCALE);

function robotMark(robot) {
  const radius = robotRadius(robot);
  const body = robot.kind === "air"
    ? svg("rect", { x: -radius, y: -radius, width: 2 * radius, height: 2 * radius, rx: radius / 2.5, fill: robot.color })
    : svg("circle", { r: radius, fill: robot.color });
  const nose = svg("line", { class: "nose", x2: radius, "stroke-width": 2 * ROBOT_SCALE });
  const turning = svg("g", { class: "body" }, body, nose);
  const mark = svg("g", { class: "robot", "data-robot": robot.id }, turning, svg("title", {}, robot.id));
  if (robots.length <= MOST_NAMED_ROBOTS) mark.append(svg("text", { x: radius + 3, y: -radius }, robot.id));
  return mark;
}

function showMap(now) {
  showExplored(now);
  showRoutes(now);
  const moment = Math.max(lastUntil(times, now), 0);
  trails.forEach(({ path, lengths }) => {
    const [here, next] = [lengths[moment] ?? 0, lengths[moment + 1] ?? lengths[moment] ?? 0];
    const gap = (times[moment + 1] ?? Infinity) - times[moment];
    const gone = here + (next - here) * Math.min(Math.max((now - times[moment]) / gap, 0), 1);
    path.setAttribute("stroke-dasharray", `${gone || 0} 1e6`);
  });
  placeTasks(now);
  tasks.forEach((task, k) => showTask(task, taskMarks[k], now));
  robots.forEach((robot, k) => showRobot(robot, robotMarks[k], now));
  stations.forEach((station, k) => showStation(station, stationMarks[k], now));
  (data.map?.zones ?? []).forEach((zone, k) => showZone(zone, zoneParts[k], now));
  nameRobots(now);
}

// Values over time are in milliseconds.
function showStation({ away, label }, mark, now) {
  const [, why] = currentOf(away, 1000 * now) ?? [0, ""];
  mark.classList.toggle("away", Boolean(why));
  mark.querySelector("title").textContent = why ? `${label}; ${why}, serves nobody` : label;
}

function showZone({ closed, label, label_open: labelOpen }, part, now) {
  const [, isClosed] = currentOf(closed, 1000 * now);
  part.classList.toggle("open", !isClosed);
  part.querySelector("title").textContent = isClosed ? label : labelOpen;
}

// Where marks of tasks are, and the names of what stands still; anew when a task has come or has moved.
function placeTasks(now) {
  const places = tasks.map((task) => currentOf(task.places, now)?.slice(1, 3) ?? null);
  if (taskPlaces.length === places.length && places.every((place, k) => String(place) === String(taskPlaces[k]))) return;
  taskPlaces = places;
  const radius = TASK_RADIUS * TASK_SCALE;
  const aside = asideOf(places);
  taskSpots = places.map((place, k) => place && [project.x(place[0]) + radius * aside[k][0], project.y(place[1]) + radius * aside[k][1]]);
  taskMarks.forEach((mark, k) => {
    mark.toggleAttribute("hidden", !places[k]);
    mark.style.display = places[k] ? "" : "none";
    if (places[k]) mark.setAttribute("transform", `translate(${taskSpots[k].join(" ")})`);
  });
  stillNames = new Names(mapPicture.viewBox.baseVal.width, mapPicture.viewBox.baseVal.height);
  const stationSpots = stations.map(({ place: [x, y] }) => [project.x(x), project.y(y)]);
  const seen = taskMarks.map((mark, k) => [mark, taskSpots[k], radius]).filter(([, spot]) => spot);
  const marks = [...stationMarks.map((mark, k) => [mark, stationSpots[k], STATION_RADIUS]), ...seen];
  for (const [, spot, size] of marks) stillNames.block(...spot, size);
  for (const [mark, spot, size] of marks) putName(stillNames, mark, ...spot, size);
}

function nameRobots(now) {
  if (robots.length > MOST_NAMED_ROBOTS) return;
  const names = new Names(stillNames.width, stillNames.height, stillNames.taken);
  const places = robots.map((robot) => [valueAt(robot.x, now), valueAt(robot.y, now)]);
  const seen = robots.map((robot, k) => [robotMarks[k], places[k], robotRadius(robot)]).filter(([, [x]]) => x !== null);
  for (const [, [x, y], radius] of seen) names.block(project.x(x), project.y(y), radius);
  for (const [mark, [x, y], radius] of seen) putName(names, mark, project.x(x), project.y(y), radius, true);
}

function showTask(task, mark, now) {
  if (mark.hasAttribute("hidden")) return;
  const [, state, robot] = currentOf(task.states, now);
  mark.setAttribute("class", `task ${state.replace(" ", "-")}`);
  mark.dataset.state = state;
  const by = robot ? ` by ${robot}` : "";
  mark.querySelector("title").textContent = `task ${task.id}${task.type ? ` (${task.type})` : ""}: ${state}${by}`;
}

function showRobot(robot, mark, now) {
  const [x, y, heading] = [valueAt(robot.x, now), valueAt(robot.y, now), valueAt(robot.heading, now)];
  mark.style.display = x === null ? "none" : "";
  if (x === null) return;
  Object.assign(mark.dataset, { x: x.toFixed(3), y: y.toFixed(3) });
  mark.setAttribute("transform", `translate(${project.x(x)} ${project.y(y)})`);
  mark.querySelector(".body").setAttribute("transform", `rotate(${(-heading * 180) / Math.PI})`);
  mark.classList.toggle("gone", Boolean(isGone(robot, now)));
}
