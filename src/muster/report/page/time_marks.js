// What the mission asks of time, in the time chart: windows are shaded, deadlines and due times strokes, lateness is
// red, and the bars of a team are linked. Clock times at the axis, where the mission says when it starts.

const WINDOW_SHARE = 0.96; // heights, of a row
const LATE_SHARE = 0.12;
const CLOCK_STEPS = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 14400, 43200]; // seconds
const DAY_S = 86400;
const MARK_NAMES = [["window", "time window"], ["deadline", "deadline"], ["due", "due time"], ["late", "late"], ["team", "team"]];

// Those within the chart; a window is shaded as far as the chart reaches.
const marks = data.marks
  .filter((mark) => mark.from_s <= duration)
  .map((mark) => ({ ...mark, until_s: Math.min(mark.until_s ?? duration, duration) }));

function clockText(now) {
  const whole = Math.round(data.clock_start_s + now);
  const days = Math.floor(whole / DAY_S);
  const rest = whole - DAY_S * days;
  const parts = [rest / 3600, (rest / 60) % 60, rest % 60].map((part) => String(Math.floor(part)).padStart(2, "0"));
  return (days ? `+${days} ` : "") + parts.join(":");
}

// A time as people read it: by the clock where the mission has one.
function timeText(now) {
  return data.clock_start_s === null ? seconds(now) : clockText(now);
}

function tickText(now) {
  if (data.clock_start_s !== null) return clockText(now);
  return `${Number(now.toPrecision(6))}${now === 0 ? " s" : ""}`;
}

function tickStep(range, count) {
  if (data.clock_start_s === null) return niceStep(range, count);
  const rough = range / count;
  return CLOCK_STEPS.find((step) => step >= rough) ?? DAY_S * Math.ceil(rough / DAY_S);
}

function fillLegend() {
  const found = MARK_NAMES.filter(([kind]) => marks.some((mark) => mark.kind === kind));
  const inTraffic = spans.some(({ kind }) => kind === "traffic") ? [["traffic", "in traffic"]] : [];
  const served = spans.some(({ kind }) => kind === "service") ? [["service", "[station]"]] : [];
  const entries = [...["travel", "waiting", "work"].map((kind) => [kind, kind]), ...served, ...inTraffic, ...found];
  const named = entries.map(([kind, words]) => html("span", {}, html("i", { class: kind }), words));
  document.getElementById("legend").replaceChildren(...named);
}

// The marks of some kinds as shapes: windows lie below the bars, all others above them.
function markShapes(kinds, x, row) {
  const drawn = { window: windowShape, late: lateShape, deadline: strokeShape, due: strokeShape, team: teamShape };
  return marks.filter(({ kind }) => kinds.includes(kind)).map((mark) => {
    const shape = drawn[mark.kind](mark, x, row);
    shape.dataset.task = mark.task;
    shape.append(svg("title", {}, mark.words));
    return shape;
  });
}

function spanShape(mark, x, y, height) {
  const width = Math.max(x(mark.until_s) - x(mark.from_s), 1);
  return svg("rect", { class: mark.kind, x: x(mark.from_s), y, width, height });
}

function windowShape(mark, x, row) {
  const height = row * WINDOW_SHARE;
  return spanShape(mark, x, (mark.row + 0.5) * row - height / 2, height);
}

function lateShape(mark, x, row) {
  return spanShape(mark, x, (mark.row + 1) * row - row * LATE_SHARE, row * LATE_SHARE);
}

function strokeShape(mark, x, row) {
  const half = (row * WINDOW_SHARE) / 2;
  const middle = (mark.row + 0.5) * row;
  return svg("line", { class: mark.kind, x1: x(mark.from_s), x2: x(mark.from_s), y1: middle - half, y2: middle + half });
}

function teamShape(mark, x, row) {
  const [y, toY] = [(mark.row + 0.5) * row, (mark.to_row + 0.5) * row];
  const [from, until] = [x(mark.from_s), x(mark.until_s)];
  const r = Math.min(3, row / 4);
  const ends = [svg("circle", { cx: from, cy: y, r }), svg("circle", { cx: until, cy: toY, r })];
  return svg("g", { class: "team" }, svg("line", { x1: from, x2: until, y1: y, y2: toY }), ...ends);
}
