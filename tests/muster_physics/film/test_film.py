"""Films: as many pictures as their speed says, with everybody where it is and what has happened written above."""

from importlib.util import find_spec

import numpy as np
import pytest

from muster.mission.errors import InputError, ParameterError
from muster.report.figures.styles import robot_style

pytestmark = pytest.mark.skipif(find_spec("cv2") is None, reason="the extra `physics` is not installed")

RATE, REST = 25, 38


def frames_of(file):
    import cv2

    film, found = cv2.VideoCapture(str(file)), []
    while True:
        there, picture = film.read()
        if not there:
            return found
        found.append(picture[:, :, ::-1])


def color_of(robot):
    color = robot_style(robot).color
    return np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)], dtype=float)


def hue(color):
    return color / np.linalg.norm(color)


@pytest.mark.long
def test_an_mp4_has_as_many_pictures_as_its_speed_says(footage, tmp_path):
    from muster_physics.film import write_film

    file = tmp_path / "film.mp4"
    made = write_film(file, footage, speed=80)
    frames = frames_of(file)
    expected = int(np.ceil(footage.times_s[-1] / (80 / RATE) - 1e-9)) + 1 + REST
    assert made.frames == len(frames) == expected
    assert made.duration_s == pytest.approx(expected / RATE)
    assert {frame.shape for frame in frames} == {(540, 960, 3)}
    assert frames[0].std() > 5
    assert np.abs(frames[0].astype(int) - frames[-1]).max() > 80


def test_a_gif(footage, tmp_path):
    image = pytest.importorskip("PIL.Image")
    from muster_physics.film import write_film

    made = write_film(tmp_path / "film.gif", footage, speed=40)
    with image.open(tmp_path / "film.gif") as gif:
        assert gif.size == (640, 360)
        assert gif.info["duration"] == 80
        duration = 0
        for k in range(gif.n_frames):
            gif.seek(k)
            duration += gif.info["duration"]
    assert duration == pytest.approx(1000 * made.duration_s)  # pictures that are alike may be one
    assert (tmp_path / "film.gif").stat().st_size < 1_000_000


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_robots_are_seen_where_they_are_in_their_colors(footage, share):
    """Beside a robot's body, within its ring, the picture has the robot's hue; far away it has not."""
    from muster_physics.film.scenery import FilmScene

    with FilmScene(footage, 960, 540) as scene:
        now = share * scene.moments.end_s
        picture = scene.picture(now).astype(float)
        poses = scene.moments.at(now)
        middle = poses[0, :3] + (0.0, 0.0, 0.12)  # the lid of the rover, a holonomic one
        x, y = np.floor(scene.view.pixels(middle[None])[0]).astype(int)
        seen = picture[y - 1 : y + 2, x - 1 : x + 2].mean(axis=(0, 1))
        assert hue(seen) @ hue(color_of(0)) > 0.99
        ground = picture[520:535, 300:660].mean(axis=(0, 1))
        assert ground.min() > 225


def test_tasks_take_the_color_of_who_has_done_them(footage):
    from muster_physics.film.scenery import FilmScene

    with FilmScene(footage, 960, 540) as scene:
        x, y = np.round(scene.view.pixels(np.array([(4.0, 2.5, 0.0)]))[0]).astype(int)
        before = scene.picture(0.0)[y, x].astype(float)
        assert before.min() > 225
        assert scene.moments.mission_state.stage("far") == "open"
        after = scene.picture(scene.moments.end_s)
        assert scene.moments.mission_state.stage("far") == "done"
        foot = np.round(scene.view.pixels(np.array([(3.0, 0.0, 0.0)]))[0]).astype(int)
        near = after[foot[1] - 12 : foot[1] + 12, foot[0] - 12 : foot[0] + 12].reshape(-1, 3).astype(float)
        assert max(hue(color) @ hue(color_of(0)) for color in near) > 0.99


def test_captions_tell_what_happens_and_fade(footage):
    from muster_physics.film.captions import caption

    lines = [words for told in footage.events if (words := caption(told))]
    assert {"rover has done task near", "uav has done task far", "idle is out"} <= set(lines)
    assert not any("starts" in line or "sets out" in line for line in lines)


def test_what_is_written_is_seen(footage):
    from muster_physics.film.film import _write_upon
    from muster_physics.film.scenery import FilmScene

    with FilmScene(footage, 960, 540) as scene:
        blank = scene.picture(3.0)
        written = blank.copy()
        _write_upon(written, scene, footage, 3.0, 1.0)
    changed = np.abs(written.astype(int) - blank).max(axis=2) > 40
    assert changed[:60, :300].sum() > 300  # clock and name
    assert changed[:30, 800:].sum() > 100  # `idle fails`
    assert not changed[80:].any()


def test_the_speed_that_is_chosen_makes_no_film_longer_than_24_s():
    from muster_physics.film import speed_for

    assert [speed_for(seconds) for seconds in (3, 24, 24.1, 310.9, 2399, 2401, 9000)] == [1, 1, 1.5, 15, 100, 200, 400]


def test_moments_between_two_looks_are_between(footage):
    from muster_physics.film.interpolation import RunInterpolation

    moments = RunInterpolation(footage)
    early, late = moments.poses[20], moments.poses[21]
    between = moments.at((moments.times_s[20] + moments.times_s[21]) / 2)
    np.testing.assert_allclose(between[:, :3], (early[:, :3] + late[:, :3]) / 2, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(between[:, 3:], axis=1), 1.0)
    np.testing.assert_allclose(moments.at(0.0)[:, :3], moments.poses[0, :, :3])


@pytest.mark.long
def test_a_still_shows_the_end_from_above(footage, tmp_path):
    import cv2

    from muster_physics.film import write_still

    write_still(tmp_path / "end.png", footage)
    picture = cv2.imread(str(tmp_path / "end.png"))[:, :, ::-1].astype(float)
    blue = (picture @ hue(color_of(0)) / np.linalg.norm(picture, axis=2)) > 0.99
    green = (picture @ hue(color_of(2)) / np.linalg.norm(picture, axis=2)) > 0.99
    assert blue.sum() > 500
    assert np.nonzero(blue)[1].mean() < np.nonzero(green)[1].mean()  # the rover ends west of `idle`
    assert np.nonzero(blue)[0].mean() > np.nonzero(green)[0].mean()  # and south of it


@pytest.mark.long
def test_interrupted_a_film_is_whole_up_to_then(footage, tmp_path, monkeypatch):
    from muster_physics.film import film, write_film

    made = film._pictures

    def interrupted(*given):
        for k, picture in enumerate(made(*given)):
            if k == 5:
                raise KeyboardInterrupt
            yield picture

    monkeypatch.setattr(film, "_pictures", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_film(tmp_path / "film.mp4", footage, speed=40)
    assert len(frames_of(tmp_path / "film.mp4")) == 5


def test_who_joins_is_not_there_before():
    from tests.simulation.scenes import mission, robot

    from muster_physics import PhysicsWorld
    from muster_physics.film import Footage

    filled = Footage(mission(robot(position=(0.0, 0.0), radius_m=0.3)))
    world = PhysicsWorld(filled.mission, observer=filled.on_step)
    filled.on_world(world)
    world.step()
    world.join(robot("late", (1.0, 1.0), radius_m=0.3))
    world.step()
    assert np.isnan(filled.poses[0, 1]).all()
    assert np.isfinite(filled.poses[-1]).all()


def test_two_renderers_of_different_sizes_draw_by_turns(footage):
    """As a film and robots' cameras do."""
    from muster_physics.rendering import Renderer

    with Renderer(footage.world, 320, 240) as one, Renderer(footage.world, 64, 48) as other:
        first = one.seen_from_above((2.0, 2.0), 8.0)
        assert other.seen_from_above((2.0, 2.0), 8.0).shape == (48, 64, 3)
        np.testing.assert_array_equal(one.seen_from_above((2.0, 2.0), 8.0), first)


@pytest.mark.parametrize("name", ["film.avi", "film"])
def test_another_ending(footage, tmp_path, name):
    from muster_physics.film import write_film

    with pytest.raises(InputError, match=r"expected .mp4 or .gif"):
        write_film(tmp_path / name, footage)


def test_a_world_without_bodies(short):
    from muster.simulation import KinematicWorld
    from muster_physics.film import Footage

    with pytest.raises(ParameterError, match="KinematicWorld; expected the physics world"):
        Footage(short).on_world(KinematicWorld(short))


def test_a_folder_that_is_not_there(footage, tmp_path):
    from muster_physics.film import write_film

    with pytest.raises(InputError, match="cannot be written"):
        write_film(tmp_path / "no" / "film.mp4", footage, speed=40)


def test_a_trail_goes_as_far_as_the_robot_went_and_came_back():
    from muster_physics.film.ground_marks import _bends

    out = np.linspace(0, 9.3, 94)
    way = np.column_stack([np.concatenate([out, out[::-1]]), np.zeros(188), np.zeros(188)])
    kept = np.array([place for _, place in _bends(way, 1.0, 100)])
    assert kept[:, 0].max() == pytest.approx(9.3, abs=0.11)
    corner = np.array([(x, 0, 0) for x in np.arange(0, 3, 0.1)] + [(3, y, 0) for y in np.arange(0, 3, 0.1)])
    places = np.array([place for _, place in _bends(corner, 1.0, 100)])
    assert np.linalg.norm(places - (3, 0, 0), axis=1).min() < 0.11
