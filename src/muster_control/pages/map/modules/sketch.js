// The zone that is being drawn: a corner a click; Enter, a double-click or its first corner closes it.

const NEAR = 9; // pixels within which a click means a corner that is there

export class Sketch {
  constructor(stage) {
    Object.assign(this, { stage, corners: [], pointer: null });
  }

  get isEmpty() { return this.corners.length === 0; }

  // Takes a click at a place in metres; returns the corners when they are closed by it, else null.
  click(place) {
    const { view } = this.stage;
    const isNear = ([x, y]) => Math.hypot(view.x(x) - view.x(place[0]), view.y(y) - view.y(place[1])) < NEAR;
    if (this.corners.length > 2 && isNear(this.corners[0])) return this.close();
    if (this.isEmpty || !isNear(this.corners.at(-1))) this.corners.push(place);
    this.stage.draw();
    return null;
  }

  // The corners, if there are enough for a zone; the drawing is then begun anew.
  close() {
    if (this.corners.length < 3) return null;
    const { corners } = this;
    this.clear();
    return corners;
  }

  point(place) {
    this.pointer = place;
    if (!this.isEmpty) this.stage.draw(true);
  }

  dropLast() {
    this.corners.pop();
    this.stage.draw();
  }

  clear() {
    Object.assign(this, { corners: [], pointer: null });
    this.stage.draw();
  }

  draw(context, theme) {
    if (this.isEmpty) return;
    const { view } = this.stage;
    const points = this.pointer ? [...this.corners, this.pointer] : this.corners;
    context.strokeStyle = theme.accent;
    context.fillStyle = theme.paper;
    context.lineWidth = 2;
    context.setLineDash([6, 4]);
    context.beginPath();
    points.forEach(([x, y], k) => context[k ? "lineTo" : "moveTo"](view.x(x), view.y(y)));
    if (points.length > 2) context.closePath();
    context.stroke();
    context.setLineDash([]);
    this.corners.forEach(([x, y], k) => {
      context.beginPath();
      context.arc(view.x(x), view.y(y), k ? 4 : 7, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    });
  }
}
