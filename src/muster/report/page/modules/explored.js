// The map that robots have built who had none: the fold of the events that tell how it grows, and its picture, a haze
// over what was not seen and the obstacles that were. The page of a record and mission control's live page draw by it.

const [UNSEEN, OBSTACLE] = [0, 2]; // as in `muster.state.explored_map`
const HAZE = 0.4; // opacity of what was not seen
const THERE = 0.85; // opacity of obstacles

// Return the map after an event `map_grows`; `before` is the map until then, null where there was none.
// {cell: metres, origin: [x, y, yaw], rows: what cells are, the lowest row first, area: m2}
export function grownMap(before, { cell_m: cell, origin, size: [height, width], runs = [], explored_m2: area = 0 }) {
  const rows = before?.rows ?? Array.from({ length: height }, () => new Array(width).fill(UNSEEN));
  for (const [row, first, count, value] of runs) rows[row].fill(value, first, first + count);
  return { cell, origin, ...before, rows, area };
}

// Return a canvas with a pixel a cell, the highest row first, in colours of the page's theme.
export function pictureOf({ rows }, { quiet, ink }) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [rows[0].length, rows.length];
  const context = canvas.getContext("2d");
  for (const [value, color, opacity] of [[UNSEEN, quiet, HAZE], [OBSTACLE, ink, THERE]]) {
    [context.fillStyle, context.globalAlpha] = [color, opacity];
    rows.forEach((row, k) => {
      for (let first = row.indexOf(value), end; first >= 0; first = row.indexOf(value, end)) {
        for (end = first + 1; row[end] === value;) end += 1;
        context.fillRect(first, rows.length - 1 - k, end - first, 1);
      }
    });
  }
  return canvas;
}

// Return the transform [a, b, c, d, e, f] from pixels of the picture to those of a view {x, y, scale}.
export function layOf({ cell, origin: [x, y, yaw], rows }, view) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)].map((part) => part * cell * view.scale);
  return [c, -s, s, c, view.x(x) - s * rows.length, view.y(y) - c * rows.length];
}
