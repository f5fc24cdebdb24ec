// Who does what when: thin bars for travel, hatched ones for waiting, high ones with the task's name for work.
// A service at a station is a bar of its own colour, and what a battery holds a line beneath the bars. Windows are shaded, deadlines and due times strokes, lateness is red, and the bars of a team are linked.

const [LEFT, FOOT, ROW] = [84, 22, 26];
const LEVEL = 14; // the height of the line of a battery, beneath a row
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
          <g v-for="{ key, ground, line, reserve, title } in levels" :key="key" class="battery">
            <path class="level-ground" :d="ground" /><path class="level" :d="line"><title>{{ title }}</title></path>
            <line v-if="reserve" class="reserve" v-bind="reserve" />
          </g>
          <g v-for="(row, k) in rows" :key="row.robot">
            <text x="${LEFT - 8}" :y="middle(k) + 4" text-anchor="end" class="name">{{ short(row.robot) }}</text>
            <template v-for="bar in bars(row)" :key="bar.key">
              <rect :class="bar.kind" :x="x(bar.from)" :width="Math.max(x(bar.until) - x(bar.from), 1)"
                    :y="middle(k) - bar.high / 2" :height="bar.high" :style="paint(bar, k)"
                    :tabindex="isNamed(bar) ? 0 : -1" :role="isNamed(bar) ? 'button' : 'presentation'"
                    :aria-label="bar.title" @click="choose(bar)" @keydown.enter="choose(bar)">
                <title>{{ bar.title }}</title>
              </rect>
              <text v-if="isNamed(bar) && x(bar.until) - x(bar.from) > bar.sign.length * ${NAME_WIDTH} + 4"
                    class="inside" :class="bar.kind === 'work' ? 'on-c' + (k % ${COLORS}) : 'of-station'"
                    :x="(x(bar.from) + x(bar.until)) / 2"
                    :y="middle(k) + 4" text-anchor="middle">{{ bar.sign }}</text>
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
    row() { return ROW + (this.rows.some(({ level }) => level) ? LEVEL : 0); },
    height() { return this.rows.length * this.row + FOOT; },
    end() {
      const ends = this.rows.flatMap((row) => [row.back_s ?? 0, ...row.stops.map((stop) => stop.ends_s)]);
      return Math.max(...ends, 0) || 1;
    },
    ticks() {
      const rough = this.end / Math.max((this.width - LEFT - 14) / 90, 1);
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
      const service = this.rows.some(({ stops }) => stops.some((stop) => stop.is_station)) ? [["service", "[station]"]] : [];
      const level = this.rows.some((row) => row.level) ? [["level", "battery, empty to full"]] : [];
      return [["travel", "travel"], ["waiting", "waiting"], ["work", "work"], ...service, ...level, ...found];
    },
    levels() { // of each battery over time: a line from empty to full, the ground beneath it, and the reserve
      return this.rows.flatMap(({ robot, level }, k) => {
        if (!level?.points.length) return [];
        const foot = (k + 1) * this.row - 2;
        const y = (share) => foot - share * (LEVEL - 3);
        const corners = level.points.map(([at, share]) => `${this.x(at).toFixed(1)} ${y(share).toFixed(1)}`);
        const [first, last] = [level.points[0], level.points.at(-1)].map(([at]) => this.x(at).toFixed(1));
        const line = `M${corners.join("L")}`;
        const at = y(level.reserve).toFixed(1);
        const least = Math.min(...level.points.map(([, share]) => share));
        const title = `battery of ${robot}: at least ${(100 * least).toFixed(0)} %`;
        const reserve = level.reserve ? { x1: first, x2: last, y1: at, y2: at } : null;
        return [{ key: robot, line, ground: `${line}L${last} ${foot}L${first} ${foot}Z`, reserve, title }];
      });
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
    middle(k) { return k * this.row + ROW / 2; },
    isNamed({ kind }) { return kind === "work" || kind === "service"; },
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
    choose(bar) { if (bar.task) this.$emit("choose", { what: bar.kind === "service" || bar.atStation ? "station" : "task", id: bar.task }); },
    paint(bar, k) {
      const color = `var(--c${k % COLORS})`;
      if (bar.kind === "service") return {};
      return bar.kind === "waiting" ? { fill: `url(#hatch-${k % COLORS})`, stroke: color } : { fill: color };
    },
    bars(row) {
      const bars = [];
      const add = (kind, { name: task, is_station: atStation }, from, until, high, words) => {
        if (until - from < 1e-9 && kind !== "work" && kind !== "service") return;
        const sign = atStation ? `[${task}]` : task;
        const title = `${row.robot} ${words} ${sign}: ${this.times(from, until)}`;
        bars.push({ key: `${kind}-${task}-${bars.length}`, kind, task, sign, atStation, from, until, high, title });
      };
      let free = row.leaves_s ?? 0;
      for (const stop of row.stops) {
        const { arrives_s, starts_s, ends_s, charged } = stop;
        add("travel", stop, free, arrives_s, 4, "travels to");
        add("waiting", stop, arrives_s, starts_s, 13, "waits at");
        const words = charged === null ? "is served at" : `adds ${charged.toFixed(2)} to its battery at`;
        if (stop.is_station) add("service", stop, starts_s, ends_s, 19, words);
        else add("work", stop, starts_s, ends_s, 19, "works on");
        free = ends_s;
      }
      if (row.back_s) add("travel", { name: "", is_station: false }, free, row.back_s, 4, "goes to its end");
      return bars;
    },
  },
};
