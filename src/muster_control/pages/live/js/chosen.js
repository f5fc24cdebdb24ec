// The robot or task that is selected: what is known of it, and what whoever may command can have done to it.

import { button, color, html } from "./elements.js";
import { FINAL } from "./team.js";
import { TASK_MARKS, doing } from "./words.js";

export class Chosen {
  constructor({ may, act, onCancel, onDelay, onMove, onMoveRobot, onSelect }) {
    Object.assign(this, { may, act, onCancel, onDelay, onMove, onMoveRobot, onSelect });
    this.element = html("section", { class: "chosen", "aria-live": "polite", hidden: true });
    this.shown = "";
  }

  show(team, selected) {
    const robot = team.robots.get(selected?.robot);
    const task = team.tasks.get(selected?.task);
    this.element.hidden = !robot && !task;
    const facts = robot ? robotFacts(robot, team) : task ? taskFacts(task, team) : [];
    const text = JSON.stringify([selected, facts, team.over]);
    if (text === this.shown) return; // so that a button does not vanish under the finger
    this.shown = text;
    if (!facts.length) return;
    const title = robot ? `Robot ${robot.id}` : `Task ${task.id}`;
    const mark = robot ? html("span", { class: "swatch", style: `background:${color(robot.index)}` }) : `${TASK_MARKS[task.state]} `;
    const close = button("✕", () => this.onSelect(null), { class: "close", "aria-label": "Close" });
    const list = html("dl");
    for (const [name, words] of facts) list.append(html("div", {}, html("dt", {}, name), html("dd", {}, words)));
    this.element.replaceChildren(html("header", {}, html("h2", {}, mark, title), close), list);
    if (this.may && !team.over) this.element.append(html("footer", {}, ...(robot ? this.forRobot(robot) : this.forTask(task))));
  }

  forRobot({ id, out, place }) {
    const back = ["event", { robot_returns: id }];
    if (out) {
      return [button("Bring back", () => this.act(...back, `Bring ${id} back into the team`), {
        class: "main", title: "It works and is heard again, from where it is; one that was taken away from where that was",
      })];
    }
    const undo = { words: `Bring ${id} back into the team`, verb: back[0], data: back[1] };
    const fail = () => this.act("event", { robot_fails: id }, `Take ${id} out`, { undo });
    const silence = () => this.act("event", { robot_silent: id }, `Let ${id} fall silent`, { undo });
    const remove = () => this.act("event", { robot_removed: id }, `Take ${id} away`, { undo });
    return [
      button("Move …", () => this.onMoveRobot(id, place), { title: "Somebody puts it elsewhere: then say where; it goes on from there" }),
      button("Take away", remove, { class: "alarm", title: "Somebody takes it off the ground, with what it has on board; others do its tasks" }),
      button("Take out", fail, { class: "alarm", title: "It stops where it is; others do its tasks, unless it is brought back" }),
      button("Let it fall silent", silence, { title: "A rehearsal of a radio that breaks: it goes on with its last order, and is not heard" }),
    ];
  }

  forTask({ id, state, place, action }) {
    if (FINAL.includes(state)) return [];
    const delay = button("Delay …", () => this.onDelay(id), { title: "Its work takes longer" });
    const move = button("Move …", () => this.onMove(id, place), { title: "Then click its new place on the map" });
    const stop = button("Cancel …", () => this.onCancel(id), { class: "alarm", title: "It is left, even if it is being done; what waits for it is lost" });
    return state === "open" && !action?.area ? [move, delay, stop] : [delay, stop];
  }
}

function robotFacts(robot, { takenOut }) {
  const facts = [["does", doing(robot, takenOut)]];
  if (robot.out) facts.push(["state", "takes no part until it is brought back"]);
  facts.push(["ahead", robot.route.length ? robot.route.join(" → ") : "nothing"]);
  if (robot.type) facts.push(["type", robot.type]);
  if (robot.skills?.length) facts.push(["skills", robot.skills.join(", ")]);
  return facts;
}

function taskFacts(task, team) {
  const facts = [["state", `${TASK_MARKS[task.state]} ${task.state}`]];
  const robot = team.robotOf(task.id);
  const { refusals, missed, delays, lying, doneTwice } = team.state;
  if (task.robots.length) facts.push(["by", task.robots.join(", ")]);
  else if (robot) facts.push(["by", robot.id]);
  else if (task.state === "open") facts.push(["by", ["nobody", team.whyNobody(task.id)].filter(Boolean).join(": ")]);
  const refused = Object.entries(refusals.get(task.id) ?? {}).map(([name, why]) => `${name}: ${why}`);
  if (refused.length) facts.push(["refused", refused.join("; ")]);
  if (missed.has(task.id)) facts.push(["missed", missed.get(task.id).reason]);
  if (delays.get(task.id)) facts.push(["delayed", `by ${delays.get(task.id)} s`]);
  if (lying.has(task.id)) facts.push(["load", `lies where ${lying.get(task.id).robot} failed`]);
  if (doneTwice.has(task.id)) facts.push(["twice", `begun by ${doneTwice.get(task.id).join(" and ")}`]);
  if (task.type) facts.push(["type", task.type]);
  if (task.requires?.length) facts.push(["takes", task.requires.join(", ")]);
  if (task.prerequisites?.length) facts.push(["after", [task.prerequisites].flat().map((one) => withState(one.task ?? one, team)).join(", ")]);
  facts.push(["at", task.place.slice(0, team.spatial ? 3 : 2).map((value) => value.toFixed(2)).join(", ")]);
  return facts;
}

function withState(id, team) {
  const state = team.tasks.get(id)?.state;
  return state ? `${id} ${TASK_MARKS[state]}` : id;
}
