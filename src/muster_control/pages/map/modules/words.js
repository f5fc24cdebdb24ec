// The map in words: what is chosen or pointed at, and a table of robots, tasks and stations for those who do not see it.

import { SHAPES } from "./looks.js";

const metres = (value) => `${Number(value.toFixed(2))}`;
const height = ({ z }) => (typeof z === "number" ? metres(z) : "");
const place = (one) => `at ${[metres(one.x), metres(one.y), height(one)].filter(Boolean).join(", ")} m`;

export function told(stage, one) {
  const found = stage.find(one);
  if (!found) return "";
  if (one.what === "zone") return `corner ${one.corner + 1} of ${stage.scene.zones[one.id].label}`;
  if (one.what === "station") return toldStation(stage, found);
  return one.what === "robot" ? toldRobot(stage, found) : toldTask(stage, found);
}

function toldRobot(stage, robot) {
  const { x, y, activity, out } = stage.robotAt(robot);
  const route = stage.routes.find((one) => one.robot === robot.id);
  const parts = [`robot ${robot.id}`, robot.type, robot.kind === "air" ? "flies" : "", place({ x, y, z: robot.z })];
  if (activity) parts.push(activity);
  if (out) parts.push("is out");
  const order = route?.order ?? route?.tasks;
  if (order) parts.push(order.length ? `does ${order.join(", ")}` : "has no task");
  return parts.filter(Boolean).join("; ");
}

function toldStation(stage, station) {
  const slots = station.slots > 1 ? `${station.slots} slots` : "";
  const sign = `[${station.id}]`;
  const who = stage.routes.filter(({ order }) => order?.includes(sign)).map(({ robot }) => robot);
  const served = who.length ? `serves ${who.join(", ")}` : "";
  const why = stage.whyNoService(station.id);
  return [`station ${station.id}`, station.services.join(", "), slots, place(station), why ?? served].filter(Boolean).join("; ");
}

function toldTask(stage, task) {
  const parts = [`task ${task.id}`, task.type ? `type ${task.type}` : "", place(task)];
  const robot = stage.places.robots.get(stage.assigned.get(task.id));
  if (robot) parts.push(`done by ${robot.id}`);
  if (stage.leftOut.has(task.id)) parts.push("left out of the plan");
  if (stage.impossible.has(task.id)) parts.push(stage.whyNot(task));
  if (task.prerequisites.length) parts.push(`after ${task.prerequisites.join(", ")}`);
  if (task.delivers) parts.push(`delivers ${task.delivers}`);
  const state = stage.stateOf(task.id);
  if (state) parts.push(state);
  return parts.filter(Boolean).join("; ");
}

// A table for screen readers; made anew when the scene or the plan changes, not with each movement.
export function fillTable(table, stage) {
  const row = (cells, name) => {
    const line = document.createElement("tr");
    for (const cell of cells) {
      const box = document.createElement(name);
      box.textContent = cell;
      line.append(box);
    }
    return line;
  };
  const nameOf = (robot) => stage.places.robots.get(robot)?.id ?? "";
  const robots = stage.scene.robots.map((r) => row(["robot", r.id, r.type, metres(r.x), metres(r.y), height(r), "", ""], "td"));
  const tasks = stage.scene.tasks.map((t) => row(
    ["task", t.id, t.type, metres(t.x), metres(t.y), height(t), t.prerequisites.join(" "), nameOf(stage.assigned.get(t.id))], "td"));
  const stations = stage.scene.stations.map((s) => row(
    ["station", s.id, s.services.join(" "), metres(s.x), metres(s.y), height(s), "", ""], "td"));
  table.replaceChildren(row(["what", "name", "type", "x in m", "y in m", "z in m", "after", "done by"], "th"), ...robots, ...tasks, ...stations);
}

// Shapes by task type, in the order in which types appear.
export function withShapes(scene) {
  const types = [...new Set(scene.tasks.map(({ type }) => type))].sort();
  return { ...scene, tasks: scene.tasks.map((task) => ({ ...task, shape: types.indexOf(task.type) % SHAPES.length })) };
}
