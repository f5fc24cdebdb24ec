import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster_control.runs.log.tracks import Steps, Track, packed, unpacked

VALUE = st.one_of(st.floats(-1e6, 1e6), st.just(float("nan")))


@given(st.integers(0, 4), st.integers(1, 6), st.sampled_from([0.0, 2147482.0, 3e7, 2e9]), st.data())
def test_what_is_packed_comes_back_to_a_thousandth(robots, steps, from_s, data):
    """Also of a mission that began months or years ago by its starts_at."""
    states = np.array(data.draw(st.lists(VALUE, min_size=robots * steps * 7, max_size=robots * steps * 7)))
    times = from_s + np.cumsum(data.draw(st.lists(st.integers(1, 10_000), min_size=steps, max_size=steps))) / 1000
    names = tuple(f"r_{k} ü" for k in range(robots))
    back = unpacked(packed(Steps(names, times, states.reshape(steps, robots, 7))))
    assert back.robots == names
    np.testing.assert_allclose(back.times_s, times, rtol=0, atol=1e-6)
    np.testing.assert_allclose(back.states, states.reshape(steps, robots, 7), atol=5.1e-4)


def test_stretches_end_at_fixed_times_and_hold_every_step_once():
    track, ended = Track(5.0), []
    for k in range(131):
        rows = {"a": [k, 0, 0, 0, 0, 0, 0.0]} | ({"b": [0.0] * 7} if k >= 20 else {})
        ended.append(track.add(k / 10, rows))
    stretches = [one for one in [*ended, track.take()] if one is not None]
    assert [(one.times_s[0], one.times_s[-1]) for one in stretches] == [(0.0, 5.0), (5.1, 10.0), (10.1, 13.0)]
    assert sum(len(one.times_s) for one in stretches) == 131
    assert np.isnan(stretches[0].states[:20, 1]).all()
    assert not np.isnan(stretches[0].states[20:, 1]).any()
    assert track.take() is None


@pytest.mark.parametrize("data", [b"", b"x", packed(Steps(("a",), np.array([1.0]), np.zeros((1, 1, 7))))[:-3]])
def test_what_is_no_stretch_is_refused(data):
    with pytest.raises(ValueError, match="no stretch"):
        unpacked(data)
