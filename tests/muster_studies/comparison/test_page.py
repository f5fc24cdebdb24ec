"""The report of a comparison in a browser: at the width of a desk and of a phone nothing is lost."""

import pytest
from tests.report.page.browser import Browser, browser_found

import muster


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    file = tmp_path_factory.mktemp("report") / "r.html"

    def fails(problem):
        raise ValueError("<b>no & never</b>")

    allocators = {"greedy": "greedy", "a-name-that-is-as-long-as-some-are": "auction", "<fails>": fails}
    found = muster.compare("uniform:tasks=5:count=2", allocators, seeds=2, iterations=5, jobs=1)
    found.save_report(file, command="muster compare " + "x" * 300)
    return file


@pytest.mark.long
@pytest.mark.skipif(browser_found() is None, reason="no browser: tools/test_packages.sh installs one")
def test_the_page_fits_its_window_and_asks_for_nothing(report, tmp_path):
    browser = Browser(tmp_path)
    try:
        for width in (1400, 400):
            browser.open(report, width, 900, shown="table")
            assert browser.evaluate("document.documentElement.scrollWidth") <= width
            assert 300 < browser.evaluate("document.querySelector('svg').getBoundingClientRect().width") <= width
        headings = browser.evaluate("Array.from(document.querySelectorAll('h2'), one => one.textContent)")
        assert headings == [
            *("Allocators", "In pairs", "Figures", "Missions", "Runs that are not done"),
            *("How to read it", "How it was made"),
        ]
        assert (browser.requests, browser.complaints) == ([], [])
    finally:
        browser.close()


def test_names_and_reasons_are_text(report):
    page = report.read_text(encoding="utf-8")
    assert "ValueError: &lt;b&gt;no &amp; never&lt;/b&gt;" in page
    assert "<b>" not in page
    assert "&lt;fails&gt;" in page
