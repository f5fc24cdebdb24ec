// A table whose cells are fields; long ones are shown page by page.

const PAGE = 100; // rows
const DIGIT = 0.62; // rem
const AROUND = 1.4; // rem, beside the digits of a cell
const WIDEST = 14; // rem

export default {
  template: `
    <section class="edit-table">
      <h3>{{ title }} <span v-if="grows" class="quiet">{{ rows.length }}</span></h3>
      <div class="scrolling">
        <table class="plain">
          <thead><tr>
            <th v-for="column in columns" :key="column.key" scope="col" :title="column.hint"
              :class="[column.kind, { long: column.key.length > 3 }]" :style="{ width: widths[column.key] }"><template
              v-for="(part, k) in column.key.split('_')" :key="k"><template v-if="k">_<wbr></template>{{ part }}</template></th>
            <th v-if="grows && editable" class="drop"><span class="sr-only">Remove</span></th>
          </tr></thead>
          <tbody>
            <tr v-for="line in page" :key="line.key">
              <td v-for="column in columns" :key="column.key" :class="column.kind">
                <select v-if="column.kind === 'choice'" :value="shown(line, column)" :disabled="!editable"
                        :aria-label="label(line, column)" @change="change(line, column, $event)">
                  <option value=""></option>
                  <option v-for="choice in column.choices" :key="choice" :value="choice">{{ choice }}</option>
                </select>
                <input v-else size="1" :value="shown(line, column)" :readonly="!editable" :class="column.kind"
                       :inputmode="column.kind === 'number' ? 'decimal' : 'text'" :aria-label="label(line, column)"
                       @input="typing = { cell: cell(line, column), text: $event.target.value }" @blur="typing = null"
                       @change="change(line, column, $event)">
              </td>
              <td v-if="grows && editable" class="drop">
                <button type="button" class="bare" :aria-label="'Remove ' + line.row.id" title="Remove" @click="ask('drop', line.row.id)">×</button>
              </td>
            </tr>
          </tbody>
        </table>
      </div>
      <p class="edit-table-foot">
        <button v-if="grows && editable" type="button" class="plain" @click="ask('add')">Add a row</button>
        <template v-if="rows.length > ${PAGE}">
          <button type="button" class="plain" :disabled="first === 0" @click="first -= ${PAGE}">‹</button>
          <span>{{ first + 1 }} to {{ first + page.length }}</span>
          <button type="button" class="plain" :disabled="first + ${PAGE} >= rows.length" @click="first += ${PAGE}">›</button>
        </template>
      </p>
    </section>`,
  props: { title: String, columns: Array, rows: Array, editable: Boolean, grows: Boolean },
  // `typing`: the cell that somebody is typing into; `sent`: what was typed into others, until the server has answered.
  data() { return { first: 0, typing: null, sent: {} }; },
  created() { this.names = new Map(); }, // of rows that got another id: the one they had, so that they stay what they are
  computed: {
    // Rows with a key that stays theirs while others come and go. A wrong text may have ids twice, or none.
    page() {
      const met = new Map();
      return this.rows.slice(this.first, this.first + PAGE).map((row, k) => {
        const name = this.names.get(row.id) ?? row.id ?? String(this.first + k);
        met.set(name, (met.get(name) ?? 0) + 1);
        return { row, name, at: this.first + k, key: `${name} ${met.get(name)}` };
      });
    },
    // Of columns whose numbers are longer than a column usually has room for.
    widths() {
      const found = {};
      for (const { key } of this.columns.filter(({ kind }) => kind === "number")) {
        const longest = Math.max(0, ...this.page.map(({ row }) => row[key]?.length ?? 0));
        const width = Math.min(longest * DIGIT + AROUND, WIDEST);
        if (width > (key.length > 3 ? 5.8 : 5)) found[key] = `${width.toFixed(1)}rem`;
      }
      return found;
    },
  },
  watch: {
    rows: {
      handler() { if (!this.$el.contains(document.activeElement)) this.typing = null; }, // the row is gone
      flush: "post",
    },
  },
  methods: {
    label({ row }, column) { return `${column.key} ${row.id ? `of ${row.id}` : ""}`; },
    cell({ key }, column) { return `${key} ${column.key}`; },
    shown(line, column) {
      const cell = this.cell(line, column);
      return this.typing?.cell === cell ? this.typing.text : this.sent[cell] ?? line.row[column.key] ?? "";
    },
    change(line, column, event) {
      const { value } = event.target;
      const id = this.sent[`${line.key} id`]?.trim() ?? line.row.id ?? ""; // as it is called once what was sent is done
      this.typing = null;
      this.sent[this.cell(line, column)] = value;
      if (column.key === "id") this.names.set(value.trim(), line.name);
      this.ask("cell", { row: line.at, id, key: column.key, value });
    },
    ask(name, data) {
      window.musterUnsaved = true; // until the server, which has not heard of it, says
      this.$emit(name, data);
    },
    // From Python: what was sent is in the rows, or was refused.
    forget() {
      this.sent = {};
      const ids = new Set(this.rows.map(({ id }) => id));
      for (const id of this.names.keys()) if (!ids.has(id)) this.names.delete(id);
    },
  },
};
