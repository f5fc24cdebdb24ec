// The view of a run as an element of the page; what moves in it is drawn by the scripts in `js`.

import { LiveView } from "muster-live";

export default {
  template: `<div class="muster-live" :class="{ wall }"></div>`,
  props: { path: String, ground: Object, may: Boolean, wall: Boolean },
  watch: {
    ground() { this.view.ground.lay(this.ground); },
  },
  created() { this.view = null; },
  mounted() {
    const { path, ground, may, wall } = this;
    this.view = new LiveView(this.$el, { path, ground, may, wall, act: (command) => this.$emit("act", command) });
  },
  unmounted() { this.view.close(); },
  methods: {
    // What the desk said to a command: {token, and action, outcome or error}.
    answer(told) { this.view.answer(told); },
  },
};
