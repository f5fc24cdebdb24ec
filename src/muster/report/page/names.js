// Names that do not pile up: each is put right, left, above or below its mark, where there is room, or left out. Marks at one
// place are put beside each other. The maps of mission control do both in the same way.

const MOST_ASIDE = 12; // tasks at one place; more stay one mark
const ASIDE = 2.3; // between neighbours, in radii of a mark
const NAME_HEIGHT = 13; // pixels
const TURN = Math.PI * (3 - Math.sqrt(5));

// For each of some points, [x, y] or null, how far its mark is put from there, in radii: as the seeds of a sunflower lie.
function asideOf(places) {
  const crowds = new Map();
  places.forEach((place, k) => {
    if (!crowds.has(String(place))) crowds.set(String(place), []);
    crowds.get(String(place)).push(k);
  });
  const found = places.map(() => [0, 0]);
  for (const crowd of crowds.values()) if (crowd.length <= MOST_ASIDE) crowd.forEach((k, nth) => { found[k] = seed(nth); });
  return found;
}

function seed(k) {
  const far = ASIDE * Math.sqrt(k);
  return [far * Math.cos(k * TURN), far * Math.sin(k * TURN)];
}

class Names {
  // `taken`: boxes that are kept free, each [left, top, right, foot] in pixels.
  constructor(width, height, taken = []) {
    Object.assign(this, { width, height, taken: [...taken] });
  }

  block(x, y, radius) {
    this.taken.push([x - radius, y - radius, x + radius, y + radius]);
  }

  // The left end and middle of a name beside a mark, or null. `must`: at its right, come what may.
  place(x, y, radius, width, height, must = false) {
    const gap = radius + 3;
    const spots = [
      [x + gap, y], [x - gap - width, y], [x - width / 2, y - gap - height / 2], [x - width / 2, y + gap + height / 2],
    ];
    const box = ([left, middle]) => [left, middle - height / 2, left + width, middle + height / 2];
    const spot = spots.find((one) => this.isFree(box(one))) ?? (must ? spots[0] : null);
    if (spot) this.taken.push(box(spot));
    return spot;
  }

  isFree([left, top, right, foot]) {
    const within = left >= 0 && top >= 0 && right <= this.width && foot <= this.height;
    return within && !this.taken.some(([l, t, r, f]) => left < r && l < right && top < f && t < foot);
  }
}

// Puts the name of a mark at (x, y) where there is room for it, if the mark has one.
function putName(names, mark, x, y, radius, must = false) {
  const text = mark.querySelector("text");
  if (!text) return;
  mark.nameWidth ??= text.getComputedTextLength();
  const spot = names.place(x, y, radius, mark.nameWidth, NAME_HEIGHT, must);
  text.style.display = spot ? "" : "none";
  if (spot) Object.entries({ x: spot[0] - x, y: spot[1] - y + 4 }).forEach(([key, value]) => text.setAttribute(key, value.toFixed(1)));
}
