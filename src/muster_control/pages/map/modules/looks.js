// Colours of the page's theme, and how robots and tasks look: by place in the mission, and never by colour alone.

const NAMES = ["paper", "panel", "ink", "quiet", "frame", "grid", "zone", "alarm", "accent", "open", "station", "service", "area", "area-edge"];
export const COLORS = 8;

// Strokes of the lines of robots: after eight robots the colours come again with another stroke.
const DASHES = [[], [9, 3], [9, 3, 2, 3], [2, 3]];

export function readTheme(element) {
  const style = getComputedStyle(element);
  const theme = Object.fromEntries(NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim() || "#888"]));
  theme.robots = Array.from({ length: COLORS }, (_, k) => style.getPropertyValue(`--c${k}`).trim() || "#888");
  theme.done = theme.robots[2];
  const size = parseFloat(style.getPropertyValue("--map-text")) || 12;
  theme.scale = size / 12;
  theme.font = `${size}px system-ui, sans-serif`;
  theme.bold = `600 ${size}px system-ui, sans-serif`;
  return theme;
}

export const robotColor = (theme, index) => theme.robots[index % COLORS];
export const robotDash = (index) => DASHES[Math.floor(index / COLORS) % DASHES.length];

// White or near black, whichever is read better upon a colour (WCAG 2, "relative luminance").
export function inkOn(color) {
  const hex = color.length === 4 ? color.replace(/[0-9a-f]/gi, "$&$&") : color;
  const channel = (k) => {
    const c = parseInt(hex.slice(k, k + 2), 16) / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  };
  return 0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5) < 0.24 ? "#fff" : "#111";
}

const turns = (count, offset = -0.25) => Array.from({ length: count }, (_, k) => {
  const angle = (k / count + offset) * 2 * Math.PI;
  return [Math.cos(angle), Math.sin(angle)];
});
const star = turns(10).map(([x, y], k) => (k % 2 ? [x * 0.5, y * 0.5] : [x * 1.2, y * 1.2]));
const scaled = (corners, factor) => corners.map(([x, y]) => [x * factor, y * factor]);

// Shapes of task types in the order in which the mission names them; null: a circle.
export const SHAPES = [
  null,
  scaled(turns(4, 0.125), 1.2), // square
  scaled(turns(3), 1.3), // triangle
  scaled(turns(4), 1.3), // diamond
  scaled(turns(5), 1.15), // pentagon
  star,
  scaled(turns(3, 0.25), 1.3), // triangle, its point down
  scaled(turns(6), 1.15), // hexagon
];

export function traceShape(context, x, y, radius, shape) {
  context.beginPath();
  if (!shape) {
    context.arc(x, y, radius, 0, 2 * Math.PI);
    return;
  }
  shape.forEach(([dx, dy], k) => context[k ? "lineTo" : "moveTo"](x + dx * radius, y + dy * radius));
  context.closePath();
}
