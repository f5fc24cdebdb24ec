// The keyboard of a run's view; forms and the map have their own keys while they have the focus.

export function listenToKeys(view) {
  const plain = {
    " ": () => view.may && view.controls.togglePause(),
    "+": () => view.may && view.controls.faster(1),
    "-": () => view.may && view.controls.faster(-1),
    ArrowDown: () => view.nextRobot(1),
    ArrowUp: () => view.nextRobot(-1),
    n: () => view.setAdding(!view.adding),
    v: () => !view.controls.space.hidden && view.toggleSpace(),
    Escape: () => (view.adding || view.moving ? view.setAdding(false) : view.select(null)),
  };
  const onKey = (event) => {
    if (event.target.closest?.("input, select, textarea, dialog, [contenteditable]") || event.altKey) return;
    const doIt = event.ctrlKey || event.metaKey ? withControl(event) : plain[event.key] ?? number(event.key);
    if (!doIt || (event.key === " " && (event.repeat || event.target.closest?.("button, a")))) return;
    event.preventDefault();
    doIt();
  };
  const withControl = ({ key }) => (key === "z" && view.may ? () => view.notices.takeBack() : null);
  const number = (key) => (/^[1-9]$/.test(key) ? () => view.selectRobot(Number(key) - 1) : null);
  document.addEventListener("keydown", onKey);
  return () => document.removeEventListener("keydown", onKey);
}
