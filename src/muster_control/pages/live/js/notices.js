// What became of each command: asked, done at a time, or why it was refused; with a way back where there is one.

import { button, html, seconds, setText } from "./elements.js";

const MOST_SHOWN = 5;
const STAYS_MS = 4000;
const CAN_BE_UNDONE_MS = 25000; // by its button; longer by the key

export class Notices {
  constructor({ onUndo, onSettled }) {
    Object.assign(this, { onUndo, onSettled });
    this.asked = new Map(); // token -> notice
    this.byAction = new Map(); // action id -> notice
    this.outcomes = new Map(); // action id -> outcome, which may come before its id is known
    this.undoable = []; // notices that can be undone, newest last
    this.unkept = new Map(); // action id -> notice of a command that only the server's journal has
    this.element = html("ul", { class: "notices", role: "status", "aria-live": "polite", "aria-label": "Commands" });
  }

  // `undo`: {words, verb, data} of the command that takes it back; `again()`: asks otherwise what was refused; or null.
  ask(token, words, { undo, again }) {
    const state = html("span", { class: "state" }, "asked …");
    const element = html("li", { class: "asked" }, html("span", {}, words), state);
    element.append(button("✕", () => this.drop(notice), { class: "close", "aria-label": "Close" }));
    const notice = { token, element, state, undo, again };
    this.asked.set(token, notice);
    this.element.prepend(element);
    while (this.element.childElementCount > MOST_SHOWN) this.element.lastElementChild.remove();
  }

  // The desk's answer: the action's id and perhaps its outcome already, or why it was refused at once.
  answer({ token, action, outcome, error, kept }, time) {
    const notice = this.asked.get(token);
    this.asked.delete(token);
    if (!notice) return;
    if (error) {
      this.settle(notice, error, time);
      return;
    }
    if (kept === false) this.markUnkept(action, notice);
    const known = outcome || this.outcomes.get(action);
    if (known) this.settle(notice, known, time);
    else this.byAction.set(action, notice);
  }

  markUnkept(id, notice) {
    const title = "The database is away: the server's journal has this command until the database is back";
    notice.unkept = html("span", { class: "unkept", title }, "⚠ in the journal");
    notice.state.before(notice.unkept);
    this.unkept.set(id, notice);
  }

  // The database is back, and has what was asked for.
  kept(id) {
    this.unkept.get(id)?.unkept.remove();
    this.unkept.delete(id);
  }

  // Told twice: by the log, where nothing is missed, and as it becomes known; the first counts.
  outcome(id, outcome, time) {
    if (this.outcomes.has(id)) return;
    this.outcomes.set(id, outcome);
    const notice = this.byAction.get(id);
    this.byAction.delete(id);
    if (notice) this.settle(notice, outcome, time);
  }

  settle(notice, outcome, time) {
    const done = outcome === "done";
    this.onSettled(notice.token, done);
    setText(notice.state, done ? `✓ done at ${seconds(time)}` : `✕ refused: ${outcome}`);
    notice.element.className = done ? "done" : "refused";
    if (done && notice.undo) {
      notice.button = button("Undo", () => this.takeBack(notice), { class: "undo", title: notice.undo.words });
      notice.state.after(notice.button);
      this.undoable.push(notice);
    }
    if (!done && notice.again) {
      const change = () => { this.drop(notice); notice.again(); };
      notice.state.after(button("Change it …", change, { class: "again" }));
    }
    if (done && !notice.unkept) setTimeout(() => notice.element.remove(), notice.undo ? CAN_BE_UNDONE_MS : STAYS_MS);
  }

  // What has happened anyway need not be taken back any more, nor what became of a task that is cancelled or done.
  happened({ kind, data }) {
    const about = data.robot ?? data.task;
    const gone = ["cancel_task", "ends", "lost"].includes(kind);
    const moot = ({ undo }) => about !== undefined && (undo.data[kind] === about || (gone && taskOf(undo.data) === about));
    for (const notice of this.undoable.filter(moot)) notice.button.remove();
    this.undoable = this.undoable.filter((notice) => !moot(notice));
  }

  // A remark that answers no command.
  say(words, kind = "refused") {
    const element = html("li", { class: kind }, html("span", {}, words));
    const notice = { element };
    element.append(button("✕", () => this.drop(notice), { class: "close", "aria-label": "Close" }));
    this.element.prepend(element);
  }

  takeBack(notice = this.undoable.at(-1)) {
    if (!notice) return;
    this.drop(notice);
    this.onUndo(notice.undo);
  }

  drop(notice) {
    this.undoable = this.undoable.filter((other) => other !== notice);
    notice.element.remove();
  }
}

const taskOf = (data) => data.move_task?.task ?? data.cancel_task;
