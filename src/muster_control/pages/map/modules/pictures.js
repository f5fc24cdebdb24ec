// Pictures under the map: a floor plan (also PGM, as mapping tools of ROS write it) and map tiles of this server.

const EARTH_RADIUS = 6378137; // metres, of the tiles' projection (EPSG:3857)
const MOST_TILES = 300; // kept
const TILE = 256; // pixels
const DEEPEST = 19;

export class Pictures {
  constructor(changed) {
    this.changed = changed;
    this.floors = new Map();
    this.tiles = new Map();
  }

  // `place`: {url, resolution (metres a pixel), origin: [x, y, yaw] of the lower left corner}.
  drawFloor(context, view, place) {
    if (!this.floors.has(place.url)) this.loadFloor(place.url);
    const picture = this.floors.get(place.url);
    if (!picture) return;
    const [x, y, yaw] = place.origin;
    const [c, s] = [Math.cos(yaw), Math.sin(yaw)].map((part) => part * place.resolution * view.scale);
    const { height } = picture;
    context.save();
    context.imageSmoothingEnabled = place.resolution * view.scale < 1;
    context.globalAlpha = 0.55;
    context.transform(c, -s, s, c, view.x(x) - s * height, view.y(y) - c * height);
    context.drawImage(picture, 0, 0);
    context.restore();
  }

  // Its size in metres is part of what is to be seen; unknown until it is here.
  floorCorners(place) {
    const picture = this.floors.get(place.url);
    if (!picture) return [];
    const [x, y, yaw] = place.origin;
    const [width, height] = [picture.width * place.resolution, picture.height * place.resolution];
    const at = (a, b) => [x + Math.cos(yaw) * a - Math.sin(yaw) * b, y + Math.sin(yaw) * a + Math.cos(yaw) * b];
    return [at(0, 0), at(width, 0), at(0, height), at(width, height)];
  }

  async loadFloor(url) {
    this.floors.set(url, null);
    const answer = await fetch(url);
    if (!answer.ok) return;
    const data = await answer.arrayBuffer();
    const picture = isGreyMap(data) ? greyMap(data) : await createImageBitmap(new Blob([data]));
    this.floors.set(url, withoutPaper(picture));
    this.changed(true);
  }

  // `tiles`: {url with {z}, {x}, {y}, origin: [latitude, longitude] in degrees}.
  drawTiles(context, view, { url, origin }) {
    const stretch = Math.cos((origin[0] * Math.PI) / 180); // metres on the ground a metre of the projection
    const world = 2 * Math.PI * EARTH_RADIUS;
    const level = Math.round(Math.log2((world * view.scale * stretch) / TILE));
    const z = Math.min(Math.max(level, 0), DEEPEST);
    const size = (world / 2 ** z) * stretch; // metres on the ground
    const column0 = ((origin[1] + 180) / 360) * 2 ** z;
    const latitude = (origin[0] * Math.PI) / 180;
    const row0 = ((1 - Math.asinh(Math.tan(latitude)) / Math.PI) / 2) * 2 ** z;
    const first = { column: Math.floor(column0 + view.metresX(0) / size), row: Math.floor(row0 - view.metresY(0) / size) };
    const last = { column: column0 + view.metresX(view.width) / size, row: row0 - view.metresY(view.height) / size };
    context.globalAlpha = 0.75;
    for (let column = first.column; column < last.column; column += 1) {
      for (let row = first.row; row < last.row; row += 1) {
        const tile = this.tile(url.replace("{z}", z).replace("{x}", column).replace("{y}", row));
        const [x, y] = [view.x((column - column0) * size), view.y((row0 - row) * size)];
        const side = size * view.scale + 0.5;
        if (tile.complete && tile.naturalWidth) context.drawImage(tile, x, y, side, side);
      }
    }
    context.globalAlpha = 1;
  }

  tile(url) {
    let tile = this.tiles.get(url);
    if (!tile) {
      if (this.tiles.size >= MOST_TILES) this.tiles.delete(this.tiles.keys().next().value);
      tile = new Image();
      tile.onload = () => this.changed(false);
      tile.src = url;
      this.tiles.set(url, tile);
    }
    return tile;
  }
}

const isGreyMap = (data) => String.fromCharCode(...new Uint8Array(data, 0, Math.min(2, data.byteLength))) === "P5";

// A binary PGM: "P5", width, height, the greatest value (up to 255), one byte a pixel; comments after #.
function greyMap(data) {
  const bytes = new Uint8Array(data);
  const numbers = [];
  let at = 2;
  while (numbers.length < 3) {
    while (bytes[at] <= 32) at += 1;
    if (bytes[at] === 35) while (bytes[at] !== 10) at += 1;
    else {
      let digits = "";
      while (bytes[at] > 32) digits += String.fromCharCode(bytes[at++]);
      numbers.push(Number(digits));
    }
  }
  const [width, height, most] = numbers;
  const canvas = new OffscreenCanvas(width, height);
  const pixels = new ImageData(width, height);
  for (let k = 0; k < width * height; k += 1) pixels.data.fill((bytes[at + 1 + k] * 255) / most, 4 * k, 4 * k + 3);
  for (let k = 3; k < pixels.data.length; k += 4) pixels.data[k] = 255;
  canvas.getContext("2d").putImageData(pixels, 0, 0);
  return canvas;
}

// What is free (light) becomes clear, and walls grey, so that a floor plan is read in both themes.
function withoutPaper(picture) {
  const canvas = new OffscreenCanvas(picture.width, picture.height);
  const context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  const pixels = context.getImageData(0, 0, picture.width, picture.height);
  for (let k = 0; k < pixels.data.length; k += 4) {
    const dark = 255 - (pixels.data[k] + pixels.data[k + 1] + pixels.data[k + 2]) / 3;
    pixels.data.set([128, 130, 136, (dark * pixels.data[k + 3]) / 255], k);
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}
