// What is told in words: figures, what each robot does, marks of tasks, events, the nearest pair.

const DOING = {
  travel: "travels to", waiting: "waits at", traffic: "waits in traffic on the way to", work: "works on",
  service: "is served at",
};
const robotList = document.getElementById("robots");
const eventList = document.getElementById("events");
const events = data.events.map(([at, text, alarming]) => ({ at: at / 1000, text, alarming }));
const spansOf = robots.map((robot) => spans.filter((span) => span.robot === robot.index));
let robotWords = [];
let eventItems = [];
let shownEvent = null;

function fillPanels() {
  const figures = data.figures.map(([name, value]) => html("div", {}, html("dt", {}, name), html("dd", {}, value)));
  document.getElementById("figures").append(...figures);
  const warning = document.getElementById("warning");
  warning.hidden = data.complete && data.ended;
  warning.textContent = data.complete ? "The mission did not come to its end." : "The record breaks off here.";
  fillRobots();
  fillKey();
  fillEvents();
}

function fillRobots() {
  robotWords = robots.map((robot) => {
    const swatch = html("span", { class: "swatch", style: `background:${robot.color}` });
    const words = html("span");
    robotList.append(html("li", { "data-robot": robot.id }, swatch, html("b", {}, robot.id), " ", words));
    return words;
  });
}

function fillKey() {
  const used = new Set(tasks.flatMap((task) => task.states.map(([, state]) => state)));
  const items = [...used].map((state) => {
    const mark = svg("g", { class: `task ${state.replace(" ", "-")}` }, ...taskShapes());
    return keyItem(mark, `task ${state}`);
  });
  if (growths.length) {
    for (const [name, words] of [["unseen", "not seen"], ["obstacle", "obstacle that was seen"]]) {
      items.push(keyItem(svg("rect", { class: name, x: -6, y: -6, width: 12, height: 12 }), words));
    }
  }
  document.getElementById("key").append(...items);
}

function keyItem(mark, words) {
  return html("li", {}, svg("svg", { viewBox: "-7 -7 14 14", "aria-hidden": "true" }, mark), words);
}

function fillEvents() {
  eventItems = events.map(({ at, text, alarming }) => {
    const words = html("span", alarming ? { class: "alarm" } : {}, text);
    const button = html("button", { type: "button" }, html("time", {}, seconds(at)), words);
    button.addEventListener("click", () => seek(at));
    eventList.append(html("li", {}, button));
    return button;
  });
}

function showPanels(now) {
  robots.forEach((robot, k) => {
    const words = doing(robot, now);
    if (robotWords[k].textContent !== words) robotWords[k].textContent = words;
    robotWords[k].classList.toggle("gone", Boolean(isGone(robot, now)));
  });
  showEvents(now);
  if (nearest && times.length) showNearest(now);
}

function doing(robot, now) {
  if (isGone(robot, now)) return `is out: ${isGone(robot, now)}`;
  const goesOn = (until) => until === duration && !data.ended; // beyond where the record breaks off
  const span = spansOf[robot.index].find(({ from, until }) => from <= now && (now < until || goesOn(until)));
  return span ? `${DOING[span.kind]} ${span.task || "its end"}` : "is free";
}

function showEvents(now) {
  const current = lastUntil(events, now, (event) => event.at);
  if (current === shownEvent) return;
  shownEvent = current;
  eventItems.forEach((item, k) => {
    item.classList.toggle("later", k > current);
    item.classList.toggle("now", k === current);
  });
  const item = eventItems[Math.max(current, 0)];
  if (item) eventList.scrollTop = item.offsetTop - eventList.offsetTop - eventList.clientHeight / 2;
}

function showNearest(now) {
  const k = Math.max(lastUntil(times, now), 0);
  const metres = nearest.metres[k];
  const pair = `${robots[nearest.first[k]].id} and ${robots[nearest.second[k]].id}`;
  const contact = nearest.touch[k] > 0 ? `; contact at ${nearest.touch[k].toFixed(2)} m` : "";
  document.getElementById("nearest").textContent = metres === null ? "" : `${pair}, ${metres.toFixed(2)} m${contact}`;
}
