// What is heard of a mission that is carried out: where robots are, straight between two messages; trails; states of tasks.

const LONGEST_TRAIL = 1500; // corners
const TRAIL_STEP = 0.05; // metres
const LONGEST_GLIDE = 250; // milliseconds from one heard position to the next

export class Live {
  constructor() { this.clear(); }

  clear() {
    this.robots = new Map(); // id: {from, to, at, glide, trail, activity, out}
    this.tasks = new Map(); // id: state
    this.heardAt = null;
  }

  // A `states` message of the stream: {robots: {id: [x, y, z, heading, speed]}}.
  states(message, now = performance.now()) {
    const glide = Math.min(this.heardAt === null ? 0 : now - this.heardAt, LONGEST_GLIDE);
    this.heardAt = now;
    for (const [id, [x, y, z, heading, speed]] of Object.entries(message.robots)) {
      const robot = this.robot(id);
      const here = this.position(id, now);
      Object.assign(robot, { from: here ?? { x, y, z, heading, speed }, to: { x, y, z, heading, speed }, at: now, glide });
      extend(robot.trail, x, y, z);
    }
  }

  // A `status` message: {robots: {id: {activity, out, ...}}, tasks: {id: state}}.
  status(message) {
    for (const [id, { activity, out }] of Object.entries(message.robots ?? {})) {
      Object.assign(this.robot(id), { activity, out: Boolean(out) });
    }
    for (const [id, state] of Object.entries(message.tasks ?? {})) this.tasks.set(id, state);
  }

  robot(id) {
    if (!this.robots.has(id)) this.robots.set(id, { trail: [], activity: "", out: false });
    return this.robots.get(id);
  }

  position(id, now) {
    const robot = this.robots.get(id);
    if (!robot?.to) return null;
    const share = robot.glide > 0 ? Math.min(Math.max((now - robot.at) / robot.glide, 0), 1) : 1;
    const { from, to } = robot;
    const between = (name) => from[name] + (to[name] - from[name]) * share;
    const turn = Math.atan2(Math.sin(to.heading - from.heading), Math.cos(to.heading - from.heading));
    return { x: between("x"), y: between("y"), z: between("z"), heading: from.heading + turn * share, speed: to.speed };
  }

  isMoving(now) {
    return this.heardAt !== null && now - this.heardAt <= LONGEST_GLIDE;
  }
}

function extend(trail, x, y, z) {
  const last = trail.at(-1);
  if (last && Math.hypot(x - last[0], y - last[1], z - last[2]) < TRAIL_STEP) return;
  trail.push([x, y, z]);
  if (trail.length > LONGEST_TRAIL) trail.splice(0, trail.length - LONGEST_TRAIL);
}
