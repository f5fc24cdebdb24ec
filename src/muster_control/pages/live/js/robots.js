// The table of robots: what each does, how much it has used; a click or a number selects one.

import { color, html, setText } from "./elements.js";
import { doing, spent } from "./words.js";

const USED = "Of its capacity, by way and work so far (metres, or seconds where the mission counts time)";
const LEFT = "What its battery has left";
const HEADS = [
  ["robot", "A circle drives, a diamond flies"],
  ["does", "What it does now; point at it for what lies ahead"],
  ["used", USED],
];

export class RobotTable {
  constructor({ onSelect }) {
    this.onSelect = onSelect;
    this.rows = new Map();
    this.body = html("tbody");
    const heads = HEADS.map(([words, title]) => html("th", { scope: "col", title }, words));
    this.spent = heads.at(-1);
    this.element = html("table", { class: "robots" }, html("thead", {}, html("tr", {}, ...heads)), this.body);
  }

  show(team, selected) {
    for (const robot of team.robots.values()) {
      if (!this.rows.has(robot.id)) this.addRow(robot);
      this.showRow(robot, team, selected?.robot === robot.id);
    }
    this.showHead([...team.robots.values()].map((robot) => spent(robot, team.unit)?.kind));
  }

  // A robot with a battery shows what that has left, others what they have used; a team may have both.
  showHead(kinds) {
    const [left, used] = [kinds.includes("battery"), kinds.includes("used") || !kinds.includes("battery")];
    setText(this.spent, left && used ? "battery, or used" : left ? "battery" : "used");
    this.spent.title = [left && LEFT, used && USED].filter(Boolean).join("; of others: ");
  }

  addRow(robot) {
    const name = html("button", { type: "button", class: "name", onclick: () => this.onSelect({ robot: robot.id }) });
    const shape = robot.kind === "air" ? "swatch air" : "swatch";
    name.append(html("span", { class: shape, style: `background:${color(robot.index)}` }), html("b", {}, robot.id));
    const row = {
      element: html("tr", { "data-robot": robot.id, onclick: () => this.onSelect({ robot: robot.id }) }),
      does: html("td", { class: "does" }),
      bar: html("i"),
      number: html("span"),
    };
    row.track = html("div", { class: "bar" }, row.bar);
    row.element.append(html("th", { scope: "row" }, name), row.does, html("td", { class: "spent" }, row.track, row.number));
    this.rows.set(robot.id, row);
    this.body.append(row.element);
  }

  showRow(robot, { unit, takenOut }, isSelected) {
    const row = this.rows.get(robot.id);
    setText(row.does, `${robot.out ? "⚠ " : ""}${doing(robot, takenOut)}`);
    row.does.title = robot.route.length ? `ahead: ${robot.route.join(", ")}` : "";
    row.element.classList.toggle("out", Boolean(robot.out));
    row.element.classList.toggle("selected", isSelected);
    const how = spent(robot, unit);
    setText(row.number, how?.words ?? "");
    row.track.hidden = how === null || how.share === null;
    if (!row.track.hidden) {
      row.bar.style.width = `${Math.min(Math.max(100 * how.share, 0), 100).toFixed(1)}%`;
      row.track.classList.toggle("battery", how.kind === "battery");
      row.track.classList.toggle("scarce", how.kind === "battery" ? how.share < 0.2 : how.share > 0.9);
    }
  }
}
