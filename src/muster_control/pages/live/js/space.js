// The run seen in space: ground, zones as prisms, drones with lines down to the ground, tasks, trails and ways ahead.
// x east, y north, z up, metres. Three.js comes with the page's library and is fetched when it is first needed.

import { Bodies } from "./bodies.js";

const TURN = Math.PI / 36; // radians a key
const CLOSER = 0.88;

export async function openSpace(host, team) {
  const library = await import("nicegui-scene");
  return new Space(host, team, library);
}

class Space {
  constructor(host, team, { THREE, OrbitControls, CSS2DRenderer, CSS2DObject }) {
    this.host = host;
    this.THREE = THREE;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.names = new CSS2DRenderer();
    this.names.domElement.className = "names";
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "Robots and tasks in space; arrow keys turn, page up and down come closer, home shows all");
    host.append(canvas, this.names.domElement);
    this.scene = new THREE.Scene();
    const light = new THREE.HemisphereLight(0xffffff, 0xaaaaaa, 3);
    light.position.set(0, -0.4, 1);
    this.scene.add(light);
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.05, 5000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.bodies = new Bodies(this.scene, { THREE, CSS2DObject, host });
    canvas.addEventListener("keydown", (event) => this.onKey(event));
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(host);
    this.resize();
    this.lookAtAll(team);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    this.names.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  // From the south and above, everything in sight.
  lookAtAll(team) {
    const box = new this.THREE.Box3();
    for (const { place } of team.tasks.values()) box.expandByPoint(new this.THREE.Vector3(...place));
    for (const { home } of team.robots.values()) box.expandByPoint(new this.THREE.Vector3(...home));
    if (box.isEmpty()) box.set(new this.THREE.Vector3(-5, -5, 0), new this.THREE.Vector3(5, 5, 1));
    const sphere = box.getBoundingSphere(new this.THREE.Sphere());
    const away = 1.05 * sphere.radius / Math.sin((this.camera.fov * Math.PI) / 360) / Math.min(this.camera.aspect, 1);
    this.controls.target.copy(sphere.center);
    this.camera.position.set(sphere.center.x, sphere.center.y - 0.72 * away, sphere.center.z + 0.6 * away);
    this.controls.update();
    this.bodies.layGround(box, team.mission.map);
  }

  draw(team, selected) {
    this.bodies.show(team, selected);
    this.renderer.render(this.scene, this.camera);
    this.names.render(this.scene, this.camera);
  }

  onKey(event) {
    const turns = { ArrowLeft: [-TURN, 0], ArrowRight: [TURN, 0], ArrowUp: [0, -TURN], ArrowDown: [0, TURN] };
    const scales = { PageUp: CLOSER, PageDown: 1 / CLOSER };
    if (event.key in turns) this.turn(...turns[event.key], 1);
    else if (event.key in scales) this.turn(0, 0, scales[event.key]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  turn(around, down, scale) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const radius = offset.length() * scale;
    const azimuth = Math.atan2(offset.y, offset.x) + around;
    const polar = Math.min(Math.max(Math.acos(offset.z / offset.length()) + down, 0.02), Math.PI / 2 - 0.02);
    offset.set(Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth), Math.cos(polar));
    this.camera.position.copy(this.controls.target).addScaledVector(offset, radius);
    this.controls.update();
  }

  close() {
    this.observer.disconnect();
    this.controls.dispose();
    this.bodies.clear();
    this.renderer.dispose();
    this.renderer.domElement.remove();
    this.names.domElement.remove();
  }
}
