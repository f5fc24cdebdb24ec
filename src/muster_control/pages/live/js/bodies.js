// What stands in space: meshes of robots, tasks and zones, lines of trails and ways, made once and moved from then on.

import { setText } from "./elements.js";
import { TASK_MARKS, moveWords } from "./words.js";

const MOST_NAMES = 120;

export class Bodies {
  constructor(scene, { THREE, CSS2DObject, host }) {
    Object.assign(this, { scene, THREE, CSS2DObject });
    const style = getComputedStyle(host);
    this.ink = (name) => new THREE.Color(style.getPropertyValue(`--${name}`).trim() || "#888");
    this.robots = new Map();
    this.tasks = new Map();
  }

  layGround(box, chart) {
    const { THREE } = this;
    const size = box.getSize(new THREE.Vector3());
    const middle = box.getCenter(new THREE.Vector3());
    this.unit = Math.max(size.x, size.y, size.z, 1) / 42; // how large marks are
    const step = 10 ** Math.ceil(Math.log10(Math.max(size.x, size.y, 1) / 20));
    const cells = Math.ceil((Math.max(size.x, size.y) * 1.5) / step / 2) * 2;
    const grid = new THREE.GridHelper(cells * step, cells, this.ink("frame"), this.ink("grid"));
    grid.rotation.x = Math.PI / 2;
    grid.position.set(Math.round(middle.x / step) * step, Math.round(middle.y / step) * step, 0);
    this.scene.add(grid);
    for (const zone of chart?.zones ?? []) this.scene.add(...this.prism(zone, Math.max(box.max.z, this.unit * 6)));
    if (chart?.boundary) this.scene.add(this.fence(chart.boundary));
  }

  prism({ polygon, floor_m: floor, ceiling_m: ceiling }, sky) {
    const { THREE } = this;
    const shape = new THREE.Shape(polygon.map(([x, y]) => new THREE.Vector2(x, y)));
    const low = floor ?? 0;
    const geometry = new THREE.ExtrudeGeometry(shape, { depth: (ceiling ?? Math.max(sky, low + 1)) - low, bevelEnabled: false });
    const look = { color: this.ink("alarm"), transparent: true, opacity: 0.16, side: THREE.DoubleSide, depthWrite: false };
    const body = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(look));
    const edges = new THREE.LineSegments(new THREE.EdgesGeometry(geometry), new THREE.LineBasicMaterial({ color: this.ink("alarm") }));
    for (const part of [body, edges]) part.position.z = low;
    return [body, edges];
  }

  fence(corners) {
    return new this.THREE.LineLoop(this.lineOf(corners.map(([x, y]) => [x, y, 0])), new this.THREE.LineBasicMaterial({ color: this.ink("quiet") }));
  }

  lineOf(points) {
    return new this.THREE.BufferGeometry().setFromPoints(points.map((point) => new this.THREE.Vector3(...point)));
  }

  name(words, kind) {
    const element = document.createElement("span");
    element.className = `in-space ${kind}`;
    element.textContent = words;
    const name = new this.CSS2DObject(element);
    name.center.set(...(kind === "robot" ? [0.5, 1.7] : [-0.18, 0.5]));
    return name;
  }

  addRobot(robot, named) {
    const { THREE, unit } = this;
    const color = this.ink(`c${robot.index % 8}`);
    const flies = robot.kind === "air";
    const radius = Math.max(robot.radius_m ?? 0, unit * 0.7);
    const geometry = flies ? new THREE.OctahedronGeometry(radius) : new THREE.CylinderGeometry(radius, radius, radius, 20).rotateX(Math.PI / 2);
    const body = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color, transparent: true }));
    const nose = new THREE.Mesh(new THREE.ConeGeometry(radius * 0.35, radius * 0.9, 10).rotateZ(-Math.PI / 2), new THREE.MeshLambertMaterial({ color: this.ink("ink") }));
    nose.position.x = radius * 1.2;
    const whole = new THREE.Group();
    whole.add(body, nose);
    if (named) whole.add(this.name(robot.id, "robot"));
    const thin = (look) => new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color, transparent: true, ...look }));
    const parts = {
      whole,
      body,
      down: thin({ opacity: 0.6 }),
      shadow: new THREE.Mesh(new THREE.RingGeometry(radius * 0.5, radius * 0.7, 24), new THREE.MeshBasicMaterial({ color, side: THREE.DoubleSide })),
      trail: thin({ opacity: 0.9 }),
      ahead: new THREE.Line(new THREE.BufferGeometry(), new THREE.LineDashedMaterial({ color, dashSize: unit, gapSize: unit * 0.7, transparent: true, opacity: 0.55 })),
    };
    for (const part of [whole, parts.down, parts.shadow, parts.trail, parts.ahead]) {
      part.frustumCulled = false;
      this.scene.add(part);
    }
    this.robots.set(robot.id, parts);
    return parts;
  }

  addTask(task, named) {
    const { THREE, unit } = this;
    const ball = new THREE.Mesh(new THREE.SphereGeometry(unit * 0.42, 16, 12), new THREE.MeshLambertMaterial({ transparent: true }));
    const parts = { ball, name: named ? this.name("", "task") : null, state: "" };
    if (parts.name) ball.add(parts.name);
    parts.down = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: this.ink("frame"), transparent: true, opacity: 0.6 }));
    this.scene.add(ball, parts.down);
    this.tasks.set(task.id, parts);
    return parts;
  }

  // Of a task that is long over, and forgotten.
  removeTask(id) {
    const { ball, down, name } = this.tasks.get(id);
    if (name) ball.remove(name);
    this.scene.remove(ball, down);
    this.tasks.delete(id);
  }

  show(team, selected) {
    const named = team.tasks.size + team.robots.size <= MOST_NAMES;
    for (const id of this.tasks.keys()) if (!team.tasks.has(id)) this.removeTask(id);
    for (const task of team.tasks.values()) this.showTask(task, this.tasks.get(task.id) ?? this.addTask(task, named), team, selected);
    for (const robot of team.robots.values()) this.showRobot(robot, this.robots.get(robot.id) ?? this.addRobot(robot, named), team);
  }

  showTask(task, parts, team, selected) {
    if (parts.place !== task.place) {
      const [x, y, z] = (parts.place = task.place);
      parts.ball.position.set(x, y, z);
      this.redraw(parts.down, [[x, y, z], [x, y, 0]]);
    }
    const chosen = selected?.task === task.id || team.moved.has(task.id);
    parts.ball.scale.setScalar(chosen ? 1.8 : 1);
    const move = team.moved.get(task.id);
    if (parts.name) setText(parts.name.element, `${TASK_MARKS[task.state]} ${task.id}${move ? `: ${moveWords(move)}` : ""}`);
    if (parts.state === task.state) return;
    parts.state = task.state;
    const color = { open: "quiet", "under way": "accent", done: "c2", lost: "alarm", cancelled: "frame" }[task.state];
    parts.ball.material.color = this.ink(color);
    parts.ball.material.opacity = task.state === "cancelled" ? 0.4 : 1;
  }

  showRobot(robot, parts, team) {
    const place = team.placeOf(robot);
    for (const part of [parts.whole, parts.down, parts.shadow]) part.visible = place !== null;
    if (!place) return;
    const { x, y, z, heading } = place;
    parts.whole.position.set(x, y, z);
    parts.whole.rotation.z = heading;
    parts.body.material.opacity = robot.out ? 0.35 : 1;
    parts.shadow.position.set(x, y, this.unit * 0.02);
    this.redraw(parts.down, [[x, y, z], [x, y, 0]]);
    this.redraw(parts.trail, team.trailOf(robot));
    this.redraw(parts.ahead, team.ahead(robot, place));
    parts.ahead.computeLineDistances();
  }

  redraw(line, points) {
    line.geometry.dispose();
    line.geometry = this.lineOf(points);
  }

  clear() {
    this.scene.traverse((part) => {
      part.geometry?.dispose();
      part.material?.dispose();
    });
  }
}
