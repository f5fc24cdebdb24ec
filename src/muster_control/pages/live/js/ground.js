// The map of a run: the map of all pages, on which robots move, with the ways ahead and what has just changed robot.

import { listenToKeys } from "muster-map/keys.js";
import { drawRoutes } from "muster-map/lines.js";
import { readTheme, robotColor, SHAPES } from "muster-map/looks.js";
import { listenToPointer } from "muster-map/pointer.js";
import { Stage } from "muster-map/stage.js";
import { told } from "muster-map/words.js";
import { layOf, pictureOf } from "muster-record/explored.js";

import { html } from "./elements.js";
import { moveWords } from "./words.js";

const PULSE_MS = 1200;
const FADE_MS = 2500; // at the end of a highlight
const RING = 11; // pixels

class RunStage extends Stage {
  explored = {}; // the map that robots have built: {of, theme, picture}

  movable(one) {
    return this.mayMove(one);
  }

  whyNot({ id }) {
    const why = this.team.whyNobody(id);
    return why ? `cannot be done: ${why}` : "nobody is to do it";
  }

  stateOf(id) {
    return this.team.tasks.get(id)?.state ?? null;
  }

  robotAt(robot, now = performance.now()) {
    return { ...super.robotAt(robot, now), out: Boolean(this.team.robots.get(robot.id)?.out) };
  }

  whyNoService(station) {
    return this.team.state.whyNoService(station);
  }

  namesOf(task) {
    const move = this.team.moved.get(task.id);
    return move ? [`${task.id}: ${moveWords(move)}`, ...super.namesOf(task)] : super.namesOf(task);
  }

  marginOf({ id }) {
    return this.team.moved.has(id) ? RING - 4 : 0;
  }

  // Highlights breathe and fade by the clock on the wall, also while the run is paused.
  paint() {
    const before = this.team.moved.size;
    this.team.forget();
    if (this.team.moved.size !== before) this.dirty.ground = true;
    super.paint();
    if (this.team.moved.size) this.draw(true);
  }

  paintTop(context, now) {
    this.paintExplored(context, this.team.state.explored);
    const only = this.chosen?.what === "robot" ? this.chosen.id : null;
    drawRoutes(context, this.view, this.ways(), this.places, this.theme, only);
    super.paintTop(context, now);
    for (const [task, move] of this.team.moved) this.paintMove(context, task, move, now);
  }

  paintExplored(context, map) {
    if (!map) return;
    const { theme, view } = this;
    if (this.explored.of !== map || this.explored.theme !== theme) {
      this.explored = { of: map, theme, picture: pictureOf(map, theme) };
    }
    context.save();
    context.imageSmoothingEnabled = false;
    context.transform(...layOf(map, view));
    context.drawImage(this.explored.picture, 0, 0);
    context.restore();
  }

  ways() {
    return [...this.team.robots.values()].flatMap((robot) => {
      const place = this.team.placeOf(robot);
      return place ? [{ robot: robot.id, points: this.team.ahead(robot, place) }] : [];
    });
  }

  // A task that has just been given to another robot: a ring that breathes, in that robot's colour.
  paintMove(context, id, { to, until }, now) {
    const task = this.places.tasks.get(id);
    if (!task) return;
    const [x, y] = this.spot(task);
    const radius = (RING + 1.5 * Math.sin((2 * Math.PI * now) / PULSE_MS)) * this.theme.scale;
    context.globalAlpha = Math.min(Math.max((until - now) / FADE_MS, 0), 1);
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.lineWidth = 3;
    context.strokeStyle = robotColor(this.theme, this.places.robotIndex.get(to) ?? 0);
    context.stroke();
    context.globalAlpha = 1;
  }
}

export class Ground {
  // `under`: {image, tiles} as the map of all pages takes them.
  constructor(team, under, { onChoose, onAdd, onMove, movable }) {
    Object.assign(this, { team, under, mode: "select", types: [] });
    const [low, top] = [html("canvas", { "aria-hidden": "true" }), html("canvas", { "aria-hidden": "true" })];
    this.hint = html("div", { class: "muster-map-hint", hidden: true });
    this.host = html("div", { class: "muster-map-host", tabindex: "0", role: "application", "aria-roledescription": "map", "aria-label": "Map with robots and tasks" }, low, top, this.hint);
    this.element = html("div", { class: "muster-map" }, this.host, this.buttons());
    this.stage = new RunStage(this.host, low, top);
    Object.assign(this.stage, { team, live: team.live, mayMove: movable });
    const heard = { choose: onChoose, add: onAdd, move: onMove, hover: (one) => this.point(one), prerequisites: () => this.stage.draw() };
    const emit = (name, data) => heard[name]?.(data);
    listenToPointer(this.host, this.stage, emit, () => this.mode);
    listenToKeys(this.host, this.stage, emit, () => this.mode, { letters: false });
    this.sizes = new ResizeObserver(() => this.stage.resize());
    this.sizes.observe(this.host);
    this.scheme = window.matchMedia("(prefers-color-scheme: dark)");
    this.retheme = () => { this.stage.theme = readTheme(this.host); this.stage.draw(); };
    this.scheme.addEventListener("change", this.retheme);
  }

  buttons() {
    const zoom = (factor) => () => { this.stage.view.zoom(factor); this.stage.moved(); };
    const part = (sign, name, onclick) => html("button", { type: "button", title: name, "aria-label": name, onclick }, sign);
    return html("div", { class: "muster-map-buttons", role: "group", "aria-label": "View of the map" },
      part("+", "Nearer", zoom(1.4)), part("−", "Farther", zoom(1 / 1.4)), part("⤢", "All of it", () => this.stage.fit()));
  }

  // What lies under all, which may be known later than the robots.
  lay(under) {
    this.under = under;
    if (!this.team.mission) return;
    this.showScene();
    this.stage.fitIfWanted();
  }

  // To be called where robots or tasks are new, or tasks have moved.
  showScene() {
    const robots = [...this.team.robots.values()].map(({ id, type, kind = "ground", radius_m: radius = 0, home: [x, y] }) =>
      ({ id, type: type ?? "", kind, radius, x, y }));
    const tasks = [...this.team.tasks.values()].map(({ id, type, action, place: [x, y], prerequisites = [] }) =>
      ({ id, type: type ?? action?.name ?? "", x, y, prerequisites: [prerequisites].flat().map((one) => one.task ?? one) }));
    this.types = shapedTypes(this.types, tasks);
    for (const task of tasks) task.shape = this.types.indexOf(task.type) % SHAPES.length;
    const areas = areasOf([...this.team.tasks.values()]);
    this.stage.show({ ...groundOf(this.team.mission, this.team.state), ...this.under, areas, robots, tasks });
    this.stage.theme = readTheme(this.host);
    this.showTasks();
  }

  // Whose each task is, by what lies ahead of robots.
  showTasks() {
    const routes = [...this.team.robots.values()].map((robot) =>
      ({ robot: robot.id, tasks: [...robot.route, ...(robot.task ? [robot.task] : [])], points: [] }));
    this.stage.showPlan({ routes });
    this.stage.impossible = new Set(this.team.hopeless);
    this.stage.draw();
  }

  move() {
    this.stage.draw(true);
  }

  select(selected) {
    const what = selected?.robot ? "robot" : "task";
    this.stage.chosen = selected ? { what, id: selected[what] } : null;
    this.stage.draw();
  }

  setMode(mode) {
    this.mode = mode;
    this.host.style.cursor = mode === "select" ? "" : "crosshair";
    this.host.classList.toggle("adding", mode !== "select");
    if (mode !== "select") this.host.focus({ preventScroll: true });
  }

  point(one) {
    this.hint.hidden = !one;
    if (!one) return;
    this.hint.textContent = told(this.stage, one);
    const right = one.px > this.stage.view.width / 2;
    const side = right ? { left: "", right: `${this.stage.view.width - one.px + 12}px` } : { right: "", left: `${one.px + 12}px` };
    Object.assign(this.hint.style, { ...side, top: `${one.py + 12}px` });
  }

  close() {
    this.sizes.disconnect();
    this.scheme.removeEventListener("change", this.retheme);
  }
}

// Types in the order of their shapes: sorted as in the mission, and what comes later after them, so that no shape changes.
function shapedTypes(known, tasks) {
  const all = [...new Set(tasks.map(({ type }) => type))].sort();
  return [...known, ...all.filter((type) => !known.includes(type))];
}

const laid = ({ id, services, slots = 1, position: [x, y, z] }) => ({ id, services, slots, x, y, z });

// Each area that tasks cover once, however many tasks it is split into, with its holes.
function areasOf(tasks) {
  const covered = tasks.filter(({ action }) => action?.area);
  const areas = covered.map(({ action: { area: corners, holes } }) => ({ corners, holes: holes ?? [] }));
  return [...new Map(areas.map((area) => [JSON.stringify(area), area])).values()];
}

// Boundary, zones and stations of a plain mission.
function groundOf({ map: chart, stations = [] }, { closedDoors }) {
  const zones = (chart?.zones ?? []).map(({ id, polygon, forbidden_to: whom = ["ground", "air"], floor_m: floor, ceiling_m: ceiling }, k) => ({
    corners: polygon,
    partly: whom.length < 2 || (floor ?? null) !== null || (ceiling ?? null) !== null,
    open: Boolean(id) && !closedDoors.has(id),
    label: id && !closedDoors.has(id) ? `door ${id}, open`
      : `${id ? `door ${id}` : `zone ${k + 1}`}, closed to ${whom.map((kind) => `${kind} robots`).join(" and ")}`,
  }));
  return { boundary: chart?.boundary ?? null, zones, stations: stations.map(laid) };
}
