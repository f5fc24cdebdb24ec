// Stations and doors of the mission, and which of them serve or are open now; without either there is no table.

import { html, setText } from "./elements.js";

export class SiteTable {
  constructor() {
    this.rows = new Map();
    this.body = html("tbody");
    const heads = ["station, door", "now"].map((words) => html("th", { scope: "col" }, words));
    const table = html("table", {}, html("thead", {}, html("tr", {}, ...heads)), this.body);
    this.element = html("section", { class: "sites", "aria-label": "Stations and doors", hidden: true }, table);
  }

  show(team) {
    const { stations = [] } = team.mission;
    for (const { id } of stations) this.showRow(`station ${id}`, stationWords(id, team), team.state.whyNoService(id) !== null);
    for (const door of team.state.doors) {
      const isClosed = team.state.closedDoors.has(door);
      this.showRow(`door ${door}`, isClosed ? "closed" : "open", isClosed);
    }
    this.element.hidden = !this.rows.size;
  }

  showRow(name, words, isAway) {
    if (!this.rows.has(name)) {
      const [now, row] = [html("td"), html("tr", { "data-site": name }, html("th", { scope: "row" }, name))];
      row.append(now);
      this.body.append(row);
      this.rows.set(name, { row, now });
    }
    const { row, now } = this.rows.get(name);
    setText(now, `${isAway ? "⚠ " : ""}${words}`);
    row.classList.toggle("out", isAway);
  }
}

// Who is served there, or comes; or why nobody is.
function stationWords(id, team) {
  const why = team.state.whyNoService(id);
  if (why !== null) return why;
  const there = [...team.robots.values()].filter(({ station, out }) => station === id && !out).map((robot) => robot.id);
  return there.length ? `serves, for ${there.join(", ")}` : "serves";
}
