// Who does what when: thin bars for travel, hatched ones for waiting, high ones with the task's name for work.
// Windows are shaded, deadlines and due times strokes, lateness is red, and the bars of a team are linked.

const [LEFT, FOOT, ROW] = [84, 22, 26];
const NAME_WIDTH = 7; // pixels a letter
const COLORS = 8;
const WINDOW = ROW - 1; // the height of windows and of the strokes of deadlines
const LATE = 3; // the height of the bar of lateness
const STEPS = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 14400, 43200, 86400]; // seconds, by a clock
const LEGEND = [["window", "time window"], ["deadline", "deadline"], ["due", "due time"], ["late", "late"], ["team", "team"]];

const two = (number) => String(number).padStart(2, "0");

// The clock time so many seconds from a midnight; of later days "+1 10:00:30".
function clockText(seconds) {
  const whole = Math.round(seconds);
  const days = Math.floor(whole / 86400);
  const of = whole - 86400 * days;
  const text = [of / 3600, (of / 60) % 60, of % 60].map((part) => two(Math.floor(part))).join(":");
  return (days ? `+${days} ` : "") + text;
}

export default {
  template: `
    <figure class="gantt">
      <figcaption>What robots do <span class="legend"><span v-for="[kind, words] in legend" :key="kind">
        <i :class="kind"></i>{{ words }}</span></span></figcaption>
      <div ref="host" class="gantt-host">
        <svg v-if="width" :width="width" :height="height" role="group" :aria-label="label">
          <defs>
            <pattern v-for="k in ${COLORS}" :key="k" :id="'hatch-' + (k - 1)" width="5" height="5" patternUnits="userSpaceOnUse">
              <path d="M-1 1 1 -1M0 5 5 0M4 6 6 4" :stroke="'var(--c' + (k - 1) + ')'" stroke-width="1" />
            </pattern>
          </defs>
          <g v-for="tick in ticks" :key="tick">
            <line class="tick" :x1="x(tick)" :x2="x(tick)" y1="0" :y2="height - ${FOOT}" />
            <text :x="x(tick)" :y="height - 6" :text-anchor="anchor(tick)">{{ tickText(tick) }}</text>
          </g>
          <rect v-for="mark in of('window')" :key="mark.key" class="window" :data-task="mark.task" :x="x(mark.from_s)"
                :width="Math.max(x(mark.until) - x(mark.from_s), 1)" :y="middle(mark.row) - ${WINDOW / 2}" height="${WINDOW}">
            <title>{{ mark.words }}</title>
          </rect>
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
          <rect v-for="mark in of('late')" :key="mark.key" class="late" :data-task="mark.task" :x="x(mark.from_s)"
                :width="Math.max(x(mark.until) - x(mark.from_s), 1)" :y="middle(mark.row) + 10" height="${LATE}">
            <title>{{ mark.words }}</title>
          </rect>
          <line v-for="mark in [...of('deadline'), ...of('due')]" :key="mark.key" :class="mark.kind" :data-task="mark.task"
                :x1="x(mark.from_s)" :x2="x(mark.from_s)" :y1="middle(mark.row) - ${WINDOW / 2}"
                :y2="middle(mark.row) + ${WINDOW / 2}"><title>{{ mark.words }}</title></line>
          <g v-for="mark in of('team')" :key="mark.key" class="team" :data-task="mark.task">
            <line :x1="x(mark.from_s)" :x2="x(mark.until)" :y1="middle(mark.row)" :y2="middle(mark.to_row)" />
            <circle :cx="x(mark.from_s)" :cy="middle(mark.row)" r="3" />
            <circle :cx="x(mark.until)" :cy="middle(mark.to_row)" r="3" />
            <title>{{ mark.words }}</title>
          </g>
        </svg>
      </div>
    </figure>`,
  props: { rows: Array, marks: Array, clock: Number },
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
      const decimal = power * [1, 2, 5, 10].find((part) => part * power >= rough * 0.999);
      const step = this.hasClock ? STEPS.find((part) => part >= rough) ?? 86400 * Math.ceil(rough / 86400) : decimal;
      return Array.from({ length: Math.floor(this.end / step) + 1 }, (_, k) => Number((k * step).toPrecision(6)));
    },
    hasClock() { return this.clock !== null && this.clock !== undefined; },
    shown() { // what begins after the end of the chart is left out; a window is shaded as far as the chart reaches
      return this.marks.filter(({ from_s }) => from_s <= this.end).map((mark, k) => (
        { ...mark, key: `${mark.kind}-${k}`, until: Math.min(mark.until_s ?? this.end, this.end) }));
    },
    legend() {
      const found = LEGEND.filter(([kind]) => this.of(kind).length);
      return [["travel", "travel"], ["waiting", "waiting"], ["work", "work"], ...found];
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
    of(kind) { return this.shown.filter((mark) => mark.kind === kind); },
    anchor(tick) {
      if (!tick) return "start";
      return this.x(tick) + 26 > this.width ? "end" : "middle"; // so that no text is cut off
    },
    tickText(tick) {
      if (this.hasClock) return clockText(this.clock + tick);
      return tick ? `${tick}` : `${tick} s`;
    },
    times(from, until) {
      if (this.hasClock) return `${clockText(this.clock + from)} to ${clockText(this.clock + until)}`;
      return `${from.toFixed(1)} to ${until.toFixed(1)} s`;
    },
    choose(bar) { if (bar.task) this.$emit("choose", bar.task); },
    paint(bar, k) {
      const color = `var(--c${k % COLORS})`;
      return bar.kind === "waiting" ? { fill: `url(#hatch-${k % COLORS})`, stroke: color } : { fill: color };
    },
    bars(row) {
      const bars = [];
      const add = (kind, task, from, until, high, words) => {
        if (until - from < 1e-9 && kind !== "work") return;
        const title = `${row.robot} ${words} ${task}: ${this.times(from, until)}`;
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
