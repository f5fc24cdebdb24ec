// Time: playing, the slider, the keyboard, pointing into charts; and drawing anew when the window changes.

const SPEEDS = [0.25, 0.5, 1, 2, 5, 10, 20, 50, 100, 500];
const WATCHED_S = 40; // about how long a mission plays at the speed that is set first
const slider = document.getElementById("slider");
const playButton = document.getElementById("play");
const clock = document.getElementById("clock");
const speedChoice = document.getElementById("speed");
let now = 0;
let playing = false;
let lastFrame = null;

function show() {
  slider.value = now;
  slider.setAttribute("aria-valuetext", seconds(now));
  clock.textContent = `${now.toFixed(1)} / ${seconds(duration)}`;
  showMap(now);
  showCharts(now);
  showPanels(now);
}

function seek(time) {
  now = Math.min(Math.max(time, 0), duration);
  show();
}

function setPlaying(on) {
  if (on && now >= duration) now = 0;
  playing = on;
  lastFrame = null;
  playButton.textContent = on ? "❚❚" : "▶";
  playButton.setAttribute("aria-label", on ? "Pause" : "Play");
  if (on) requestAnimationFrame(frame);
}

function frame(at) {
  if (!playing) return;
  if (lastFrame !== null) seek(now + ((at - lastFrame) / 1000) * Number(speedChoice.value));
  lastFrame = at;
  if (now >= duration) setPlaying(false);
  else requestAnimationFrame(frame);
}

function onKey(event) {
  if (event.target.closest("select") || event.ctrlKey || event.metaKey || event.altKey) return;
  const step = event.shiftKey ? 10 : 1;
  const leaps = { ArrowLeft: now - step, ArrowRight: now + step, Home: 0, End: duration };
  if (event.key === " " && !event.target.closest("button")) setPlaying(!playing);
  else if (event.key in leaps) seek(leaps[event.key]);
  else return;
  event.preventDefault();
}

function pointAt(picture) {
  picture.addEventListener("pointerdown", (event) => {
    picture.setPointerCapture(event.pointerId);
    seek(timeAt(picture, event));
  });
  picture.addEventListener("pointermove", (event) => {
    if (picture.hasPointerCapture(event.pointerId)) seek(timeAt(picture, event));
  });
}

function drawAll() {
  drawMap();
  drawCharts();
  show();
}

function start() {
  slider.max = duration;
  const first = SPEEDS.find((speed) => duration / speed <= WATCHED_S) ?? SPEEDS.at(-1);
  speedChoice.append(...SPEEDS.map((speed) => html("option", { value: speed }, `${speed} ×`)));
  speedChoice.value = first;
  slider.addEventListener("input", () => seek(Number(slider.value)));
  playButton.addEventListener("click", () => setPlaying(!playing));
  document.addEventListener("keydown", onKey);
  [ganttPicture, distancePicture, heightPicture].forEach(pointAt);
  picturedAs(mapPicture, `Map with ${robots.length} robots and ${tasks.length} tasks`);
  fillPanels();
  drawAll();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawAll);
  new ResizeObserver(drawAll).observe(document.querySelector("main"));
}

start();
