from datetime import UTC, datetime, timedelta

from hypothesis import given
from hypothesis import strategies as st

from muster.exchange.mission_control import Entry
from muster.server.runs import packed_log
from muster.server.runs.packed_log import PackedLog

BEGUN = datetime(2026, 5, 1, 8, tzinfo=UTC)


@given(st.lists(st.text(max_size=2000), max_size=20), st.integers(1, 3000))
def test_what_is_taken_comes_back_whole_and_in_order(texts, block):
    kept, packed_log._BLOCK = packed_log._BLOCK, block
    try:
        it = PackedLog()
        entries = [
            Entry(run=7, seq=k, time_s=k / 7, kind="x", data={"text": text, "k": [k, None]}, at=BEGUN + timedelta(k))
            for k, text in enumerate(texts, start=1)
        ]
        it.add(entries)
        assert list(it.entries()) == entries
    finally:
        packed_log._BLOCK = kept


def test_much_takes_little_room():
    it = PackedLog()
    it.add(
        [Entry(run=1, seq=k, time_s=k, kind="starts", data={"robot": f"r_{k % 9}", "task": "7"}) for k in range(50_000)]
    )
    assert sum(map(len, it._packed)) + it._size < 1_500_000
