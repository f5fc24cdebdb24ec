// Stations: a cross where robots charge, swap batteries or unload, with its name in brackets.

import { Labels, write } from "./labels.js";
import { cross, robotRadius, short, taskRadius } from "./marks.js";

export const STATION_RADIUS = 8; // pixels
const ARM = 0.36; // half the width of an arm, of the radius

export const stationName = (id) => `[${short(id)}]`;

export function drawStations(context, view, stage) {
  const { scene, theme, places, chosen, hovered } = stage;
  if (!scene.stations.length) return;
  const radius = STATION_RADIUS * theme.scale;
  const labels = new Labels(view.width, view.height);
  for (const { x, y } of scene.stations) labels.block(view.x(x), view.y(y), radius);
  for (const task of scene.tasks) labels.block(...stage.spot(task), taskRadius(scene, theme));
  for (const { x, y } of scene.robots) labels.block(view.x(x), view.y(y), robotRadius(scene, theme));
  context.font = theme.font;
  for (const { id, x, y } of scene.stations) {
    const isChosen = places.is(chosen, "station", id);
    const isAway = stage.whyNoService(id) !== null;
    drawCross(context, view.x(x), view.y(y), radius, theme, isChosen, isAway);
    const must = isChosen || places.is(hovered, "station", id);
    const name = isAway ? `${stationName(id)} (out)` : stationName(id);
    const width = context.measureText(name).width;
    const spot = labels.place(view.x(x), view.y(y), radius, width, 12 * theme.scale, must);
    if (spot) write(context, name, spot, isAway ? theme.alarm : theme.station, theme.panel);
  }
}

// One that serves nobody is pale, in the colour of alarms, and crossed out.
function drawCross(context, x, y, radius, theme, isChosen, isAway) {
  const arm = radius * ARM;
  const corners = [[arm, -radius], [arm, -arm], [radius, -arm], [radius, arm], [arm, arm], [arm, radius],
    [-arm, radius], [-arm, arm], [-radius, arm], [-radius, -arm], [-arm, -arm], [-arm, -radius]];
  context.beginPath();
  corners.forEach(([dx, dy], k) => context[k ? "lineTo" : "moveTo"](x + dx, y + dy));
  context.closePath();
  context.fillStyle = isAway ? theme.panel : theme.service;
  context.fill();
  context.lineWidth = 1.6;
  context.strokeStyle = isAway ? theme.alarm : theme.station;
  context.stroke();
  if (isAway) cross(context, x, y, radius / 2.6, theme.alarm);
  if (!isChosen) return;
  context.beginPath();
  context.arc(x, y, radius + 5, 0, 2 * Math.PI);
  context.lineWidth = 2.4;
  context.strokeStyle = theme.accent;
  context.stroke();
}
