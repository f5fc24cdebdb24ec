// Who does what when: thin bars for travel, hatched ones for waiting, high ones with the task's name for work.

const [LEFT, FOOT, ROW] = [84, 22, 26];
const NAME_WIDTH = 7; // pixels a letter
const COLORS = 8;

export default {
  template: `
    <figure class="gantt">
      <figcaption>What robots do <span class="legend"><i class="travel"></i>travel <i class="waiting"></i>waiting
        <i class="work"></i>work</span></figcaption>
      <div ref="host" class="gantt-host">
        <svg v-if="width" :width="width" :height="height" role="group" :aria-label="label">
          <defs>
            <pattern v-for="k in ${COLORS}" :key="k" :id="'hatch-' + (k - 1)" width="5" height="5" patternUnits="userSpaceOnUse">
              <path d="M-1 1 1 -1M0 5 5 0M4 6 6 4" :stroke="'var(--c' + (k - 1) + ')'" stroke-width="1" />
            </pattern>
          </defs>
          <g v-for="tick in ticks" :key="tick">
            <line class="tick" :x1="x(tick)" :x2="x(tick)" y1="0" :y2="height - ${FOOT}" />
            <text :x="x(tick)" :y="height - 6" :text-anchor="tick ? 'middle' : 'start'">{{ tick }}{{ tick ? "" : " s" }}</text>
          </g>
          <g v-for="(row, k) in rows" :key="row.robot">
            <text x="${LEFT - 8}" :y="middle(k) + 4" text-anchor="end" class="name">{{ short(row.robot) }}</text>
            <template v-for="bar in bars(row)" :key="bar.key">
              <rect :class="bar.kind" :x="x(bar.from)" :width="Math.max(x(bar.until) - x(bar.from), 1)"
                    :y="middle(k) - bar.high / 2" :height="bar.high" :style="paint(bar, k)"
                    :tabindex="bar.kind === 'work' ? 0 : -1" :role="bar.kind === 'work' ? 'button' : 'presentation'"
                    :aria-label="bar.title" @click="choose(bar)" @keydown.enter="choose(bar)">
                <title>{{ bar.title }}</title>
              </rect>
              <text v-if="bar.kind === 'work' && x(bar.until) - x(bar.from) > bar.task.length * ${NAME_WIDTH} + 4"
                    class="inside" :class="'on-c' + (k % ${COLORS})" :x="(x(bar.from) + x(bar.until)) / 2"
                    :y="middle(k) + 4" text-anchor="middle">{{ bar.task }}</text>
            </template>
          </g>
        </svg>
      </div>
    </figure>`,
  props: { rows: Array },
  data() { return { width: 0 }; },
  computed: {
    height() { return this.rows.length * ROW + FOOT; },
    end() {
      const ends = this.rows.flatMap((row) => [row.back_s ?? 0, ...row.visits.map((visit) => visit.ends_s)]);
      return Math.max(...ends, 0) || 1;
    },
    ticks() {
      const rough = this.end / Math.max(this.width / 90, 1);
      const power = 10 ** Math.floor(Math.log10(rough));
      const step = power * [1, 2, 5, 10].find((part) => part * power >= rough * 0.999);
      return Array.from({ length: Math.floor(this.end / step) + 1 }, (_, k) => Number((k * step).toPrecision(6)));
    },
    label() { return `Time chart of ${this.rows.length} robots up to ${this.end.toFixed(0)} s`; },
  },
  mounted() {
    this.sizes = new ResizeObserver(([entry]) => { this.width = Math.floor(entry.contentRect.width); });
    this.sizes.observe(this.$refs.host);
  },
  unmounted() { this.sizes.disconnect(); },
  methods: {
    x(at) { return LEFT + ((this.width - LEFT - 14) * at) / this.end; },
    middle(k) { return (k + 0.5) * ROW; },
    short(name) { return name.length > 11 ? `${name.slice(0, 10)}…` : name; },
    choose(bar) { if (bar.task) this.$emit("choose", bar.task); },
    paint(bar, k) {
      const color = `var(--c${k % COLORS})`;
      return bar.kind === "waiting" ? { fill: `url(#hatch-${k % COLORS})`, stroke: color } : { fill: color };
    },
    bars(row) {
      const bars = [];
      const add = (kind, task, from, until, high, words) => {
        if (until - from < 1e-9 && kind !== "work") return;
        const title = `${row.robot} ${words} ${task}: ${from.toFixed(1)} to ${until.toFixed(1)} s`;
        bars.push({ key: `${kind}-${task}`, kind, task, from, until, high, title });
      };
      let free = row.leaves_s ?? 0;
      for (const { task, arrives_s, starts_s, ends_s } of row.visits) {
        add("travel", task, free, arrives_s, 4, "travels to");
        add("waiting", task, arrives_s, starts_s, 13, "waits at");
        add("work", task, starts_s, ends_s, 19, "works on");
        free = ends_s;
      }
      if (row.back_s) add("travel", "", free, row.back_s, 4, "goes to its end");
      return bars;
    },
  },
};
