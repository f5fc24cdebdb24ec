// The map by keyboard: moving the view, going from mark to mark, moving what is chosen, adding in the middle of the view.

import { adds, rounded } from "./pointer.js";
import { niceStep } from "./view.js";

const PAN = 60; // pixels
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

// `modeOf`: what a click does now. `letters`: n and p too go from mark to mark; a view in which they mean something else
// has . and , alone.
export function listenToKeys(element, stage, emit, modeOf, { letters = true } = {}) {
  const forth = letters ? ["n", ".", "]"] : [".", "]"];
  const back = letters ? ["p", ",", "["] : [",", "["];
  element.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey) return;
    const arrow = ARROWS[event.key];
    if (!stage.sketch.isEmpty && sketched(event.key)) {
      event.preventDefault();
      event.stopPropagation();
      return;
    }
    if (arrow && event.altKey) nudge(arrow, event.shiftKey ? 5 : 1);
    else if (event.altKey) return;
    else if (arrow) pan(arrow);
    else if (event.key === "+" || event.key === "=") zoom(1.25);
    else if (event.key === "-") zoom(0.8);
    else if (event.key === "0") stage.fit();
    else if (forth.includes(event.key)) next(1);
    else if (back.includes(event.key)) next(-1);
    else if (event.key === "r") { stage.showPrerequisites = !stage.showPrerequisites; stage.draw(); emit("prerequisites", stage.showPrerequisites); }
    else if (event.key === "Escape" && modeOf() === "place") return; // the view leaves it
    else if (event.key === "Escape") { emit("choose", null); emit("leave", null); }
    else if (event.key === "Enter" && adds(modeOf())) emit("add", { what: modeOf(), ...middle() });
    else if (event.key === " " && modeOf() === "zone") corner();
    else if (event.key === "Enter" && stage.chosen) emit("ask", stage.chosen);
    else if (event.key === "Delete" && stage.chosen && stage.editable) { if (!event.repeat) remove(stage.chosen); }
    else return;
    event.preventDefault();
    event.stopPropagation();
  });

  // Keys while a zone is drawn.
  function sketched(key) {
    if (key === "Enter") {
      const corners = stage.sketch.close();
      if (corners) emit("zone", { corners });
    } else if (key === "Escape") stage.sketch.clear();
    else if (key === "Backspace") stage.sketch.dropLast();
    else return false;
    return true;
  }

  function pan([dx, dy]) {
    stage.view.pan(-dx * PAN, dy * PAN);
    stage.moved();
  }

  function middle() {
    const { view } = stage;
    return rounded(stage, view.metresX(view.width / 2), view.metresY(view.height / 2));
  }

  function corner() {
    const { x, y } = middle();
    const corners = stage.sketch.click([x, y]);
    if (corners) emit("zone", { corners });
  }

  // Nothing is chosen afterwards: zones are known by number, and the next one would have it.
  function remove(one) {
    emit("remove", one.what === "zone" ? { ...one, corners: stage.scene.zones[one.id].corners } : one);
    emit("choose", null);
  }

  function zoom(factor) {
    stage.view.zoom(factor);
    stage.moved();
  }

  function next(step) {
    const { robots, tasks, stations } = stage.scene;
    const named = (items, what) => items.map(({ id }) => ({ what, id }));
    const all = [...named(robots, "robot"), ...named(tasks, "task"), ...named(stations, "station")];
    if (!all.length) return;
    const here = all.findIndex(({ what, id }) => stage.places.is(stage.chosen, what, id));
    const one = all[here < 0 ? (step > 0 ? 0 : all.length - 1) : (here + step + all.length) % all.length];
    const { x, y } = stage.find(one);
    stage.view.reveal(x, y);
    emit("choose", one);
  }

  // By the step of a tenth of the grid that is drawn, and not less than a centimetre.
  function nudge([dx, dy], times) {
    if (!stage.chosen || !stage.editable || stage.chosen.what === "zone" || !stage.movable(stage.chosen)) return;
    const step = Math.max(niceStep(120 / stage.view.scale, 1) / 10, 0.01) * times;
    const { x, y } = stage.find(stage.chosen);
    const place = rounded(stage, x + dx * step, y + dy * step);
    stage.place(stage.chosen, place.x, place.y);
    emit("move", { ...stage.chosen, ...place });
  }
}
