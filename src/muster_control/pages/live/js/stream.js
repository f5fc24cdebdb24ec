// A run's stream: opened, kept open, and after a break opened again from the last entry that was heard.

const FIRST_WAIT_MS = 400;
const LONGEST_WAIT_MS = 8000;
const POLICY = 1008; // close code: this page may not read the stream

export class Stream {
  // `onMessage(message)`; `onConnection({lostSince, why, forGood})`: lostSince is null while it is open; `isOver()`:
  // nothing more will come.
  constructor(path, { onMessage, onConnection, isOver }) {
    this.path = path;
    this.isOver = isOver;
    this.onMessage = onMessage;
    this.onConnection = onConnection;
    this.last = 0;
    this.wait = FIRST_WAIT_MS;
    this.lostSince = null;
    this.closed = false;
    this.open();
  }

  open() {
    const scheme = window.location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${window.location.host}${this.path}?after=${this.last}`);
    this.socket.addEventListener("message", (event) => this.take(JSON.parse(event.data)));
    this.socket.addEventListener("close", (event) => this.lost(event));
  }

  take(message) {
    if (message.type === "hello") {
      this.wait = FIRST_WAIT_MS;
      this.lostSince = null;
      this.onConnection({ lostSince: null, why: "", forGood: false });
    }
    if (message.type === "entry") {
      if (message.seq <= this.last) return; // heard before the break
      this.last = message.seq;
    }
    this.onMessage(message);
  }

  lost({ code, reason }) {
    if (this.closed || this.isOver()) return;
    this.lostSince ??= Date.now();
    const forGood = code === POLICY || (code >= 4400 && code < 4500);
    this.onConnection({ lostSince: this.lostSince, why: reason, forGood });
    if (forGood) return;
    this.timer = setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(this.wait * 2, LONGEST_WAIT_MS);
  }

  close() {
    this.closed = true;
    clearTimeout(this.timer);
    this.socket.close();
  }
}
