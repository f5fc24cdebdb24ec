// The map that robots have built who had none: a haze over what they have not seen, and the obstacles that they saw.

const [FREE, OBSTACLE] = [1, 2]; // as in `muster.state.explored_map`
const HAZE = [110, 110, 110, 120]; // red, green, blue, opacity
const THERE = [40, 40, 40, 220];

export class ExploredGround {
  constructor() {
    this.picture = null; // a pixel a cell
    this.drawn = -1; // how often the map had grown
  }

  draw(context, view, explored) {
    if (!explored) return;
    if (this.drawn !== explored.grown) this.paint(explored);
    const { cell, origin: [x, y, yaw], rows } = explored;
    const [c, s] = [Math.cos(yaw), Math.sin(yaw)].map((part) => part * cell * view.scale);
    context.save();
    context.imageSmoothingEnabled = false;
    context.transform(c, -s, s, c, view.x(x) - s * rows.length, view.y(y) - c * rows.length);
    context.drawImage(this.picture, 0, 0);
    context.restore();
  }

  paint({ rows, grown }) {
    const [width, height] = [rows[0].length, rows.length];
    const image = new ImageData(width, height);
    rows.forEach((row, k) => row.forEach((value, column) => {
      if (value !== FREE) image.data.set(value === OBSTACLE ? THERE : HAZE, 4 * ((height - 1 - k) * width + column));
    }));
    this.picture = new OffscreenCanvas(width, height);
    this.picture.getContext("2d").putImageData(image, 0, 0);
    this.drawn = grown;
  }
}
