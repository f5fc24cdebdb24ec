// What lies under robots and tasks: tiles, floor plan, grid, areas, boundary, zones, and the scale bar.

import { niceStep } from "./view.js";

export function drawGround(context, view, scene, theme, pictures) {
  if (scene.tiles) pictures.drawTiles(context, view, scene.tiles);
  if (scene.image) pictures.drawFloor(context, view, scene.image);
  drawGrid(context, view, theme);
  for (const area of scene.areas) drawArea(context, view, area, theme);
  if (scene.boundary) {
    context.beginPath();
    trace(context, view, scene.boundary);
    context.lineWidth = 1.6;
    context.strokeStyle = theme.frame;
    context.stroke();
  }
  for (const zone of scene.zones) drawZone(context, view, zone, theme);
}

function drawGrid(context, view, theme) {
  const step = niceStep(120 / view.scale, 1);
  context.lineWidth = 1;
  context.strokeStyle = theme.grid;
  context.beginPath();
  const [west, east] = [view.metresX(0), view.metresX(view.width)];
  const [south, north] = [view.metresY(view.height), view.metresY(0)];
  for (let k = Math.ceil(west / step); k * step <= east; k += 1) {
    const x = Math.round(view.x(k * step)) + 0.5;
    context.moveTo(x, 0);
    context.lineTo(x, view.height);
  }
  for (let k = Math.ceil(south / step); k * step <= north; k += 1) {
    const y = Math.round(view.y(k * step)) + 0.5;
    context.moveTo(0, y);
    context.lineTo(view.width, y);
  }
  context.stroke();
}

// Adds a polygon to the path that has been begun.
function trace(context, view, corners) {
  corners.forEach(([x, y], k) => context[k ? "lineTo" : "moveTo"](view.x(x), view.y(y)));
  context.closePath();
}

// What tasks cover, without its holes.
function drawArea(context, view, { corners, holes }, theme) {
  context.beginPath();
  for (const ring of [corners, ...holes]) trace(context, view, ring);
  context.fillStyle = theme.area;
  context.globalAlpha = 0.6;
  context.fill("evenodd");
  context.globalAlpha = 1;
  context.lineWidth = 1;
  context.strokeStyle = theme["area-edge"];
  context.stroke();
}

// A zone is hatched where nobody may go, and only framed by dashes where some may; a door that is open has no ground.
function drawZone(context, view, zone, theme) {
  context.beginPath();
  trace(context, view, zone.corners);
  context.save();
  context.fillStyle = theme.zone;
  context.globalAlpha = zone.partly ? 0.35 : 0.8;
  if (!zone.open) context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = theme.frame;
  context.lineWidth = 1.3;
  context.setLineDash(zone.open ? [2, 4] : zone.partly ? [6, 4] : []);
  context.stroke();
  context.clip();
  context.setLineDash([]);
  context.globalAlpha = 0.45;
  if (!zone.open) hatch(context, view, zone);
  context.restore();
}

function hatch(context, view, zone) {
  const xs = zone.corners.map(([x]) => view.x(x));
  const ys = zone.corners.map(([, y]) => view.y(y));
  const [left, right] = [Math.max(Math.min(...xs), 0), Math.min(Math.max(...xs), view.width)];
  const [top, foot] = [Math.max(Math.min(...ys), 0), Math.min(Math.max(...ys), view.height)];
  const pitch = zone.partly ? 16 : 8;
  context.beginPath();
  for (let x = left - (foot - top); x < right; x += pitch) {
    context.moveTo(x, foot);
    context.lineTo(x + (foot - top), top);
  }
  context.lineWidth = 0.7;
  context.stroke();
}

export function drawScaleBar(context, view, theme) {
  const step = niceStep(110 / view.scale, 1.5);
  const length = step * view.scale;
  const [x, y] = [14, view.height - 14];
  const label = step >= 1000 ? `${step / 1000} km` : `${Number(step.toPrecision(3))} m`;
  context.font = theme.font;
  context.textBaseline = "middle";
  for (const [width, color] of [[5, theme.panel], [1.6, theme.ink]]) {
    context.lineWidth = width;
    context.strokeStyle = color;
    context.beginPath();
    context.moveTo(x, y - 5);
    context.lineTo(x, y);
    context.lineTo(x + length, y);
    context.lineTo(x + length, y - 5);
    context.stroke();
  }
  context.lineWidth = 4;
  context.strokeStyle = theme.panel;
  context.strokeText(label, x + length + 8, y - 3);
  context.fillStyle = theme.ink;
  context.fillText(label, x + length + 8, y - 3);
}
