// Small forms in a dialogue: each is shown once and gives what was filled in, or null.

import { button, html } from "./elements.js";

// `fields`: elements with a name; gives {name: value} of those that are not empty.
function asked(host, title, words, fields, yes, look = "main") {
  return new Promise((resolve) => {
    const form = html("form", { method: "dialog" }, html("h2", {}, title));
    if (words) form.append(html("p", {}, words));
    form.append(...fields);
    const no = button("Leave it", () => dialog.close(), { class: "no" });
    form.append(html("footer", {}, no, html("button", { type: "submit", value: "yes", class: look }, yes)));
    const dialog = html("dialog", { class: "live-form", "aria-label": title }, form);
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog.returnValue === "yes" ? filled(form) : null);
    });
    host.append(dialog);
    dialog.showModal();
    (form.querySelector("input, select") ?? no).focus();
  });
}

function filled(form) {
  const found = {};
  for (const field of form.querySelectorAll("[name]")) {
    if (field.type === "checkbox") {
      if (field.checked) (found[field.name] ??= []).push(field.value);
    } else if (field.value !== "") found[field.name] = field.type === "number" ? Number(field.value) : field.value;
  }
  return found;
}

function labelled(words, field) {
  return html("label", {}, html("span", {}, words), field);
}

export async function confirmed(host, title, words, yes) {
  return (await asked(host, title, words, [], yes, "alarm")) !== null;
}

export async function askDelay(host, task) {
  const field = html("input", { type: "number", name: "by_s", min: "0.1", step: "any", value: "10", required: true });
  const told = await asked(host, `Delay ${task}`, "Its work takes so much longer, also if it is under way.", [labelled("seconds", field)], "Delay");
  return told && told.by_s;
}

// A task as a mission file has it, at a place that was clicked; null: none. `before` is what was filled in already.
export async function askTask(host, team, [x, y], before = {}) {
  const fields = [labelled("id", idField(team, before.id ?? team.newTaskId()))];
  const types = taskTypes(team.mission);
  if (types.length) fields.push(labelled("type", typeField(team.mission, types, before.type)));
  const skills = [...new Set((team.mission.robots ?? []).flatMap((robot) => robot.skills ?? []))].sort();
  if (skills.length) {
    const box = (skill) => html("input", { type: "checkbox", name: "requires", value: skill, checked: before.requires?.includes(skill) });
    const boxes = skills.map((skill) => html("label", { class: "box" }, box(skill), skill));
    fields.push(html("fieldset", {}, html("legend", {}, "skills that it takes"), ...boxes));
  }
  if (team.spatial) {
    const height = html("input", { type: "number", name: "z", step: "any", value: before.position?.[2] ?? usualHeight(team), required: true });
    fields.push(labelled("height, m", height));
  }
  const duration = html("input", { type: "number", name: "duration_s", min: "0", step: "any", placeholder: "none", value: before.duration_s });
  fields.push(labelled("duration, s", duration));
  const told = await asked(host, "A new task", `at ${x.toFixed(2)}, ${y.toFixed(2)} m`, fields, "Add the task");
  if (!told) return null;
  const { z, ...task } = told;
  return { ...task, position: z === undefined ? [round(x), round(y)] : [round(x), round(y), z] };
}

// An id that no task has; that is said before anything is asked for.
function idField(team, id) {
  const field = html("input", { name: "id", value: id, required: true, autocomplete: "off" });
  const check = () => field.setCustomValidity(team.tasks.has(field.value.trim()) ? `There is a task ${field.value.trim()} already.` : "");
  field.addEventListener("input", check);
  check();
  return field;
}

// Where there is a table of who suits what, a task without a type or with one that is not there is for nobody.
function typeField(mission, types, chosen) {
  const known = new Set(ratedTypes(mission));
  const option = (type) => html("option", { value: type, selected: type === chosen }, known.size && !known.has(type) ? `${type} (no robot is rated for it)` : type);
  const none = known.size ? [] : [html("option", { value: "" }, "none")];
  return html("select", { name: "type" }, ...none, ...types.map(option));
}

const ratedTypes = ({ suitability = {} }) => Object.values(suitability).flatMap((row) => Object.keys(row));

// Those of the table first.
function taskTypes(mission) {
  const rated = [...new Set(ratedTypes(mission))].sort();
  const others = [...new Set((mission.tasks ?? []).map((task) => task.type).filter(Boolean))].sort();
  return [...rated, ...others.filter((type) => !rated.includes(type))];
}

function usualHeight(team) {
  const heights = [...team.tasks.values()].map((task) => task.place[2]).sort((a, b) => a - b);
  return heights[Math.floor(heights.length / 2)] ?? 0;
}

function round(metres) {
  return Math.round(metres * 1000) / 1000;
}
