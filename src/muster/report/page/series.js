// The data of the page: series back from differences, values between two moments, and making elements.
// Metres, seconds, radians and per cent from here on.

const data = JSON.parse(document.getElementById("data").textContent);

function series(differences) {
  let sum = 0;
  return differences.map((step) => (step === null ? null : (sum += step) / 1000));
}

const times = series(data.times);
const duration = data.duration / 1000;
const robots = data.robots.map((robot, index) => ({
  ...robot,
  index,
  color: `var(--c${robot.color})`,
  radius: robot.radius / 1000,
  x: series(robot.x),
  y: series(robot.y),
  z: robot.z ? series(robot.z) : null,
  heading: series(robot.heading),
  level: robot.level ? robot.level.map(([at, share]) => [at / 1000, share / 1000]) : null,
  gone: robot.gone.map(([at, why]) => [at / 1000, why]),
}));
const tasks = data.tasks.map((task) => ({
  ...task,
  places: task.places.map((place) => place.map((value) => value / 1000)),
  states: task.states.map(([at, state, robot]) => [at / 1000, state, robot]),
}));
const stations = data.stations.map((one) => ({ ...one, place: one.place.map((value) => value / 1000) }));
const plans = data.plans.map((plan) => ({ ...plan, at: plan.at / 1000 }));
const growths = data.explored.map(([at, grows]) => ({ at: at / 1000, grows }));
const spans = data.spans.map(([robot, task, kind, from, until]) => ({
  robot, task, kind, from: from / 1000, until: until / 1000,
}));
const nearest = data.nearest && {
  ...data.nearest,
  metres: series(data.nearest.metres),
  touch: series(data.nearest.touch),
};

// The index of the last item whose time is not after `now`; -1 if there is none.
function lastUntil(items, now, timeOf = (item) => item) {
  let low = 0;
  let high = items.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (timeOf(items[middle]) <= now) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

// A series at a time, straight between two moments; null where the robot is not there.
function valueAt(values, now) {
  const k = Math.max(lastUntil(times, now), 0);
  const here = values[k];
  const next = values[k + 1];
  if (here === null || here === undefined || next === null || next === undefined) return here ?? null;
  const share = Math.min(Math.max((now - times[k]) / (times[k + 1] - times[k]), 0), 1);
  return here + share * (next - here);
}

function currentOf(items, now) {
  return items[lastUntil(items, now, (item) => item[0])];
}

// Why a robot takes no part; empty: it does.
function isGone(robot, now) {
  return (currentOf(robot.gone, now) ?? [0, ""])[1];
}

function seconds(value) {
  return `${value.toFixed(1)} s`;
}

// Elements

function html(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

function svg(name, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

// A picture as large as its element: one unit a pixel, so that text and strokes are as large everywhere.
function fitted(picture) {
  const { width, height } = picture.getBoundingClientRect();
  picture.setAttribute("viewBox", `0 0 ${Math.max(width, 1)} ${Math.max(height, 1)}`);
  picture.replaceChildren();
  return [Math.max(width, 1), Math.max(height, 1)];
}

// Round steps (1, 2, 5 times a power of ten) of which about `count` make up `range`.
function niceStep(range, count) {
  const rough = range / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * [1, 2, 5, 10].find((step) => step * power >= rough);
}
