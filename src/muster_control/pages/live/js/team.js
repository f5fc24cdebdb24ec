// What is known of a run: the state of its mission, and what the stream tells beside events. Metres, seconds, radians.

import { Live } from "muster-map/live.js";

import { MissionState, three } from "./mission_state.js";

const OVER = ["ended", "cancelled", "failed"];
export const FINAL = ["done", "lost", "cancelled"];
const HIGHLIGHT_MS = 12000;
const ASTRAY_M = 1;

export class Team {
  constructor() {
    this.run = null;
    this.mission = null;
    this.state = new MissionState({});
    this.routes = new Map(); // robot -> [[x, y, z], ...]
    this.takenOut = new Map(); // robot -> who took it out
    this.entries = [];
    this.past = 0;
    this.moved = new Map(); // task -> {from, to, until}: changed robot a moment ago
    this.time = 0;
    this.live = new Live(); // where robots are, and have been
  }

  get robots() { return this.state.robots; }

  get tasks() { return this.state.tasks; }

  get over() {
    return this.run !== null && OVER.includes(this.run.state);
  }

  // Of usage.
  get unit() {
    return this.mission?.rules?.usage === "time" ? "s" : "m";
  }

  get spatial() {
    return (this.mission?.tasks ?? []).concat(this.mission?.robots ?? []).some((one) => one.position?.length === 3);
  }

  // Returns what has changed, as a word: "all", "states", "status", "entry", "run", "action".
  take(message) {
    const taken = { hello: "hear", states: "move", status: "learn", entry: "log", run: "turn" }[message.type];
    if (taken) this[taken](message);
    return message.type === "hello" ? "all" : message.type;
  }

  hear({ run, mission, seq }) {
    this.past = Math.max(this.past, seq); // entries up to here have happened before anybody looked
    this.run = run;
    if (!this.mission) this.state = new MissionState(mission ?? {});
    this.mission = mission ?? this.mission ?? {}; // of a run that goes on no more nobody tells it again
    this.time = Math.max(this.time, run.time_s ?? 0);
    this.makeReady();
  }

  // What a robot does before a status tells it.
  makeReady() {
    [...this.robots.values()].forEach((robot, index) => {
      const { activity = "idle", waits_for: waitsFor = [], available = true } = robot;
      Object.assign(robot, { index, activity, waits_for: waitsFor, available });
    });
  }

  move(message) {
    this.time = message.time_s;
    this.live.states(message);
  }

  // Where a robot is shown now, {x, y, z, heading}; null: it has not been heard.
  placeOf(robot) {
    return this.live.position(robot.id, performance.now());
  }

  trailOf(robot) {
    return this.live.robots.get(robot.id)?.trail ?? [];
  }

  // Of a robot what it does now; what became of it and its tasks, and its route, the state knows by events.
  learn(message) {
    const { time_s: time, robots = {} } = message;
    this.time = Math.max(this.time, time);
    this.live.status(message);
    for (const [id, { out: outWords, route: _, ...status }] of Object.entries(robots)) {
      if (this.robots.has(id)) Object.assign(this.robots.get(id), { ...status, outWords });
    }
  }

  log(entry) {
    const { seq, time_s: time, kind, data } = entry;
    this.time = Math.max(this.time, time);
    this.entries.push({ ...entry, time });
    this.state.apply(entry);
    if (kind === "plan") this.follow(data);
    if (kind === "command" && data.outcome === "done") this.obey(data);
    if (kind === "robot_returns") this.takenOut.delete(data.robot);
    if (kind === "robot_joins") this.makeReady();
    if (kind === "replanned" && seq > this.past) this.mark(data);
  }

  // The lines of a whole plan, or of robots whose routes have changed.
  follow({ plan = null, lines = {} }) {
    if (plan) this.routes.clear();
    for (const [robot, line] of Object.entries(lines)) this.routes.set(robot, line.map(three));
  }

  obey({ who, data }) {
    if (data?.robot_fails) this.takenOut.set(data.robot_fails, who);
  }

  // Why no robot is to do a task that is open, as the plan is now; null: one is, or it is open no more.
  whyNobody(id) {
    return this.tasks.get(id)?.state === "open" ? (this.state.leftOut.get(id) ?? null) : null;
  }

  get hopeless() {
    return [...this.state.leftOut.keys()].filter((id) => this.whyNobody(id) !== null);
  }

  mark({ moved = {}, added = {} }) {
    const until = performance.now() + HIGHLIGHT_MS;
    for (const [task, [from, to]] of Object.entries(moved)) this.moved.set(task, { from, to, until });
    for (const [task, to] of Object.entries(added)) this.moved.set(task, { from: null, to, until });
  }

  forget(now = performance.now()) {
    for (const [task, { until }] of this.moved) {
      if (until < now || FINAL.includes(this.tasks.get(task)?.state)) this.moved.delete(task);
    }
  }

  turn({ state, speed, time_s: time, remark, share = null }) {
    Object.assign(this.run, { state, speed, remark, share });
    this.time = Math.max(this.time, time ?? 0);
  }

  // How many tasks are in each state.
  counts() {
    const found = { open: 0, "under way": 0, ...this.state.forgotten };
    for (const task of this.tasks.values()) found[task.state] += 1;
    return found;
  }

  // The way that lies before a robot, from where it is: as much of its planned line as it has not gone yet.
  ahead(robot, { x, y, z }) {
    if (robot.out || this.over || (robot.activity === "idle" && !robot.route.length)) return [];
    const line = this.routes.get(robot.id);
    if (!line) return [];
    if (line !== robot.line) Object.assign(robot, { line, passed: 0 });
    robot.passed = furthest(line, robot.passed, [x, y, z]);
    return [[x, y, z], ...line.slice(robot.passed + 1)];
  }

  // Who is to do a task, by the routes that lie ahead.
  robotOf(task) {
    return [...this.robots.values()].find((robot) => robot.task === task || robot.route.includes(task)) ?? null;
  }

  newTaskId() {
    for (let number = 1; ; number += 1) if (!this.tasks.has(`new-${number}`)) return `new-${number}`;
  }
}

// The stretch of a line on which a place is, not before stretch `k`: the next one as long as that is no farther away,
// and the nearest of all that follow where the place is far from it, as for who comes late.
function furthest(line, k, place) {
  const far = (stretch) => distance(place, line[stretch], line[stretch + 1]);
  const last = line.length - 2;
  while (k < last && far(k + 1) <= far(k) + 1e-6) k += 1;
  if (k >= last || far(k) < ASTRAY_M) return k;
  let nearest = k;
  for (let other = k + 1; other <= last; other += 1) if (far(other) < far(nearest)) nearest = other;
  return nearest;
}

function distance(place, from, to) {
  const along = to.map((value, k) => value - from[k]);
  const length = along.reduce((sum, value) => sum + value * value, 0);
  const share = length && place.reduce((sum, value, k) => sum + (value - from[k]) * along[k], 0) / length;
  const at = Math.min(Math.max(share, 0), 1);
  return Math.hypot(...place.map((value, k) => value - from[k] - at * along[k]));
}
