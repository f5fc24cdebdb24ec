// What happened, newest first: words with their times, alarming ones marked, a filter.

import { html, seconds } from "./elements.js";

const MOST_SHOWN = 400;
const FILTERS = {
  all: ["all", () => true],
  alarms: ["alarming", ({ mark }) => mark === "alarm"],
  changes: ["changes of the plan", ({ mark }) => ["alarm", "change"].includes(mark)],
  selected: ["of what is selected", (entry, selected) => concerns(entry, selected)],
};

export class EventList {
  constructor({ onSelect }) {
    this.onSelect = onSelect;
    this.shown = 0;
    this.choice = html("select", { "aria-label": "Which events", onchange: () => this.again() });
    for (const [name, [words]] of Object.entries(FILTERS)) this.choice.append(html("option", { value: name }, words));
    this.list = html("ol", { class: "events", tabindex: "0", "aria-label": "Events, newest first" });
    this.none = html("p", { class: "quiet" }, "Nothing yet.");
    const head = html("header", {}, html("h2", {}, "Events"), this.choice);
    this.element = html("section", { class: "events-panel" }, head, this.none, this.list);
  }

  show(team, selected) {
    this.team = team;
    if (this.choice.value === "selected" && !sameSelection(this.selected, selected)) this.again(selected);
    this.selected = selected;
    for (; this.shown < team.entries.length; this.shown += 1) this.add(team.entries[this.shown]);
    while (this.list.childElementCount > MOST_SHOWN) this.list.lastElementChild.remove();
    this.none.hidden = this.list.childElementCount > 0;
  }

  again(selected = this.selected) {
    this.selected = selected;
    this.list.replaceChildren();
    this.shown = 0;
    if (this.team) this.show(this.team, selected);
  }

  add(entry) {
    const [, wanted] = FILTERS[this.choice.value];
    if (entry.mark === "detail" || !wanted(entry, this.selected)) return;
    const words = html("span", {}, entry.mark === "alarm" ? "⚠ " : "", entry.line);
    const item = html("li", { class: entry.mark || null, "data-kind": entry.kind });
    item.append(html("time", {}, seconds(entry.time)), words);
    const about = subject(entry, this.team);
    if (about) item.addEventListener("click", () => this.onSelect(about));
    this.list.prepend(item);
  }
}

function sameSelection(first, second) {
  return first?.robot === second?.robot && first?.task === second?.task;
}

function concerns({ data }, selected) {
  if (!selected) return false;
  if (selected.robot) return data.robot === selected.robot || data.robots?.includes(selected.robot);
  return data.task === selected.task || selected.task in (data.moved ?? {}) || selected.task in (data.added ?? {});
}

function subject({ data }, team) {
  if (team.robots.has(data.robot)) return { robot: data.robot };
  if (team.tasks.has(data.task)) return { task: data.task };
  return null;
}
