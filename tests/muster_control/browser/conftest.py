"""Mission control as a process of its own, and a browser that looks at it and lets nothing pass that is wrong."""

import os
import re
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.report.page.browser import browser_found

WIDE, NARROW = {"width": 1440, "height": 900}, {"width": 390, "height": 844}
PICTURES = os.environ.get("MUSTER_SCREENSHOTS")
SHOTS = Path(PICTURES or "build/screenshots")
DRAWN = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
FLAGS = (
    "--no-sandbox",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-features=IsolateSandboxedIframes",  # the replay is drawn together with the page around it
    "--use-angle=swiftshader-webgl",  # for the view in space alone, without a graphics card; the rest is drawn without
    "--enable-unsafe-swiftshader",
)


@contextmanager
def serving(folder):
    """The address of `muster serve` with a database of its own in this folder."""
    command = [sys.executable, "-m", "muster.cli", "serve", "--port", "0"]
    command += ["--db", f"sqlite:///{folder / 'muster.db'}"]
    log = folder / "log"
    with (
        log.open("w") as stderr,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=stderr, text=True) as server,
    ):
        found = re.match(r"mission control: (http://\S+)/$", server.stdout.readline())
        assert found, log.read_text()
        yield found[1]
        server.terminate()
        assert server.wait(30) == 0, log.read_text()
    assert "Traceback" not in log.read_text(), log.read_text()


@pytest.fixture(scope="module")
def served_in(tmp_path_factory):
    """The folder with the database of the server."""
    return tmp_path_factory.mktemp("served")


@pytest.fixture(scope="module")
def served(served_in):
    with serving(served_in) as origin:
        yield origin


@contextmanager
def running_chromium():
    if browser_found() is None:
        pytest.skip("no browser: tools/test_packages.sh installs one")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_found(), args=list(FLAGS))
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def chromium():
    """One browser for the tests of a module: Playwright's loop must end before other tests of this process begin."""
    with running_chromium() as browser:
        yield browser


class Watched:
    """A page of the browser: errors on its console and requests that leave this machine are kept."""

    def __init__(self, browser, origin):
        self.origin, self.errors, self.foreign = origin, [], []
        self.page = browser.new_page(viewport=WIDE, accept_downloads=True)
        self.page.set_default_timeout(60_000)
        self.page.on("console", self._hear)
        self.page.on("pageerror", lambda error: self.errors.append(f"{error}\n{error.stack}"))
        self.page.on("request", self._see)
        self.page.on("websocket", lambda socket: self._see_address(socket.url))

    def open(self, path):
        self.page.goto(f"{self.origin}{path}")

    def shoot(self, name, settles_ms=300):
        """Draw the page as it is on a phone and on a screen, and keep pictures where they are asked for."""
        for size in (NARROW, WIDE):
            self.page.set_viewport_size(size)
            self.page.wait_for_timeout(settles_ms if PICTURES else 0)
            for frame in self.page.frames:
                frame.evaluate(DRAWN)  # a page within the page is laid out after it
            if PICTURES:
                SHOTS.mkdir(parents=True, exist_ok=True)
                phone = size is NARROW
                self.page.screenshot(path=SHOTS / f"{name}-{size['width']}x{size['height']}.png", full_page=phone)

    def keep(self, name):
        """What is seen where a test has failed: a picture, and the page as text."""
        SHOTS.mkdir(parents=True, exist_ok=True)
        self.page.screenshot(path=SHOTS / f"failed-{name}.png")
        (SHOTS / f"failed-{name}.html").write_text(self.page.content())

    def require_clean(self):
        assert not self.errors, self.errors
        assert not self.foreign, self.foreign

    def _hear(self, message):
        if message.type == "error":
            self.errors.append(f"{message.text} ({message.location})")

    def _see(self, request):
        self._see_address(request.url)

    def _see_address(self, url):
        inside = (self.origin, self.origin.replace("http", "ws", 1), "data:", "blob:")
        if not url.startswith(inside):
            self.foreign.append(url)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    if report.when == "call" and report.failed and "watched" in item.funcargs:
        item.funcargs["watched"].keep(item.name)
    return report


@pytest.fixture(scope="module")
def watched(chromium, served):
    """A page that is the same for the whole story."""
    watched = Watched(chromium, served)
    yield watched
    watched.page.close()
