"""Missions are edited as text, also while another text or a mark is on its way."""

import pytest
from tests.muster_control.browser.missions_and_plan.plan_view import plan_view, text_of

pytestmark = pytest.mark.xdist_group("missions and plan")  # they share a server


HELD = """() => {
  const pass = socket.onevent;
  window.held = [];
  window.heldHas = (words) => held.some((packet) => JSON.stringify(packet.data).includes(words));
  window.release = () => { socket.onevent = pass; held.forEach((packet) => socket.onevent(packet)); };
  socket.onevent = (packet) => held.push(packet);
}"""  # what the server sends is on its way, as long as a test wants

ANSWERS_HELD = """() => {
  const emit = socket.emit.bind(socket);
  const held = [];
  window.releaseAnswers = () => { socket.emit = emit; held.forEach((answer) => emit(...answer)); };
  socket.emit = (...said) => said[0] === "javascript_response" ? held.push(said) : emit(...said);
}"""  # the browser's answers, by which the server knows what is shown, are late


def test_what_is_wrong_is_said_with_its_line_while_one_types(watched, page, yard):
    plan_view(watched, yard)
    page.get_by_role("button", name="Text", exact=True).click()
    page.locator(".cm-content").click()
    page.keyboard.press("Control+End")
    page.keyboard.type("taskss: []")
    page.get_by_text("did you mean 'tasks'").first.wait_for()
    page.wait_for_selector(".wrong-line")
    page.keyboard.press("Control+z")
    page.wait_for_selector(".findings", state="hidden")


def end_of_text(page):
    page.get_by_role("button", name="Text", exact=True).click()
    page.locator(".cm-content").click()
    page.keyboard.press("Control+End")


@pytest.mark.long
def test_what_is_typed_while_another_text_is_on_its_way_is_put_into_that(watched, page, yard):
    plan_view(watched, yard)
    before = text_of(page)
    end_of_text(page)
    page.keyboard.press("Control+Home")
    page.keyboard.insert_text("# head ")
    page.get_by_text("version 1, changed").wait_for()
    page.evaluate(HELD)
    page.keyboard.press("Control+z")
    page.wait_for_function("heldHas('setEditorValueFromProps')")
    for key in ("Control+End", "ArrowUp", "End"):
        page.keyboard.press(key)
    page.keyboard.type(" # tail")
    page.evaluate("release()")
    page.wait_for_function("!document.querySelector('.cm-content').textContent.includes('# head')")
    page.wait_for_function("document.querySelector('.cm-content').textContent.endsWith(' # tail')")
    after = before.removesuffix("\n") + " # tail\n"
    assert text_of(page) == after
    page.keyboard.press("Control+s")
    page.get_by_text("version 2", exact=True).wait_for()
    plan_view(watched, yard)
    assert text_of(page, " # tail") == after


def test_what_is_typed_before_the_server_knows_that_the_text_is_shown_stays(watched, page, yard):
    plan_view(watched, yard)
    page.evaluate(ANSWERS_HELD)
    end_of_text(page)
    page.keyboard.type("# at once")
    page.get_by_text("version 1, changed").wait_for()
    page.evaluate("releaseAnswers()")
    assert text_of(page).endswith("# at once")


@pytest.mark.long
def test_what_is_typed_while_a_mark_is_on_its_way_stays(watched, page, yard):
    plan_view(watched, yard)
    end_of_text(page)
    page.evaluate(HELD)
    page.keyboard.type("taskss: []")
    page.wait_for_function("heldHas('wrong-line')")
    page.keyboard.type(" # mo")
    page.evaluate("release()")
    page.wait_for_selector(".wrong-line")
    page.keyboard.type("re")
    assert text_of(page).endswith("taskss: [] # more")
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("speed_mps of r_0").wait_for()
    assert text_of(page, "# more").endswith("taskss: [] # more")


def test_what_cannot_be_put_into_another_text_is_told_and_gone_on_both_sides(watched, page, yard):
    plan_view(watched, yard)
    before = text_of(page)
    end_of_text(page)
    page.keyboard.insert_text("# last")
    page.get_by_text("version 1, changed").wait_for()
    page.evaluate(HELD)
    page.keyboard.press("Control+z")
    page.wait_for_function("heldHas('setEditorValueFromProps')")
    page.keyboard.press("ArrowLeft")
    page.keyboard.type("er")
    page.evaluate("release()")
    page.get_by_text("What you typed last is not in the text").wait_for()
    assert text_of(page) == before
    page.get_by_text("version 1", exact=True).wait_for()


@pytest.mark.long
def test_a_change_of_a_text_that_is_not_known_cuts_nothing(watched, page, yard):
    plan_view(watched, yard)
    before = text_of(page)
    change = "{ sections: [5, -1, 0, 1], inserted: [[], ['x']] }"
    page.evaluate(f"getElement(document.querySelector('.script')).$emit('update:value', {change})")
    page.get_by_text("What you typed last is not in the text").wait_for()
    assert text_of(page) == before
    page.get_by_text("version 1", exact=True).wait_for()
    end_of_text(page)
    page.keyboard.type("# still")
    page.get_by_text("version 1, changed").wait_for()
    page.keyboard.press("Control+s")
    page.get_by_text("version 2", exact=True).wait_for()
    plan_view(watched, yard)
    assert text_of(page, "# still") == before + "# still"
