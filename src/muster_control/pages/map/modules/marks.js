// Marks of tasks and robots with their names.

import { Labels, write } from "./labels.js";
import { inkOn, robotColor, SHAPES, traceShape } from "./looks.js";

const MANY_TASKS = 80; // beyond it marks become smaller
const MANY_ROBOTS = 30;
const LONGEST_NAME = 18;

export const taskRadius = (scene, theme) => shrunk(6.5, MANY_TASKS, scene.tasks.length, 0.45) * theme.scale;
export const robotRadius = (scene, theme) => shrunk(9, MANY_ROBOTS, scene.robots.length, 0.6) * theme.scale;
const shrunk = (size, many, count, least) => size * Math.min(Math.max(Math.sqrt(many / Math.max(count, 1)), least), 1);
export const short = (name) => (name.length > LONGEST_NAME ? `${name.slice(0, LONGEST_NAME - 1)}…` : name);

// All tasks, then their names: the chosen and the pointed-at first, then as the mission has them.
export function drawTasks(context, view, stage) {
  const { scene, places, theme, chosen, hovered } = stage;
  const radius = taskRadius(scene, theme);
  const seen = scene.tasks.filter((task) => isSeen(view, ...stage.spot(task)));
  for (const task of seen) drawStem(context, view, stage.spot(task), task, theme);
  for (const task of seen) drawTask(context, ...stage.spot(task), radius, task, stage);
  const labels = new Labels(view.width, view.height);
  const around = (task) => radius + stage.marginOf(task);
  for (const task of seen) labels.block(...stage.spot(task), around(task));
  for (const robot of scene.robots) labels.block(view.x(robot.x), view.y(robot.y), robotRadius(scene, theme));
  context.font = theme.font;
  const isFirst = (task) => places.is(chosen, "task", task.id) || places.is(hovered, "task", task.id);
  for (const task of [...seen.filter(isFirst), ...seen.filter((task) => !isFirst(task))]) {
    const at = stage.spot(task);
    const names = stage.namesOf(task);
    for (const text of names) {
      const must = isFirst(task) && text === names.at(-1);
      const spot = labels.place(...at, around(task), context.measureText(text).width, 12 * theme.scale, must);
      if (!spot) continue;
      write(context, text, spot, isFirst(task) || names.length > 1 ? theme.ink : theme.quiet, theme.panel);
      break;
    }
  }
}

const isSeen = (view, px, py) => px > -20 && py > -20 && px < view.width + 20 && py < view.height + 20;

// From the place that tasks share to the mark that is put beside it.
function drawStem(context, view, [px, py], { x, y }, theme) {
  const place = [view.x(x), view.y(y)];
  if (place[0] === px && place[1] === py) return;
  context.beginPath();
  context.moveTo(...place);
  context.lineTo(px, py);
  context.lineWidth = 1;
  context.strokeStyle = theme.quiet;
  context.stroke();
}

function drawTask(context, x, y, radius, task, stage) {
  const { theme, places, chosen, impossible } = stage;
  const state = stage.stateOf(task.id) ?? "open";
  const robot = places.robotIndex.get(stage.assigned.get(task.id));
  const color = robot === undefined ? null : robotColor(theme, robot);
  context.globalAlpha = state === "cancelled" ? 0.5 : 1;
  traceShape(context, x, y, radius, SHAPES[task.shape]);
  context.fillStyle = state === "done" ? theme.done : state === "open" && color ? color : theme.open;
  context.fill();
  context.lineWidth = state === "under way" ? 3 : 1.6;
  const alarming = state === "lost" || impossible.has(task.id);
  const strokes = { "under way": theme.accent, done: theme.done };
  context.strokeStyle = alarming ? theme.alarm : (strokes[state] ?? color ?? theme.quiet);
  context.setLineDash(state === "cancelled" || stage.leftOut.has(task.id) ? [2.5, 2] : []);
  context.stroke();
  context.setLineDash([]);
  if (state === "done") strike(context, x, y, radius / 6, [[-2.8, 0.2], [-0.8, 2.4], [3, -2]], "#fff");
  if (alarming || stage.leftOut.has(task.id)) cross(context, x, y, radius / 6, alarming ? theme.alarm : theme.quiet);
  context.globalAlpha = 1;
  if (places.is(chosen, "task", task.id)) ring(context, x, y, radius + 5, theme);
}

function strike(context, x, y, size, corners, color) {
  context.beginPath();
  corners.forEach(([dx, dy], k) => context[k ? "lineTo" : "moveTo"](x + dx * size, y + dy * size));
  context.strokeStyle = color;
  context.lineWidth = 2;
  context.stroke();
}

export function cross(context, x, y, size, color) {
  strike(context, x, y, size, [[-2.6, -2.6], [2.6, 2.6]], color);
  strike(context, x, y, size, [[-2.6, 2.6], [2.6, -2.6]], color);
}

function ring(context, x, y, radius, theme) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.lineWidth = 2.4;
  context.strokeStyle = theme.accent;
  context.stroke();
}

// Robots at `positionOf(robot)`: {x, y, heading, out, activity}.
export function drawRobots(context, view, stage, positionOf) {
  const { scene, theme, places, chosen, hovered } = stage;
  const labels = new Labels(view.width, view.height);
  const placed = scene.robots.map((robot) => ({ robot, index: places.robotIndex.get(robot.id), ...positionOf(robot) }));
  const radiusOf = (robot) => Math.max(robot.radius * view.scale, robotRadius(scene, theme));
  for (const { robot, x, y } of placed) labels.block(view.x(x), view.y(y), radiusOf(robot));
  for (const one of placed) drawRobot(context, view, one, radiusOf(one.robot), stage);
  context.font = theme.bold;
  for (const { robot, x, y, out } of placed) {
    const text = out ? `${short(robot.id)} (out)` : short(robot.id);
    const must = places.is(chosen, "robot", robot.id) || places.is(hovered, "robot", robot.id);
    const width = context.measureText(text).width;
    const spot = labels.place(view.x(x), view.y(y), radiusOf(robot), width, 13 * theme.scale, must);
    if (spot) write(context, text, spot, out ? theme.alarm : theme.ink, theme.panel);
  }
}

function drawRobot(context, view, { robot, index, x, y, heading, out, activity }, radius, stage) {
  const { theme, places, chosen } = stage;
  const color = robotColor(theme, index);
  context.save();
  context.translate(view.x(x), view.y(y));
  if (places.is(chosen, "robot", robot.id)) ring(context, 0, 0, radius + 5, theme);
  context.globalAlpha = out ? 0.45 : 1;
  context.rotate(-(heading ?? 0));
  (robot.kind === "air" ? airBody : groundBody)(context, radius);
  context.strokeStyle = theme.panel;
  context.lineWidth = 3;
  context.stroke();
  context.fillStyle = color;
  context.fill();
  nose(context, radius, inkOn(color));
  if (activity === "waiting" || activity === "in traffic") pauseSign(context, radius, heading ?? 0, theme);
  context.restore();
}

function groundBody(context, radius) {
  context.beginPath();
  context.arc(0, 0, radius, 0, 2 * Math.PI);
}

// Four rotors around a body.
function airBody(context, radius) {
  const arm = radius * 0.75;
  context.beginPath();
  for (const [dx, dy] of [[1, 1], [1, -1], [-1, -1], [-1, 1]]) {
    context.moveTo(dx * arm + radius * 0.55, dy * arm);
    context.arc(dx * arm, dy * arm, radius * 0.55, 0, 2 * Math.PI);
  }
  context.rect(-radius * 0.6, -radius * 0.6, radius * 1.2, radius * 1.2);
}

function nose(context, radius, color) {
  context.beginPath();
  context.moveTo(radius * 0.1, 0);
  context.lineTo(radius * 0.85, 0);
  context.strokeStyle = color;
  context.lineWidth = Math.max(radius / 4.5, 1.5);
  context.stroke();
}

function pauseSign(context, radius, heading, theme) {
  context.rotate(heading);
  context.fillStyle = theme.ink;
  context.fillRect(-radius * 0.2 - radius, -radius * 1.7, radius * 0.35, radius * 0.9);
  context.fillRect(radius * 0.4 - radius, -radius * 1.7, radius * 0.35, radius * 0.9);
}
