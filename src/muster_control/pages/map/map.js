// The map as an element of the page: canvases, hover text, buttons and the text alternative around the stage.

import { toRaw } from "vue";
import { listenToKeys } from "muster-map/keys.js";
import { readTheme } from "muster-map/looks.js";
import { listenToPointer } from "muster-map/pointer.js";
import { Stage } from "muster-map/stage.js";
import { fillTable, told, withShapes } from "muster-map/words.js";

const NOTES = {
  task: "Click where the new task is (Enter: in the middle of the map); Escape ends adding.",
  robot: "Click where the new robot begins (Enter: in the middle of the map); Escape ends adding.",
  station: "Click where the new station is (Enter: in the middle of the map); Escape ends adding.",
  zone: "Click the corners of the zone (space: in the middle of the map). Enter, a double-click or the first corner closes it; Backspace takes the last corner back, Escape leaves it.",
};
const EDITS = ["move", "add", "remove", "zone"];
const groups = new Map(); // maps that are looked at together, by the name of their group

export default {
  template: `
    <div class="muster-map" :class="{ editable }">
      <div ref="host" class="muster-map-host" :class="{ adding: editable && mode !== 'select' }" tabindex="0" role="application" aria-roledescription="map"
           :aria-label="label" aria-keyshortcuts="ArrowLeft ArrowRight ArrowUp ArrowDown + - 0 n p Enter">
        <canvas ref="ground" aria-hidden="true"></canvas>
        <canvas ref="top" aria-hidden="true"></canvas>
        <div ref="hint" class="muster-map-hint" hidden></div>
      </div>
      <p class="muster-map-note" role="status" v-show="note">{{ note }}</p>
      <div class="muster-map-buttons" role="group" aria-label="View of the map">
        <button type="button" @click="zoom(1.4)" title="Nearer (+)" aria-label="Nearer">+</button>
        <button type="button" @click="zoom(1 / 1.4)" title="Farther (-)" aria-label="Farther">−</button>
        <button type="button" @click="stage.fit()" title="All of it (0)" aria-label="All of it">⤢</button>
        <button type="button" @click="togglePrerequisites" :aria-pressed="String(prerequisites)"
                title="What comes before what (r)" aria-label="Prerequisites">⇢</button>
      </div>
      <p ref="said" class="sr-only" aria-live="polite"></p>
      <table ref="table" class="sr-only" aria-label="Robots, tasks and stations of the map"></table>
    </div>`,
  props: { scene: Object, plan: Object, editable: Boolean, mode: { type: String, default: "select" }, group: String, label: String,
           waiting: String },
  data() { return { prerequisites: false }; },
  computed: {
    note() { return this.scene ? (this.editable && NOTES[this.mode]) || "" : this.waiting ?? ""; },
  },
  watch: {
    mode() { this.stage.sketch.clear(); },
    scene() { this.applyScene(); },
    plan() { this.applyPlan(); },
    editable() { this.stage.editable = this.editable; this.stage.draw(); },
  },
  created() { this.stage = null; this.moves = 0; },
  mounted() {
    const { host, ground, top } = this.$refs;
    this.stage = new Stage(host, ground, top);
    this.stage.editable = this.editable;
    this.stage.onView = (state) => this.share(state);
    const emit = (name, data) => this.heard(name, data);
    listenToPointer(host, this.stage, emit, () => this.mode);
    listenToKeys(host, this.stage, emit, () => this.mode);
    this.sizes = new ResizeObserver(() => this.stage.resize());
    this.sizes.observe(host);
    this.scheme = window.matchMedia("(prefers-color-scheme: dark)");
    this.retheme = () => { this.stage.theme = readTheme(host); this.stage.draw(); };
    this.scheme.addEventListener("change", this.retheme);
    if (this.group) groups.set(this.group, (groups.get(this.group) ?? new Set()).add(this.stage));
    this.applyScene();
    this.applyPlan();
    this.stage.resize();
  },
  unmounted() {
    this.sizes.disconnect();
    this.scheme.removeEventListener("change", this.retheme);
    groups.get(this.group)?.delete(this.stage);
  },
  methods: {
    applyScene() {
      if (!this.scene || (this.scene.moves ?? 0) < this.moves) return; // of before a move: it would jump back
      this.stage.show(withShapes(deepRaw(this.scene)));
      this.applyPlan();
    },
    applyPlan() {
      this.stage.showPlan(this.plan ? deepRaw(this.plan) : null);
      fillTable(this.$refs.table, this.stage);
    },
    heard(name, data) {
      if (EDITS.includes(name)) window.musterUnsaved = true; // until the server, which has not heard of it, says
      if (name === "hover") this.hint(data);
      else if (name === "choose") this.choose(data, true);
      else if (name === "prerequisites") this.prerequisites = data;
      else this.$emit(name, name === "move" ? { ...data, moves: ++this.moves } : data);
    },
    // From Python and from scripts: `one` is {what: "robot" | "task" | "station", id}, or null.
    choose(one, byHand = false) {
      this.stage.chosen = one;
      this.$refs.said.textContent = one ? told(this.stage, one) : "";
      this.stage.draw();
      if (byHand) this.$emit("choose", one);
    },
    reveal(one) {
      const found = this.stage.find(one);
      if (found) this.stage.view.reveal(found.x, found.y);
      this.choose(one);
    },
    hint(one) {
      const { hint } = this.$refs;
      hint.hidden = !one;
      if (!one) return;
      hint.textContent = told(this.stage, one);
      const right = one.px > this.stage.view.width / 2;
      Object.assign(hint.style, right
        ? { left: "", right: `${this.stage.view.width - one.px + 12}px`, top: `${one.py + 12}px` }
        : { right: "", left: `${one.px + 12}px`, top: `${one.py + 12}px` });
    },
    zoom(factor) { this.stage.view.zoom(factor); this.stage.moved(); },
    togglePrerequisites() {
      this.prerequisites = this.stage.showPrerequisites = !this.stage.showPrerequisites;
      this.stage.draw();
    },
    share(state) {
      for (const other of groups.get(this.group) ?? []) {
        if (other === this.stage) continue;
        Object.assign(other.view, state);
        other.draw();
      }
    },
    // What the stream of a run says, called by the script that listens to it: frames do not pass through Python.
    states(message) { this.stage.live.states(message); this.stage.draw(true); },
    status(message) { this.stage.live.status(message); this.stage.draw(); },
    // New lines of a run's plan: [{robot, points, tasks?}].
    routes(routes) { this.stage.showPlan({ routes }); },
    clear() { this.stage.live.clear(); this.stage.draw(); },
  },
};

// Plain data out of what Vue watches.
function deepRaw(data) {
  return JSON.parse(JSON.stringify(toRaw(data)));
}
