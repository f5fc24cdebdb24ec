// The view of a run: the stream is heard, the map and the panels show what it tells, commands go to the server's desk.

import { Chosen } from "./chosen.js";
import { Controls } from "./controls.js";
import { html } from "./elements.js";
import { EventList } from "./events.js";
import { askDelay, askTask, confirmed } from "./forms.js";
import { Ground } from "./ground.js";
import { listenToKeys } from "./keys.js";
import { Notices } from "./notices.js";
import { RobotTable } from "./robots.js";
import { SiteTable } from "./sites.js";
import { openSpace } from "./space.js";
import { Stream } from "./stream.js";
import { Team } from "./team.js";

const PANELS_MS = 200; // at most so often panels are written anew
const SCENE_KINDS = ["new_task", "move_task", "load_lies", "forgets", "robot_joins", "mission_begins", "door_closes", "door_opens"];
const TASK_KINDS = ["plan", "replanned", "station_fails", "station_returns", "station_unreachable"];

export class LiveView {
  // `act({token, verb, data})` asks the desk; its answer comes to `answer`.
  constructor(host, { path, ground, may, wall, act }) {
    Object.assign(this, { host, ask: act, may: may && !wall, selected: null, space: null, tokens: 0, waiting: null });
    this.team = new Team();
    this.makeParts(ground);
    this.stream = new Stream(path, {
      onMessage: (message) => this.take(message),
      onConnection: (connection) => this.connect(connection),
      isOver: () => this.team.over,
    });
    this.stopKeys = listenToKeys(this);
  }

  makeParts(ground) {
    const select = (one) => this.select(one);
    const act = (...command) => this.act(...command);
    const [may, movable] = [this.may, ({ what, id }) => this.movable(what, id)];
    this.controls = new Controls({
      may, act, onAdd: () => this.setAdding(!this.adding), onSpace: () => this.toggleSpace(),
      onUndo: () => this.notices.takeBack(),
    });
    this.controls.onEnd = () => this.end();
    this.ground = new Ground(this.team, ground, {
      movable,
      onChoose: (one) => select(one && ["robot", "task"].includes(one.what) ? { [one.what]: one.id } : null),
      onAdd: ({ x, y }) => this.clicked([x, y]),
      onMove: ({ id, x, y }) => this.moveTask(id, [x, y]),
    });
    this.robots = new RobotTable({ onSelect: select });
    this.sites = new SiteTable();
    this.chosen = new Chosen({ may, act, onSelect: select, onCancel: (task) => this.cancel(task), onDelay: (task) => this.delay(task), onMove: (task) => this.setMoving(task, (place) => this.moveTask(task, place)), onMoveRobot: (robot) => this.setMoving(robot, (place) => this.moveRobot(robot, place)) });
    this.events = new EventList({ onSelect: select });
    this.notices = new Notices({
      onUndo: ({ words, verb, data }) => act(verb, data, words), onSettled: (token, done) => this.controls.settled(token, done),
    });
    this.lost = false; // the connection
    this.hint = html("p", { class: "hint", role: "status", hidden: true });
    this.over = html("p", { class: "over", role: "status", hidden: true });
    this.spaceHost = html("div", { class: "space-host", hidden: true });
    const field = html("section", { class: "field", "aria-label": "Map" }, this.ground.element, this.spaceHost, this.hint, this.notices.element);
    const team = html("section", { class: "team", "aria-label": "Robots" }, this.robots.element);
    const side = html("aside", {}, this.chosen.element, team, this.sites.element, this.events.element);
    this.host.append(this.controls.element, this.over, html("div", { class: "floor" }, field, side));
  }

  // Without a connection nothing can be asked for.
  connect(connection) {
    this.lost = connection.lostSince !== null;
    this.controls.showConnection(connection);
    this.chosen.element.inert = this.notices.element.inert = this.lost;
    this.host.classList.toggle("lost", this.lost);
    if (this.lost) this.setAdding(false);
  }

  take(message) {
    const what = this.team.take(message);
    if (what === "all" || (what === "entry" && SCENE_KINDS.includes(message.kind))) this.ground.showScene();
    if (what === "all") {
      this.controls.space.hidden = !this.team.spatial;
      this.controls.forget();
    }
    if (what === "status") this.ground.showTasks();
    if (what === "entry" && TASK_KINDS.includes(message.kind)) this.ground.showTasks();
    if (what === "states" || what === "entry") this.ground.move();
    if (what === "entry") this.notices.happened(message);
    if (what === "action") this.notices.outcome(message.id, message.outcome, this.team.time);
    if (what === "action" && message.kept) this.notices.kept(message.id);
    if (what === "entry" && message.kind === "command") this.notices.outcome(message.data.action, message.data.outcome, message.time_s);
    this.waiting ??= setTimeout(() => this.showPanels(), PANELS_MS);
  }

  showPanels() {
    this.waiting = null;
    if (!this.team.run) return;
    const { team, selected } = this;
    this.controls.show(team, this.notices.undoable.length > 0);
    this.robots.show(team, selected);
    this.sites.show(team);
    this.chosen.show(team, selected);
    this.events.show(team, selected);
    if (team.over && this.over.hidden) this.showOver();
  }

  showOver() {
    const { id, state } = this.team.run;
    const { done, cancelled, ...others } = this.team.counts(); // what is open by now will not be done
    const not = Object.values(others).reduce((sum, count) => sum + count);
    const left = cancelled ? `, ${cancelled} cancelled` : "";
    const words = `The run is over (${state}): ${done} tasks done, ${not} not${left}. `;
    this.over.replaceChildren(words, html("a", { href: `/records/${id}` }, "Look at its record"));
    this.over.hidden = false;
    this.setAdding(false);
    this.stream.close();
  }

  select(one) {
    this.selected = one;
    this.ground.select(one);
    this.showPanels();
  }

  // The robot that many places after the one that is selected, or by its number (from 0).
  selectRobot(number) {
    const ids = [...this.team.robots.keys()];
    if (ids[number]) this.select({ robot: ids[number] });
  }

  nextRobot(by) {
    const ids = [...this.team.robots.keys()];
    const here = ids.indexOf(this.selected?.robot);
    this.selectRobot(here < 0 ? (by > 0 ? 0 : ids.length - 1) : (here + by + ids.length) % ids.length);
  }

  // Commands

  // `undo`: {words, verb, data} of the command that takes it back; `again`: lets one ask otherwise if it is refused.
  act(verb, data, words, { undo = null, again = null } = {}) {
    if (this.lost) return;
    const token = (this.tokens += 1);
    this.notices.ask(token, words, { undo, again });
    this.ask({ token, verb, data });
    return token;
  }

  answer(told) {
    this.notices.answer(told, this.team.time);
    this.showPanels();
  }

  movable(what, id) {
    const task = what === "task" ? this.team.tasks.get(id) : null;
    return this.may && !this.lost && !this.team.over && task?.state === "open" && !task.action?.area;
  }

  moveTask(task, [x, y]) {
    const [, , z] = this.team.tasks.get(task).place;
    const to = (place) => ({ move_task: { task, position: this.team.spatial ? place : place.slice(0, 2) } });
    const undo = { words: `Move ${task} back`, verb: "event", data: to(this.team.tasks.get(task).place) };
    this.act("event", to([x, y, z]), `Move ${task} to ${x.toFixed(2)}, ${y.toFixed(2)}`, { undo });
    this.ground.showScene(); // where it is until it has been moved
  }

  setAdding(on) {
    if (on && (!this.may || this.lost || this.team.over)) return;
    if (on && this.space) this.toggleSpace();
    Object.assign(this, { adding: on, moving: null });
    this.controls.add.setAttribute("aria-pressed", String(on));
    this.showMode(on ? "Click where the new task is, or move the map by arrows and press Enter for its middle (Escape: none)" : "");
  }

  // Somebody has put a robot elsewhere.
  moveRobot(robot, [x, y]) {
    const z = this.team.robots.get(robot).place?.[2] ?? 0;
    const position = this.team.spatial ? [x, y, z] : [x, y];
    this.act("event", { robot_moved: { robot, position } }, `Move ${robot} to ${x.toFixed(2)}, ${y.toFixed(2)}`);
  }

  // `move`: what to do with the place that is clicked next.
  setMoving(id, move) {
    if (this.space) this.toggleSpace();
    this.setAdding(false);
    this.moving = move;
    this.showMode(`Click where ${id} is to be, drag it, or press Enter for the middle of the map (Escape: leave it)`);
  }

  showMode(words) {
    this.hint.textContent = words;
    this.hint.hidden = !words;
    this.ground.setMode(words ? "place" : "select");
  }

  async clicked(place) {
    const { moving } = this;
    this.setAdding(false);
    if (moving) {
      moving(place);
      return;
    }
    this.addTask(place);
  }

  // `before`: what was asked for and refused.
  async addTask(place, before = {}) {
    const task = await askTask(this.host, this.team, place, before);
    if (!task) return;
    const undo = { words: `Cancel ${task.id}`, verb: "event", data: { cancel_task: task.id } };
    const again = () => this.addTask(place, task);
    this.act("event", { new_task: task }, `Add task ${task.id}`, { undo, again });
  }

  async cancel(task) {
    const words = "It is left, even if it is being done, and what waits for it is lost. This cannot be taken back.";
    const agreed = await confirmed(this.host, `Cancel task ${task}?`, words, "Cancel the task");
    if (agreed) this.act("event", { cancel_task: task }, `Cancel task ${task}`);
  }

  async delay(task) {
    const by = await askDelay(this.host, task);
    if (by) this.act("event", { delay_task: { task, by_s: by } }, `Delay ${task} by ${by} s`);
  }

  async end() {
    const { done, open, "under way": underWay } = this.team.counts();
    const words = `${done} tasks are done, ${open + underWay} are not and will not be. This cannot be taken back.`;
    if (await confirmed(this.host, "End this run?", words, "End it")) this.act("cancel", {}, "End the run");
  }

  // Space

  async toggleSpace() {
    if (this.space) {
      this.space.close();
      this.space = null;
    } else if (!(await this.openSpace())) return;
    this.spaceHost.hidden = !this.space;
    this.ground.element.classList.toggle("behind", Boolean(this.space));
    this.controls.space.setAttribute("aria-pressed", String(Boolean(this.space)));
    this.frame();
  }

  async openSpace() {
    this.spaceHost.hidden = false;
    try {
      this.space = await openSpace(this.spaceHost, this.team);
    } catch (error) {
      this.spaceHost.hidden = true;
      this.notices.say(`This browser cannot show space (${error.message}); the map shows it from above.`);
    }
    return this.space;
  }

  frame() {
    if (!this.space) return;
    this.team.forget();
    this.space.draw(this.team, this.selected);
    requestAnimationFrame(() => this.frame());
  }

  close() {
    this.stream.close();
    this.stopKeys();
    this.ground.close();
    clearTimeout(this.waiting);
    if (this.space) this.space.close();
    this.space = null;
  }
}
