// What robots, tasks and runs do, in words for people. Every state has a mark beside its colour.


export const TASK_MARKS = { open: "○", "under way": "◉", done: "✓", lost: "✕", cancelled: "⊘" };
export const RUN_MARKS = { starting: "…", resuming: "↻", running: "▶", paused: "❚❚", ended: "✓", cancelled: "⊘", failed: "✕" };

// Why a robot takes no part. `takenOut`: robot -> who took it out; nobody did where it failed of itself.
export function outOf(robot, takenOut) {
  if (robot.out === "robot_fails" && takenOut.has(robot.id)) return `taken out by ${takenOut.get(robot.id)}`;
  return robot.outWords || "out";
}

export function doing(robot, takenOut) {
  if (robot.out) return outOf(robot, takenOut);
  const why = robot.waits_for.length ? `for ${robot.waits_for.join(", ")}` : (robot.waits ?? "").replace("waits ", "");
  const waits = why ? ` ${why}` : "";
  switch (robot.activity) {
    case "driving": return robot.task ? `on the way to ${robot.task}` : "on the way";
    case "in traffic": return `waits in traffic for ${robot.held_up_by}${robot.task ? `, on the way to ${robot.task}` : ""}`;
    case "waiting": return `waits${robot.task ? ` at ${robot.task}` : ""}${waits}`;
    case "working": return `works on ${robot.task}`;
    case "returning": return "goes to where its route ends";
    default: if (robot.station) return `${robot.activity}${waits ? `, waits${waits}` : ""}`; // "charging at dock"
      return robot.available ? "free" : "not yet available";
  }
}

// How much of a robot's battery is left, or of its capacity used: {share 0 to 1, words, kind}; null: neither is known.
export function spent(robot, unit) {
  if (robot.charge !== null && robot.charge !== undefined) {
    return { share: robot.charge, words: `${Math.round(100 * robot.charge)} % left`, kind: "battery" };
  }
  if (robot.used === undefined) return null;
  const used = robot.used.toFixed(1);
  if (robot.usage_left === null || robot.usage_left === undefined) {
    return { share: null, words: `${used} ${unit}`, kind: "used" };
  }
  const capacity = robot.used + robot.usage_left;
  return { share: capacity > 0 ? robot.used / capacity : 0, words: `${used} of ${capacity.toFixed(0)} ${unit}`, kind: "used" };
}

export function speedWords(speed) {
  return speed === null ? "as fast as it goes" : `${speed} ×`;
}

// From whom to whom a task has gone.
export function moveWords({ from, to }) {
  return from ? `${from} → ${to}` : `→ ${to}`;
}
