// Tasks at one place, such as the parts of an area: their marks are put beside each other, as the seeds of a sunflower lie.

export const MOST = 12; // tasks at one place; more stay one mark, whose name says how many there are
const GAP = 2.3; // between neighbours, in radii of a mark
const TURN = Math.PI * (3 - Math.sqrt(5));

// Of each task that shares its place its mark's distance from there, in radii: {id: [right, down]}.
export function asideOf(tasks) {
  const crowds = [...atOnePlace(tasks)].filter((ids) => ids.length > 1 && ids.length <= MOST);
  return new Map(crowds.flatMap((ids) => ids.map((id, k) => [id, seed(k)])));
}

// Of the first task of each place with too many the number of those beneath its mark.
export function hiddenBeneath(tasks) {
  const crowds = [...atOnePlace(tasks)].filter((ids) => ids.length > MOST);
  return new Map(crowds.map((ids) => [ids[0], ids.length - 1]));
}

function atOnePlace(tasks) {
  const found = new Map();
  for (const { id, x, y } of tasks) {
    const place = `${x} ${y}`;
    if (!found.has(place)) found.set(place, []);
    found.get(place).push(id);
  }
  return found.values();
}

function seed(k) {
  const far = GAP * Math.sqrt(k);
  return [far * Math.cos(k * TURN), far * Math.sin(k * TURN)];
}
