// A table whose cells are fields; long ones are shown page by page.

const PAGE = 100; // rows

export default {
  template: `
    <section class="edit-table">
      <h3>{{ title }} <span v-if="grows" class="quiet">{{ rows.length }}</span></h3>
      <div class="scrolling">
        <table class="plain">
          <thead><tr>
            <th v-for="column in columns" :key="column.key" scope="col" :title="column.hint"
              :class="[column.kind, { long: column.key.length > 3 }]"><template
              v-for="(part, k) in column.key.split('_')" :key="k"><template v-if="k">_<wbr></template>{{ part }}</template></th>
            <th v-if="grows && editable" class="drop"><span class="sr-only">Remove</span></th>
          </tr></thead>
          <tbody>
            <tr v-for="(row, k) in page" :key="revision + ' ' + (first + k)">
              <td v-for="column in columns" :key="column.key" :class="column.kind">
                <select v-if="column.kind === 'choice'" :value="row[column.key] ?? ''" :disabled="!editable"
                        :aria-label="name(row, column)" @change="change(k, column, $event)">
                  <option value=""></option>
                  <option v-for="choice in column.choices" :key="choice" :value="choice">{{ choice }}</option>
                </select>
                <input v-else size="1" :value="row[column.key] ?? ''" :readonly="!editable" :class="column.kind"
                       :inputmode="column.kind === 'number' ? 'decimal' : 'text'" :aria-label="name(row, column)"
                       @change="change(k, column, $event)">
              </td>
              <td v-if="grows && editable" class="drop">
                <button type="button" class="bare" :aria-label="'Remove ' + row.id" title="Remove" @click="$emit('drop', row.id)">×</button>
              </td>
            </tr>
          </tbody>
        </table>
      </div>
      <p class="edit-table-foot">
        <button v-if="grows && editable" type="button" class="plain" @click="$emit('add')">Add a row</button>
        <template v-if="rows.length > ${PAGE}">
          <button type="button" class="plain" :disabled="first === 0" @click="first -= ${PAGE}">‹</button>
          <span>{{ first + 1 }} to {{ first + page.length }}</span>
          <button type="button" class="plain" :disabled="first + ${PAGE} >= rows.length" @click="first += ${PAGE}">›</button>
        </template>
      </p>
    </section>`,
  props: { title: String, columns: Array, rows: Array, editable: Boolean, grows: Boolean, revision: Number },
  data() { return { first: 0 }; },
  computed: { page() { return this.rows.slice(this.first, this.first + PAGE); } },
  methods: {
    name(row, column) { return `${column.key} ${row.id ? `of ${row.id}` : ""}`; },
    change(k, column, event) { this.$emit("cell", { row: this.first + k, key: column.key, value: event.target.value }); },
  },
};
