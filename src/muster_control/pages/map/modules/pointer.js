// Mouse, pen and touch: panning, zooming by wheel and by two fingers, choosing, dragging, and adding by a click.

const STILL = 5; // pixels within which a press is a click
const WHEEL = 0.0015; // zoom a unit of the wheel, as an exponent

export function listenToPointer(element, stage, emit, modeOf) {
  const fingers = new Map();
  let drag = null; // {one, moved} while something is dragged, {moved} while the ground is
  const at = (event) => {
    const box = element.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  element.addEventListener("pointerdown", (event) => {
    if (event.button > 0) return;
    element.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, at(event));
    const one = fingers.size === 1 && modeOf() !== "zone" ? stage.at(...at(event)) : null;
    const found = one && stage.find(one);
    drag = { one, moved: 0, start: found && { x: found.x, y: found.y } };
  });

  element.addEventListener("pointermove", (event) => {
    const here = at(event);
    const last = fingers.get(event.pointerId);
    if (!last) {
      hover(here);
      return;
    }
    if (fingers.size === 2) pinch(event.pointerId, last, here);
    else if (drag) pull(last, here);
    fingers.set(event.pointerId, here);
  });

  const end = (event) => {
    if (!fingers.delete(event.pointerId) || fingers.size || !drag) return;
    const { one, moved, start } = drag;
    drag = null;
    if (event.type === "pointercancel") {
      if (one && start) stage.place(one, start.x, start.y);
    } else if (moved < STILL) click(one, at(event));
    else if (one && stage.movable(one)) {
      const { x, y } = stage.find(one);
      emit("move", { ...one, ...rounded(stage, x, y), from: [start.x, start.y] });
    }
  };
  element.addEventListener("pointerup", end);
  element.addEventListener("dblclick", () => { if (modeOf() === "zone") closed(stage.sketch.close()); });
  element.addEventListener("pointercancel", end);
  element.addEventListener("pointerleave", () => { if (stage.hovered) { stage.hovered = null; stage.draw(); emit("hover", null); } });
  element.addEventListener("wheel", (event) => {
    event.preventDefault();
    stage.view.zoom(Math.exp(-event.deltaY * WHEEL * (event.deltaMode ? 16 : 1)), ...at(event));
    stage.moved();
  }, { passive: false });

  function pull(last, here) {
    drag.moved += Math.hypot(here[0] - last[0], here[1] - last[1]);
    if (drag.moved < STILL) return;
    if (drag.one && stage.movable(drag.one)) {
      const { x, y } = rounded(stage, stage.view.metresX(here[0]), stage.view.metresY(here[1]));
      stage.place(drag.one, x, y);
    } else {
      stage.view.pan(here[0] - last[0], here[1] - last[1]);
      stage.moved();
    }
  }

  function pinch(id, last, here) {
    const [, other] = [...fingers].find(([finger]) => finger !== id);
    const gap = (point) => Math.max(Math.hypot(point[0] - other[0], point[1] - other[1]), 1);
    stage.view.zoom(gap(here) / gap(last), (here[0] + other[0]) / 2, (here[1] + other[1]) / 2);
    stage.view.pan((here[0] - last[0]) / 2, (here[1] - last[1]) / 2);
    drag = { one: null, moved: STILL };
    stage.moved();
  }

  function click(one, here) {
    const place = rounded(stage, stage.view.metresX(here[0]), stage.view.metresY(here[1]));
    if (modeOf() === "zone") {
      closed(stage.sketch.click([place.x, place.y]));
      return;
    }
    if (modeOf() === "place" || (adds(modeOf()) && !one)) emit("add", { what: modeOf(), ...place });
    else emit("choose", one && one.what !== "zone" ? one : null);
    if (one?.what === "zone") emit("choose", one);
  }

  function closed(corners) {
    if (corners) emit("zone", { corners });
  }

  function hover(here) {
    if (modeOf() === "zone") {
      element.style.cursor = "crosshair";
      stage.sketch.point([stage.view.metresX(here[0]), stage.view.metresY(here[1])]);
      return;
    }
    const one = stage.at(...here);
    if (one?.id === stage.hovered?.id && one?.what === stage.hovered?.what) return;
    stage.hovered = one;
    element.style.cursor = one ? (stage.movable(one) ? "move" : "pointer") : modeOf() === "select" ? "" : "crosshair";
    emit("hover", one && { ...one, px: here[0], py: here[1] });
    stage.draw();
  }
}

// Whether a click adds something: `place` also upon a mark, for it is for one click alone.
export function adds(mode) {
  return mode !== "select" && mode !== "zone";
}

// Places as finely as a pixel tells them, and no finer: at most centimetres.
export function rounded(stage, x, y) {
  const digits = Math.min(Math.max(Math.ceil(Math.log10(stage.view.scale)), 0), 2);
  return { x: Number(x.toFixed(digits)), y: Number(y.toFixed(digits)) };
}
