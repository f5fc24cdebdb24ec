// The bar above the map: mission, state, clock, connection; and for whoever may command, pause, speed and the end.

import { button, clockTime, html, setText } from "./elements.js";
import { RUN_MARKS, speedWords } from "./words.js";

export const SPEEDS = [0.5, 1, 2, 5, 10, 20, 50, null]; // null: as fast as it goes
const SIMULATED = ["kinematic", "physics"];
const fast = (speed) => speed ?? Infinity;

export class Controls {
  constructor({ may, act, onAdd, onSpace, onUndo }) {
    this.act = act;
    this.asked = new Map(); // field of the run -> {token, value} of what was asked for last and is not settled
    this.state = html("span", { class: "run-state" });
    this.clock = html("output", { class: "clock", "aria-label": "Clock of the mission", title: "Clock of the mission" });
    this.remark = html("span", { class: "remark" });
    this.connection = html("span", { class: "connection", role: "alert", hidden: true });
    this.counts = html("span", { class: "counts", "aria-label": "Tasks" });
    this.hopeless = html("span", { class: "hopeless alarm", role: "status" });
    this.pause = button("❚❚ Pause", (event) => this.togglePause(event.detail > 1), { class: "pause main", title: "Pause or go on (space)" });
    this.speed = html("select", { "aria-label": "Speed", title: "Speed (+ and -)", onchange: () => this.setSpeed(this.chosen) });
    SPEEDS.forEach((speed, k) => this.speed.append(html("option", { value: k }, speedWords(speed))));
    this.speedLabel = html("label", { class: "speed" }, "Speed ", this.speed);
    this.speedWords = html("span", { class: "speed-words" });
    this.add = button("+ Task", onAdd, { class: "add", title: "Add a task by a click on the map (n)", "aria-pressed": "false" });
    this.undo = button("↶ Undo", onUndo, { class: "undo-last", title: "Take the last command back (Ctrl+Z)" });
    this.space = button("3-D", onSpace, { class: "space", title: "Seen in space (v)", "aria-pressed": "false", hidden: true });
    this.end = button("End the run …", () => this.onEnd(), { class: "end", title: "Stop carrying the mission out, for good" });
    this.commands = [this.pause, this.speedLabel, this.add, this.undo, this.end];
    this.may = may;
    this.title = html("span", { class: "title" });
    const told = html("div", { class: "told" }, this.title, this.state, this.clock, this.speedWords, this.counts, this.hopeless, this.connection, this.remark);
    this.given = html("div", { class: "given" }, this.pause, this.speedLabel, this.add, this.space, this.undo, this.end);
    this.element = html("header", { class: "controls" }, told, this.given);
  }

  get chosen() {
    return SPEEDS[Number(this.speed.value)];
  }

  show(team, undoable) {
    this.run = team.run;
    const { state, speed, world, remark, resumed, share } = team.run;
    setText(this.title, `${team.run.mission}, run ${team.run.id}`);
    const stage = state === "resuming" ? ` ${Math.round(100 * share)} %` : "";
    setText(this.state, `${RUN_MARKS[state]} ${state}${stage}`);
    this.state.dataset.state = state;
    setText(this.clock, clockTime(team.time));
    this.clock.dataset.seconds = team.time.toFixed(1);
    const again = resumed ? `went on ${resumed} × after a stop` : "";
    setText(this.remark, [remark, again].filter(Boolean).join("; "));
    setText(this.speedWords, this.may || team.over ? "" : speed === null ? speedWords(speed) : `at ${speedWords(speed)}`);
    this.showCounts(team.counts(), team.hopeless);
    for (const one of this.commands) one.hidden = !this.may || team.over;
    if (!this.may || team.over) return;
    const alive = state !== "starting";
    this.showPause();
    if (!SIMULATED.includes(world)) this.speedLabel.hidden = true;
    if (document.activeElement !== this.speed) this.showSpeed(speed);
    for (const one of [this.pause, this.speed, this.add, this.end]) one.disabled = !alive;
    if (state === "resuming") this.pause.disabled = true; // it may have been paused
    this.undo.disabled = !undoable;
  }

  // A speed that was asked for otherwise (by the command, say) is shown beside those that are offered here.
  showSpeed(speed) {
    const index = SPEEDS.indexOf(speed);
    this.other ??= html("option", { value: -1, hidden: true });
    if (index < 0) {
      setText(this.other, speedWords(speed));
      this.speed.append(this.other);
    }
    this.speed.value = index;
  }

  showCounts(counts, hopeless) {
    const total = Object.values(counts).reduce((sum, count) => sum + count, 0);
    const others = ["under way", "open", "lost", "cancelled"].filter((state) => counts[state]);
    const words = [`${counts.done} of ${total} tasks done`, ...others.map((state) => `${counts[state]} ${state}`)];
    setText(this.counts, words.join(", "));
    setText(this.hopeless, hopeless.length ? `⚠ ${hopeless.length} cannot be done` : "");
    this.hopeless.title = `Nobody is to do ${hopeless.join(", ")}: point at it on the map for the reason`;
    this.counts.classList.toggle("alarm", counts.lost > 0);
  }

  showConnection({ lostSince, why, forGood }) {
    clearInterval(this.counting);
    this.connection.hidden = lostSince === null;
    this.given.inert = lostSince !== null;
    if (lostSince === null) return;
    const tell = () => {
      const ago = Math.round((Date.now() - lostSince) / 1000);
      const next = forGood ? "reload the page" : "trying again";
      setText(this.connection, `⚠ connection lost ${ago} s ago${why ? ` (${why})` : ""}; ${next}`);
    };
    tell();
    if (!forGood) this.counting = setInterval(tell, 1000);
  }

  // What a field of the run is, or will be when what was asked for is done: the next key goes on from there.
  expected(field) {
    return this.asked.has(field) ? this.asked.get(field).value : this.run[field];
  }

  ask(field, value, ...command) {
    this.asked.set(field, { token: this.act(...command), value });
  }

  // What became of a command is known; what the run is follows in the same moment, but not before.
  settled(token, done) {
    for (const [field, { token: asked, value }] of this.asked) {
      if (asked !== token) continue;
      if (done) this.run[field] = value;
      this.asked.delete(field);
    }
  }

  // After a break the run's own state is what is known.
  forget() {
    this.asked.clear();
  }

  showPause() {
    setText(this.pause, this.expected("state") === "paused" ? "▶ Go on" : "❚❚ Pause");
  }

  // `twice`: the second click of a double click, which never sends robots on: nobody aims at what a button has become.
  togglePause(twice = false) {
    if (this.pause.disabled || this.given.inert) return;
    const paused = this.expected("state") === "paused" && !twice;
    this.ask("state", paused ? "running" : "paused", paused ? "resume" : "pause", {}, paused ? "Go on" : "Pause");
    this.showPause();
  }

  setSpeed(speed) {
    this.ask("speed", speed, "speed", { speed }, `Speed ${speedWords(speed)}`);
  }

  // One speed up (1) or down (-1).
  faster(by) {
    if (this.speed.disabled || this.given.inert || this.speedLabel.hidden) return;
    const now = fast(this.expected("speed"));
    const next = by > 0 ? SPEEDS.find((one) => fast(one) > now) : SPEEDS.findLast((one) => fast(one) < now);
    if (next !== undefined) this.setSpeed(next);
  }
}
