"""Tables of pages: what strangers wrote stays words."""

from html.parser import HTMLParser

from hypothesis import given
from hypothesis import strategies as st

from muster_control.pages.tables import table_text

words = st.text(st.characters(codec="utf-8", exclude_characters="\r"), max_size=20)


class Reader(HTMLParser):
    """What a browser finds in a table: cells as texts, addresses, elements."""

    def __init__(self):
        super().__init__()
        self.cells, self.addresses, self.names, self._within = [], [], set(), False

    def handle_starttag(self, tag, attrs):
        self.names.add(tag)
        if tag == "a":
            self.addresses.append(dict(attrs)["href"])
        if tag == "td":
            self.cells.append("")
            self._within = True

    def handle_endtag(self, tag):
        self._within = self._within and tag != "td"

    def handle_data(self, data):
        if self._within:
            self.cells[-1] += data


def read(text):
    reader = Reader()
    reader.feed(text)
    reader.close()
    return reader


@given(st.lists(st.tuples(words, words), max_size=4), words)
def test_cells_say_what_was_given_and_nothing_else(rows, label):
    found = read(table_text(("a", "b"), rows, label=label))
    assert found.cells == [cell for row in rows for cell in row]
    assert found.names <= {"table", "thead", "tbody", "tr", "th", "td"}


@given(words, words)
def test_a_link_goes_where_it_was_told(name, address):
    found = read(table_text(("a",), [((name, address),)]))
    assert (found.cells, found.addresses) == ([name], [address])


def test_numbers_are_set_to_the_right():
    text = table_text(("robot", "used"), [("r_0", "1.5")], numbers=(1,))
    assert '<td class="number">1.5</td>' in text
    assert "<td>r_0</td>" in text
