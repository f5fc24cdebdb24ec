// The part of the ground that is seen: metres (x east, y north) to pixels and back; panning and zooming.

const BUTTONS = 30; // pixels more at the right, where the map has its buttons
const MARGIN = 34; // pixels around what is shown as a whole
const [LEAST, MOST] = [0.02, 4000]; // pixels a metre

export class View {
  constructor() {
    Object.assign(this, { width: 1, height: 1, scale: 10, east: 0, north: 0 }); // `east`, `north`: the middle
    this.followsAll = true; // until somebody pans or zooms, everything stays in sight
  }

  x(metres) { return this.width / 2 + (metres - this.east) * this.scale; }
  y(metres) { return this.height / 2 - (metres - this.north) * this.scale; }
  metresX(pixels) { return this.east + (pixels - this.width / 2) / this.scale; }
  metresY(pixels) { return this.north - (pixels - this.height / 2) / this.scale; }

  pan(dx, dy) {
    this.followsAll = false;
    this.east -= dx / this.scale;
    this.north += dy / this.scale;
  }

  // Zooms so that the ground under the pixel (px, py) stays there.
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    this.followsAll = false;
    const [x, y] = [this.metresX(px), this.metresY(py)];
    this.scale = Math.min(Math.max(this.scale * factor, LEAST), MOST);
    this.east = x - (px - this.width / 2) / this.scale;
    this.north = y + (py - this.height / 2) / this.scale;
  }

  fit([west, south, east, north]) {
    const room = (pixels, metres) => Math.max(pixels - 2 * MARGIN, 10) / Math.max(metres, 1);
    this.scale = Math.min(room(this.width - BUTTONS, east - west), room(this.height, north - south), MOST);
    this.east = (west + east) / 2 + BUTTONS / 2 / this.scale;
    this.north = (south + north) / 2;
    this.followsAll = true;
  }

  // Whether all of a rectangle is in sight.
  holds([west, south, east, north]) {
    return this.x(west) >= 0 && this.x(east) <= this.width && this.y(north) >= 0 && this.y(south) <= this.height;
  }

  // Brings a place into sight if it is not.
  reveal(x, y) {
    const [px, py] = [this.x(x), this.y(y)];
    if (px >= MARGIN && py >= MARGIN && px <= this.width - MARGIN && py <= this.height - MARGIN) return;
    Object.assign(this, { east: x, north: y, followsAll: false });
  }

  get state() { return { scale: this.scale, east: this.east, north: this.north, followsAll: this.followsAll }; }
}

// Round steps (1, 2, 5 times a power of ten) of which about `count` make up `range`.
export function niceStep(range, count) {
  const rough = range / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * [1, 2, 5, 10].find((step) => step * power >= rough * 0.9999);
}

// The rectangle [west, south, east, north] around all places; a small one around the origin if there are none.
export function boundsOf(places) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [x, y] of places) {
    if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
    if (x < box[0]) box[0] = x;
    if (y < box[1]) box[1] = y;
    if (x > box[2]) box[2] = x;
    if (y > box[3]) box[3] = y;
  }
  return box[0] <= box[2] ? box : [-10, -10, 10, 10];
}
