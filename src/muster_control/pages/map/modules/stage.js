// The map as a whole: what is shown, on two canvases: the ground with tasks and routes, which change seldom, and robots.

import { asideOf, hiddenBeneath } from "./aside.js";
import { drawGround, drawScaleBar } from "./ground.js";
import { drawPrerequisites, drawRoutes, drawTrails } from "./lines.js";
import { Live } from "./live.js";
import { readTheme } from "./looks.js";
import { drawRobots, drawTasks, robotRadius, short, taskRadius } from "./marks.js";
import { drawStations, STATION_RADIUS } from "./stations.js";
import { Pictures } from "./pictures.js";
import { Sketch } from "./sketch.js";
import { boundsOf, View } from "./view.js";

const EMPTY = { robots: [], tasks: [], stations: [], zones: [], areas: [], boundary: null, image: null, tiles: null };
const HANDLE = 5; // pixels, half the side of the handle at a corner of a zone
const REACH = 8; // pixels around a mark within which it is meant

export class Stage {
  constructor(host, ground, top) {
    Object.assign(this, { host, ground, top, view: new View(), live: new Live(), scene: EMPTY, routes: [] });
    Object.assign(this, { chosen: null, hovered: null, showPrerequisites: false, editable: false });
    this.sketch = new Sketch(this);
    this.assigned = new Map();
    this.leftOut = new Set();
    this.impossible = new Set();
    this.pictures = new Pictures((grown) => { if (grown) this.fitIfWanted(); this.draw(); });
    this.dirty = { ground: false, top: false };
    this.onView = () => {};
    this.theme = readTheme(host);
    this.index();
  }

  show(scene) {
    const isFirst = this.scene === EMPTY;
    this.scene = { ...EMPTY, ...scene };
    this.impossible = new Set(this.scene.impossible ?? []);
    this.index();
    if (this.chosen && !this.find(this.chosen)) this.chosen = null;
    if (isFirst || !this.view.holds(boundsOf(this.marks()))) this.fitIfWanted(); // what is in sight stays where it is
    this.draw();
  }

  index() {
    this.places = {
      tasks: new Map(this.scene.tasks.map((task) => [task.id, task])),
      stations: new Map(this.scene.stations.map((station) => [station.id, station])),
      robots: new Map(this.scene.robots.map((robot) => [robot.id, robot])),
      robotIndex: this.robotIndex(),
      aside: asideOf(this.scene.tasks),
      beneath: hiddenBeneath(this.scene.tasks),
      is: (one, what, id) => one !== null && one.what === what && one.id === id,
    };
  }

  // The number of each robot, by which it has its colour: as in the plan that is shown, whose table and chart have the
  // same; robots that came into the mission afterwards follow.
  robotIndex() {
    const own = this.scene.robots.map(({ id }) => id);
    const order = new Map([...new Set([...this.routes.map(({ robot }) => robot), ...own])].map((id, k) => [id, k]));
    return new Map(own.map((id) => [id, order.get(id)]));
  }

  // A plan: {routes: [{robot, tasks, points}], left_out: [task ids]}, or null.
  showPlan(plan) {
    this.routes = plan?.routes ?? [];
    this.places.robotIndex = this.robotIndex();
    this.leftOut = new Set(plan?.left_out ?? []);
    this.assigned = new Map(this.routes.flatMap(({ robot, tasks }) =>
      (tasks ?? []).map((task) => [task, robot])));
    this.draw();
  }

  resize() {
    const { width, height } = this.host.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1;
    for (const canvas of [this.ground, this.top]) {
      canvas.width = Math.max(Math.round(width * ratio), 1);
      canvas.height = Math.max(Math.round(height * ratio), 1);
    }
    Object.assign(this.view, { width: Math.max(width, 1), height: Math.max(height, 1) });
    this.fitIfWanted();
    this.draw();
  }

  bounds() {
    const { areas, boundary, image } = this.scene;
    const covered = areas.flatMap(({ corners }) => corners);
    return boundsOf([...this.marks(), ...covered, ...(boundary ?? []), ...(image ? this.pictures.floorCorners(image) : [])]);
  }

  // Places of what is put on the ground: robots, tasks, stations, corners of zones.
  marks() {
    const { robots, tasks, stations, zones } = this.scene;
    return [...[...robots, ...tasks, ...stations].map(({ x, y }) => [x, y]), ...zones.flatMap((zone) => zone.corners)];
  }

  fit() {
    this.view.fit(this.bounds());
    this.moved();
  }

  fitIfWanted() { if (this.view.followsAll) this.view.fit(this.bounds()); }

  moved() {
    this.draw();
    this.onView(this.view.state);
  }

  draw(onlyTop = false) {
    const waiting = this.dirty.ground || this.dirty.top;
    this.dirty.top = true;
    if (!onlyTop) this.dirty.ground = true;
    if (!waiting) requestAnimationFrame(() => this.paint());
  }

  paint() {
    const now = performance.now();
    if (this.dirty.ground) this.paintGround(this.clear(this.ground));
    this.paintTop(this.clear(this.top), now);
    this.dirty = { ground: false, top: false };
    if (this.live.isMoving(now)) this.draw(true);
  }

  clear(canvas) {
    const context = canvas.getContext("2d");
    const ratio = canvas.width / this.view.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.view.width, this.view.height);
    return context;
  }

  paintGround(context) {
    const { view, scene, places, theme, chosen } = this;
    drawGround(context, view, scene, theme, this.pictures);
    const only = chosen?.what === "robot" ? chosen.id : null;
    drawRoutes(context, view, this.routes, places, theme, only);
    const task = chosen?.what === "task" ? chosen.id : null;
    if (this.showPrerequisites || task) drawPrerequisites(context, this, task);
    drawStations(context, view, this);
    drawTasks(context, view, this);
    if (this.editable) this.paintHandles(context);
    drawScaleBar(context, view, theme);
  }

  paintHandles(context) {
    context.fillStyle = this.theme.paper;
    context.strokeStyle = this.theme.accent;
    context.lineWidth = 1.5;
    for (const { corners } of this.scene.zones) {
      for (const [x, y] of corners) {
        context.beginPath();
        context.rect(this.view.x(x) - HANDLE, this.view.y(y) - HANDLE, 2 * HANDLE, 2 * HANDLE);
        context.fill();
        context.stroke();
      }
    }
  }

  paintTop(context, now) {
    drawTrails(context, this.view, this.live, this.places, this.theme);
    drawRobots(context, this.view, this, (robot) => this.robotAt(robot, now));
    this.sketch.draw(context, this.theme);
  }

  robotAt(robot, now = performance.now()) {
    const { activity = "", out = false } = this.live.robots.get(robot.id) ?? {};
    return { ...robot, ...(this.live.position(robot.id, now) ?? {}), activity, out };
  }

  // How far a task is, where the mission is under way.
  stateOf(id) {
    return this.live.tasks.get(id) ?? null;
  }

  // Why a station serves nobody; null: it serves.
  whyNoService() {
    return null;
  }

  find({ what, id, corner }) {
    if (what === "task") return this.places.tasks.get(id) ?? null;
    if (what === "station") return this.places.stations.get(id) ?? null;
    if (what === "robot") return this.places.robots.get(id) ?? null;
    const point = this.scene.zones[id]?.corners[corner ?? 0];
    return point ? { x: point[0], y: point[1] } : null;
  }

  // The pixel of a task's mark: at its place, or beside it where tasks share one.
  spot({ id, x, y }) {
    const [right, down] = this.places.aside.get(id) ?? [0, 0];
    const radius = taskRadius(this.scene, this.theme);
    return [this.view.x(x) + right * radius, this.view.y(y) + down * radius];
  }

  // What is at a pixel: robots before tasks before stations before corners of zones; the nearest of each.
  at(px, py) {
    const nearest = (items, radius) => {
      let best = null;
      let least = radius + REACH;
      for (const { x, y, spot, ...one } of items) {
        const [left, top] = spot ?? [this.view.x(x), this.view.y(y)];
        const gap = Math.hypot(left - px, top - py);
        if (gap < least) [best, least] = [one, gap];
      }
      return best;
    };
    const robots = this.scene.robots.map((robot) => {
      const { x, y } = this.robotAt(robot);
      return { what: "robot", id: robot.id, x, y };
    });
    const tasks = this.scene.tasks.map((task) => ({ what: "task", id: task.id, spot: this.spot(task) }));
    const stations = this.scene.stations.map(({ id, x, y }) => ({ what: "station", id, x, y }));
    const corners = this.editable ? this.corners() : [];
    return nearest(robots, robotRadius(this.scene, this.theme) - 4)
      ?? nearest(tasks, taskRadius(this.scene, this.theme) - 2)
      ?? nearest(stations, STATION_RADIUS * this.theme.scale - 2) ?? nearest(corners, HANDLE);
  }

  corners() {
    return this.scene.zones.flatMap(({ corners }, id) => corners.map(([x, y], corner) => ({ what: "zone", id, corner, x, y })));
  }

  // Whether it may be dragged: not the task of an area. A view of a run says so of its open tasks alone.
  movable({ what, id }) { return this.editable && !(what === "task" && this.places.tasks.get(id)?.fixed); }

  // What is wrong with a task of `impossible`, in words.
  whyNot() { return "can never be done"; }

  // What is written beside a task, the longest first: where there is no room, the next.
  namesOf(task) { return [this.withBeneath(task, short(task.id))]; }

  withBeneath(task, name) {
    const count = this.places.beneath.get(task.id);
    return count ? `${name} + ${count}` : name;
  }

  // How far around a task's mark nothing is written, in pixels.
  marginOf() { return 0; }

  // Moves something on the map alone: while it is dragged.
  place(one, x, y) {
    if (one.what === "zone") this.scene.zones[one.id].corners[one.corner] = [x, y];
    else {
      Object.assign(this.find(one), { x, y });
      this.index();
    }
    this.draw();
  }
}
