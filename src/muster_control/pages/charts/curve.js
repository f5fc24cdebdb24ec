// How planning goes: steps of the objective of the best plan so far, and the lower bound as a dashed line.

const [WIDTH, HEIGHT, LEFT, FOOT] = [420, 130, 54, 20];

export default {
  template: `
    <figure class="curve">
      <svg viewBox="0 0 ${WIDTH} ${HEIGHT}" role="img" :aria-label="label">
        <g v-for="tick in ticks" :key="tick.text">
          <line class="tick" x1="${LEFT}" x2="${WIDTH - 6}" :y1="tick.y" :y2="tick.y" />
          <text x="${LEFT - 6}" :y="tick.y + 4" text-anchor="end">{{ tick.text }}</text>
        </g>
        <path class="steps" :d="steps" />
        <g v-if="bound !== null && history.length">
          <line class="bound" x1="${LEFT}" x2="${WIDTH - 6}" :y1="y(bound)" :y2="y(bound)" />
          <text x="${LEFT + 4}" :y="y(bound) - 4">lower bound</text>
        </g>
        <text x="${LEFT}" y="${HEIGHT - 5}">0 s</text>
        <text x="${WIDTH - 6}" y="${HEIGHT - 5}" text-anchor="end">{{ end.toFixed(1) }} s</text>
      </svg>
    </figure>`,
  props: { history: Array, bound: Number, until: Number },
  computed: {
    end() { return Math.max(this.until ?? 0, this.history.at(-1)?.[0] ?? 0, 0.1); },
    range() {
      const values = this.history.map(([, value]) => value);
      if (this.bound !== null && this.bound !== undefined) values.push(this.bound);
      if (!values.length) return [0, 1];
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const room = (high - low || Math.abs(high) || 1) * 0.1;
      return [low - room, high + room];
    },
    ticks() {
      if (!this.history.length) return [];
      const [low, high] = this.range;
      return [0.1, 0.5, 0.9].map((share) => {
        const value = low + (high - low) * share;
        return { y: this.y(value), text: Number(value.toPrecision(4)) };
      });
    },
    steps() {
      if (!this.history.length) return "";
      let path = "";
      this.history.forEach(([at, value], k) => {
        path += k ? `H${this.x(at)}V${this.y(value)}` : `M${this.x(at)} ${this.y(value)}`;
      });
      return `${path}H${this.x(this.end)}`;
    },
    label() {
      if (!this.history.length) return "No plan yet";
      const bound = this.bound === null ? "" : `, lower bound ${this.bound.toPrecision(5)}`;
      return `Objective ${this.history.at(-1)[1].toPrecision(5)} after ${this.end.toFixed(1)} s${bound}`;
    },
  },
  methods: {
    x(at) { return (LEFT + ((WIDTH - LEFT - 6) * at) / this.end).toFixed(1); },
    y(value) { return Number((6 + ((HEIGHT - FOOT - 6) * (this.range[1] - value)) / (this.range[1] - this.range[0])).toFixed(1)); },
  },
};
