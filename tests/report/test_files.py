import subprocess
import sys
import xml.etree.ElementTree as ET

import pytest

from muster.mission.errors import InputError
from muster.report import plot_gantt, plot_routes, save_figure
from muster.report.figures.files import check_suffix


@pytest.mark.long
def test_png_shows_the_robots_colour_and_is_mostly_white(mission, plan, verdict, tmp_path):
    from matplotlib.image import imread

    save_figure(plot_routes(mission, plan, verdict), tmp_path / "routes.png")
    pixels = (imread(tmp_path / "routes.png")[..., :3] * 255).round().astype(int)
    assert min(pixels.shape[:2]) > 500  # inches at 150 dots
    assert (pixels == (0x00, 0x72, 0xB2)).all(axis=2).sum() > 500
    assert (pixels == 255).all(axis=2).mean() > 0.8


def test_svg_holds_the_routes_by_name(mission, plan, verdict, tmp_path):
    save_figure(plot_routes(mission, plan, verdict), tmp_path / "routes.svg")
    ids = [element.get("id") for element in ET.parse(tmp_path / "routes.svg").iter() if element.get("id")]
    assert {"travel-ada", "travel-bob", "end-bob", "left-out", "order-a", "name-e"} <= set(ids)
    assert len(set(ids)) == len(ids)


def test_pdf(mission, plan, verdict, tmp_path):
    save_figure(plot_gantt(mission, verdict), tmp_path / "gantt.pdf")
    data = (tmp_path / "gantt.pdf").read_bytes()
    assert data.startswith(b"%PDF-")
    assert b"/CreationDate" not in data


@pytest.mark.long
@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_the_same_picture_gives_the_same_bytes(mission, plan, verdict, tmp_path, suffix):
    for name in ("one", "two"):
        save_figure(plot_routes(mission, plan, verdict), tmp_path / f"{name}.{suffix}")
    assert (tmp_path / f"one.{suffix}").read_bytes() == (tmp_path / f"two.{suffix}").read_bytes()


@pytest.mark.long
def test_figures_and_axes_of_subfigures_are_written_whole(mission, plan, verdict, tmp_path):
    from matplotlib.figure import Figure
    from matplotlib.image import imread

    figure = Figure(figsize=(12, 4), layout="constrained")
    left, right = figure.subfigures(1, 2)
    plot_gantt(mission, verdict, ax=left.add_subplot())
    ax = plot_routes(mission, plan, verdict, ax=right.add_subplot())
    for picture, name in ((ax, "axes.PNG"), (figure, "figure.png")):
        save_figure(picture, tmp_path / name)
        assert imread(tmp_path / name, format="png").shape[1] > 1500  # 12 inches at 150 dots are 1800


@pytest.mark.parametrize(
    ("name", "said"), [("plot.bmp", "suffix '.bmp'"), ("plot", "no suffix"), ("a.png.gz", "'.gz'")]
)
def test_an_unknown_suffix_is_refused_in_one_line(name, said, mission, plan, verdict, tmp_path):
    with pytest.raises(InputError) as caught:
        save_figure(plot_gantt(mission, verdict), tmp_path / name)
    assert said in str(caught.value)
    assert str(caught.value).endswith("expected one of .png, .svg, .pdf")
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_the_suffix_can_be_checked_before_there_is_a_picture(tmp_path):
    check_suffix(tmp_path / "a.SVG")
    with pytest.raises(InputError):
        check_suffix(tmp_path / "a.jpg")


def test_a_path_that_cannot_be_written_is_one_line(mission, plan, verdict, tmp_path):
    path = tmp_path / "nowhere" / "plot.png"
    with pytest.raises(InputError) as caught:
        save_figure(plot_gantt(mission, verdict), path)
    assert str(caught.value) == f"{path}: No such file or directory; expected a path that can be written"


@pytest.mark.long
def test_importing_report_does_not_import_matplotlib_and_drawing_not_pyplot():
    code = """
import sys
import muster.report
assert not [name for name in sys.modules if name.startswith(("matplotlib", "mpl_toolkits"))]
from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan
from muster.verification import verify
mission = Mission(robots=[Robot(id="r", position=(0, 0, 0))], tasks=[Task(id="t", position=(1, 1, 1))])
verdict = verify(mission, Plan(routes=()))
muster.report.plot_routes(mission, Plan(routes=()), verdict)
muster.report.plot_gantt(mission, verdict)
assert "matplotlib.pyplot" not in sys.modules
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
