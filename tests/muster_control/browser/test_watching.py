"""Whoever may only watch sees everything, has nothing to press that commands, and cannot press it all the same."""

import re
import subprocess
import sys

import pytest
from tests.muster_control.browser.conftest import Watched
from tests.muster_control.security.shielded import COMMANDER, TOKENS, WATCHER
from tests.muster_control.serving import served

from muster_control.client import Client
from muster_control.work.turns import Turns

pytestmark = [pytest.mark.long, pytest.mark.xdist_group("watching")]

MISSION = "6T-2R"
COMMANDS = re.compile(
    r"New mission|Duplicate|Delete|Save|Undo|Redo|History|^Plan$|Stop|Carry out|Start|Upload|Pause$|Cancel|Add|Fail"
    r"|Recall|Take out|Remove|Restore",
    re.IGNORECASE,
)


@pytest.fixture(scope="module")
def guarded(tmp_path_factory):
    """The address of a server that asks for tokens."""
    folder = tmp_path_factory.mktemp("guarded")
    tokens = folder / "tokens"
    tokens.write_text(TOKENS)
    tokens.chmod(0o600)
    command = [sys.executable, "-m", "muster.cli", "serve", "--port", "0"]
    command += ["--db", f"sqlite:///{folder / 'muster.db'}", "--tokens", str(tokens)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        yield re.match(r"mission control: (http://\S+)/$", server.stdout.readline())[1]
        server.terminate()
        assert server.wait(30) == 0


@pytest.fixture(scope="module")
def watched(chromium, guarded):
    """A page of the watcher's, who has logged in."""
    watched = Watched(chromium, guarded)
    watched.open("/records")
    watched.page.fill("#token", WATCHER)
    watched.page.get_by_role("button", name="Log in").click()
    watched.page.get_by_text("There are no records yet").wait_for()
    yield watched
    watched.page.close()


def test_the_login_page_shows_one_field(watched):
    page = watched.page
    watched.open("/login?next=/records")
    page.locator("#token").wait_for()
    fields = page.locator("input").evaluate_all(
        "all => all.map(one => [one.name, one.checkVisibility(), one.getBoundingClientRect().height])"
    )
    assert {name for name, _, _ in fields} == {"username", "token", "next"}
    for name, is_visible, height in fields:
        assert (is_visible, height > 0) == ((True, True) if name == "token" else (False, False)), name
    watched.shoot("login")


def commanding(page):
    """Texts on buttons and fields that would command something."""
    shown = page.locator("button:visible").evaluate_all("all => all.map(b => b.ariaLabel || b.innerText)")
    return [words for words in shown if COMMANDS.search(words)]


def test_the_watcher_sees_missions_plans_and_runs_without_a_button_that_commands(watched, guarded):
    page = watched.page
    with Client(guarded, token=COMMANDER) as boss:
        run = boss.start(boss.plan(MISSION, iterations=20).wait(), speed=0.2)
    watched.open("/")
    page.get_by_role("link", name=MISSION, exact=True).wait_for()
    assert commanding(page) == []
    watched.open(f"/plan/{MISSION}")
    page.locator("#export").wait_for()
    page.get_by_role("button", name="Form", exact=True).click()
    page.locator(".edit-table input").first.wait_for()
    assert page.locator(".edit-table input:not([readonly])").count() == 0
    assert commanding(page) == []
    watched.open(f"/live/{run.id}")
    page.locator(".clock").wait_for()
    assert commanding(page) == []
    watched.shoot("watching")


@pytest.mark.long
def test_work_for_a_page_and_for_the_api_takes_the_turn_of_who_asks(chromium, tmp_path, monkeypatch):
    users, turn = [], Turns.turn
    monkeypatch.setattr(Turns, "turn", lambda self, user: users.append(user) or turn(self, user))
    (tmp_path / "tokens").write_text(TOKENS)
    with served(tmp_path, tokens=tmp_path / "tokens") as url:
        page = Watched(chromium, url)
        page.open(f"/plan/{MISSION}")
        page.page.fill("#token", WATCHER)
        page.page.get_by_role("button", name="Log in").click()
        page.page.locator("canvas, svg").first.wait_for()
        page.page.get_by_role("button", name="Form", exact=True).click()
        page.page.locator(".edit-table input").first.wait_for()
        page.page.close()
        assert users
        assert set(users) == {"wall"}
        with Client(url, token=COMMANDER) as boss:
            boss.missions.check("schema: muster/1")
        assert users[-1] == "anna"


def test_a_forged_command_is_refused(watched, guarded):
    page = watched.page
    forged = """() => {
      const id = document.querySelector('.muster-live-frame').id.slice(1);
      getElement(Number(id)).view.act('cancel', {}, 'the end');
    }"""
    page.evaluate(forged)
    page.get_by_text("may only watch; expected the role command").wait_for()
    with Client(guarded, token=COMMANDER) as boss:
        run = boss.runs()[0]
        assert run.state in ("starting", "running")
        boss.run(run.id).cancel()


def test_the_watcher_logs_out(watched):
    page = watched.page
    cookies = page.context.cookies()
    assert [(c["httpOnly"], c["sameSite"]) for c in cookies] == [(True, "Strict")]
    page.get_by_role("button", name="Log out").click()
    page.wait_for_url("**/login")
    assert page.context.cookies() == []
    page.context.add_cookies(cookies)  # a copy is worth nothing now
    watched.open("/")
    page.wait_for_url("**/login?next=/")
    watched.require_clean()
