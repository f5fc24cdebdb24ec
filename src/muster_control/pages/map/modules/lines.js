// Lines on the map: routes of a plan with arrows, prerequisites, trails of where robots have been.

import { robotColor, robotDash } from "./looks.js";

const ARROW = 6; // pixels
const ARROW_EVERY = 90; // pixels

// `routes`: [{robot, lines: {travel, work, end}}], each a list of polylines in metres, or [{robot, points}] with one
// polyline. Work is drawn thin; robots other than `only` (if given) are faint.
export function drawRoutes(context, view, routes, places, theme, only) {
  for (const { robot, points, lines } of routes) {
    const index = places.robotIndex.get(robot);
    if (index === undefined) continue;
    const color = robotColor(theme, index);
    context.globalAlpha = only && only !== robot ? 0.18 : 0.85;
    context.strokeStyle = color;
    context.fillStyle = color;
    const ways = lines ? [...(lines.travel ?? []), ...(lines.end ?? [])] : [points ?? []];
    context.lineWidth = (only === robot ? 3 : 2) * theme.scale;
    context.setLineDash(robotDash(index));
    for (const way of ways) polyline(context, view, way);
    context.setLineDash([]);
    arrows(context, view, ways);
    context.lineWidth = 0.9 * theme.scale;
    for (const way of lines?.work ?? []) polyline(context, view, way);
  }
  context.globalAlpha = 1;
}

function polyline(context, view, points) {
  context.beginPath();
  points.forEach(([x, y], k) => context[k ? "lineTo" : "moveTo"](view.x(x), view.y(y)));
  context.stroke();
}

// An arrow at the middle of what lies between two of them, and at least one a stretch that is long enough to be seen.
function arrows(context, view, ways) {
  let since = ARROW_EVERY / 2;
  for (const points of ways) for (let k = 1; k < points.length; k += 1) {
    const [x1, y1] = [view.x(points[k - 1][0]), view.y(points[k - 1][1])];
    const [x2, y2] = [view.x(points[k][0]), view.y(points[k][1])];
    const length = Math.hypot(x2 - x1, y2 - y1);
    since += length;
    if (length < 14 || since < ARROW_EVERY / 2) continue;
    since = 0;
    arrow(context, (x1 + x2) / 2, (y1 + y2) / 2, Math.atan2(y2 - y1, x2 - x1));
  }
}

function arrow(context, x, y, angle) {
  const [c, s] = [Math.cos(angle) * ARROW, Math.sin(angle) * ARROW];
  context.beginPath();
  context.moveTo(x + c, y + s);
  context.lineTo(x - c - s * 0.8, y - s + c * 0.8);
  context.lineTo(x - c + s * 0.8, y - s - c * 0.8);
  context.fill();
}

// From each prerequisite to the task that waits for it; where one task is chosen, its own alone.
export function drawPrerequisites(context, stage, chosen) {
  const { scene, places, theme } = stage;
  context.strokeStyle = chosen ? theme.ink : theme.quiet;
  context.fillStyle = context.strokeStyle;
  context.lineWidth = 1;
  context.globalAlpha = chosen ? 0.9 : 0.6;
  context.setLineDash([4, 3]);
  for (const task of scene.tasks) {
    for (const before of task.prerequisites) {
      const first = places.tasks.get(before);
      if (!first || (chosen && chosen !== task.id && chosen !== before)) continue;
      const [from, to] = [stage.spot(first), stage.spot(task)];
      context.beginPath();
      context.moveTo(...from);
      context.lineTo(...to);
      context.stroke();
      const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
      arrow(context, from[0] + (to[0] - from[0]) * 0.62, from[1] + (to[1] - from[1]) * 0.62, angle);
    }
  }
  context.setLineDash([]);
  context.globalAlpha = 1;
}

export function drawTrails(context, view, live, places, theme) {
  context.lineJoin = "round";
  context.globalAlpha = 0.5;
  for (const [robot, { trail }] of live.robots) {
    const index = places.robotIndex.get(robot);
    if (index === undefined || trail.length < 2) continue;
    context.strokeStyle = robotColor(theme, index);
    context.lineWidth = 2 * theme.scale;
    polyline(context, view, trail);
  }
  context.globalAlpha = 1;
}
