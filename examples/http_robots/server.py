"""A small HTTP server of simulated robots, in place of yours: `python server.py [PORT]`.

GET  /robots                 {"r_0": {"x": 0.0, "y": 0.0, "heading": 0.0, "age_s": 0.0, "charge": 1.0}, ...}
POST /robots/r_0/goal        {"x": 2.0, "y": 0.0, "heading": null}: go there, in a straight line
POST /robots/r_0/stop        stop
POST /robots/r_0/silence     from now on r_0 reports nothing new, and takes no orders, until
POST /robots/r_0/wake
"""

import json
import math
import sys
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

SPEED_MPS = 1.0


class Robot:
    def __init__(self, x, y):
        self.x, self.y, self.heading, self.charge, self.goal = x, y, 0.0, 1.0, None
        self.moved_s = self.heard_s = time.monotonic()
        self.silent, self.said = False, {}

    def move(self):
        """Drive for the time since the last call, towards the goal."""
        now = time.monotonic()
        may_m, self.moved_s = SPEED_MPS * (now - self.moved_s), now
        if self.goal is not None:
            x, y, heading = self.goal
            left_m = math.dist((x, y), (self.x, self.y))
            gone_m = min(left_m, may_m)
            if left_m > 0:
                self.heading = math.atan2(y - self.y, x - self.x)
                self.x += (x - self.x) * gone_m / left_m
                self.y += (y - self.y) * gone_m / left_m
            if gone_m == left_m:
                self.heading = self.heading if heading is None else heading
            self.charge = max(0.0, self.charge - 0.0001 * gone_m)

    def report(self):
        self.move()
        if not self.silent:
            self.heard_s = self.moved_s
            self.said = {"x": self.x, "y": self.y, "heading": self.heading, "charge": self.charge}
        return {**self.said, "age_s": self.moved_s - self.heard_s}


class Robots:
    """The robots by their ids, and all orders that came for them."""

    def __init__(self, places):
        self.robots, self.orders, self.lock = (
            {name: Robot(*place) for name, place in places.items()},
            [],
            threading.Lock(),
        )

    def do(self, name, verb, data):
        with self.lock:
            robot = self.robots[name]
            robot.report()
            if verb in ("silence", "wake"):
                robot.silent = verb == "silence"
            elif not robot.silent:
                self.orders.append((name, verb, data))
                robot.goal = (data["x"], data["y"], data["heading"]) if verb == "goal" else None

    def reports(self):
        with self.lock:
            return {name: robot.report() for name, robot in self.robots.items()}


def server_of(robots, port=0):
    """A server that is to be started by `serve_forever()`; port 0: any that is free."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            self.answer(200 if self.path == "/robots" else 404, robots.reports())

        def do_POST(self):
            length = int(self.headers.get("Content-Length", 0))
            data = json.loads(self.rfile.read(length) or b"{}")
            try:
                _, _, name, verb = self.path.split("/")
                robots.do(name, verb, data)
            except (KeyError, ValueError):
                return self.answer(404, {})
            return self.answer(200, {})

        def answer(self, status, data):
            body = json.dumps(data).encode()
            self.send_response(status)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass

    return ThreadingHTTPServer(("127.0.0.1", port), Handler)


if __name__ == "__main__":
    port = int(sys.argv[1]) if len(sys.argv) > 1 else 8000
    server = server_of(Robots({"r_0": (0.0, 0.0), "r_1": (0.0, 3.0)}), port)
    print(f"robots: http://127.0.0.1:{port}", flush=True)
    server.serve_forever()
