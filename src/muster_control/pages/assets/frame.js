// Keys that every view has: ? for help, g and a letter for another view. Nothing happens while one types.
"use strict";

(() => {
  const VIEWS = { m: "/", p: "/plan", l: "/live", r: "/records" };
  let going = false;

  const isTyping = (event) => event.ctrlKey || event.metaKey || event.altKey
    || event.target.closest?.("input, textarea, select, [contenteditable=true], .cm-editor");

  document.addEventListener("keydown", (event) => {
    if (isTyping(event)) return;
    const pressed = { "/": "search", n: "new" }[event.key];
    if (pressed && document.getElementById(pressed)) {
      event.preventDefault();
      const element = document.getElementById(pressed);
      if (pressed === "search") element.focus();
      else element.click();
    } else if (event.key === "?") document.getElementById("keys")?.showModal();
    else if (going && VIEWS[event.key]) window.location.assign(VIEWS[event.key]);
    going = event.key === "g";
  });

  // Pages with changes that are not saved ask before one leaves them: `window.musterUnsaved = true`.
  window.addEventListener("beforeunload", (event) => {
    if (window.musterUnsaved) event.preventDefault();
  });
})();

// Undo, redo and save press the buttons of the page, where it has them; in a field Ctrl+Z is the field's own.
document.addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
  const key = event.key.toLowerCase();
  const button = document.getElementById({ z: event.shiftKey ? "redo" : "undo", y: "redo", s: "save" }[key] ?? "");
  if (!button || event.target.closest?.(".cm-editor") || (key !== "s" && event.target.closest?.("input, textarea"))) return;
  event.preventDefault();
  if (key === "s" && event.repeat) return; // a key that is held saves once
  if (key === "s") document.activeElement?.blur?.(); // what is being typed into a field is saved, too
  button.click();
});
