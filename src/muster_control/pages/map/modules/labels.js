// Names that do not pile up: each is put right, left, above or below its mark, where there is room, or left out.

const CELL = 3; // pixels of the raster of what is taken

export class Labels {
  constructor(width, height) {
    this.columns = Math.ceil(width / CELL) + 1;
    this.rows = Math.ceil(height / CELL) + 1;
    this.taken = new Uint8Array(this.columns * this.rows);
  }

  // Keeps a mark free of names.
  block(x, y, radius) {
    this.each(x - radius, y - radius, 2 * radius, 2 * radius, (k) => { this.taken[k] = 1; });
  }

  // The left end and middle of a name beside the mark at (x, y), or null. `must`: at its right, come what may.
  place(x, y, radius, width, height, must = false) {
    const gap = radius + 3;
    const spots = [
      [x + gap, y], [x - gap - width, y], [x - width / 2, y - gap - height / 2], [x - width / 2, y + gap + height / 2],
    ];
    const free = spots.find(([left, middle]) => this.isFree(left, middle - height / 2, width, height));
    const spot = free ?? (must ? spots[0] : null);
    if (spot) this.each(spot[0], spot[1] - height / 2, width + 2, height, (k) => { this.taken[k] = 1; });
    return spot;
  }

  isFree(x, y, width, height) {
    let free = x >= 0 && y >= 0 && x + width < (this.columns - 1) * CELL && y + height < (this.rows - 1) * CELL;
    if (free) this.each(x, y, width, height, (k) => { if (this.taken[k]) free = false; });
    return free;
  }

  each(x, y, width, height, visit) {
    const right = Math.min(Math.floor((x + width) / CELL), this.columns - 1);
    const foot = Math.min(Math.floor((y + height) / CELL), this.rows - 1);
    for (let row = Math.max(Math.floor(y / CELL), 0); row <= foot; row += 1) {
      for (let column = Math.max(Math.floor(x / CELL), 0); column <= right; column += 1) {
        visit(row * this.columns + column);
      }
    }
  }
}

export function write(context, text, [x, y], color, halo) {
  context.textBaseline = "middle";
  context.lineWidth = 3.5;
  context.lineJoin = "round";
  context.strokeStyle = halo;
  context.strokeText(text, x, y);
  context.fillStyle = color;
  context.fillText(text, x, y);
}
