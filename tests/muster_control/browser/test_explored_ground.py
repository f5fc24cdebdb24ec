"""The map that robots have built, as the live page draws it: haze over what was not seen, and obstacles."""

from base64 import b64encode
from importlib.resources import files

SCRIPT = files("muster_control.pages.live").joinpath("js", "explored.js").read_text(encoding="utf-8")
MODULE = "data:text/javascript;base64," + b64encode(SCRIPT.encode()).decode()
DRAWN = """async ([script, origin]) => {
  const { ExploredGround } = await import(script);
  const canvas = new OffscreenCanvas(40, 30);
  const context = canvas.getContext("2d");
  const view = { scale: 10, x: (metres) => metres * 10, y: (metres) => 30 - metres * 10 };
  const ground = new ExploredGround();
  const explored = { cell: 1, origin, rows: [[0, 1, 2], [1, 1, 1]], grown: 1 };
  ground.draw(context, view, explored);
  const at = (x, y) => context.getImageData(view.x(x), view.y(y), 1, 1).data[3];
  const before = [at(0.5, 0.5), at(1.5, 0.5), at(2.5, 0.5), at(0.5, 1.5), at(-1.5, 1.5)];
  Object.assign(explored, { rows: [[1, 1, 2], [1, 1, 1]], grown: 2 });
  context.clearRect(0, 0, 40, 30);
  ground.draw(context, view, explored);
  return [...before, at(0.5, 0.5)];
}"""


def test_cells_lie_where_the_map_has_them_and_change_as_it_grows(chromium):
    page = chromium.new_page()
    unseen, free, obstacle, above, outside, seen_later = page.evaluate(DRAWN, [MODULE, [0, 0, 0]])
    page.close()
    assert 0 < unseen < obstacle
    assert [free, above, outside, seen_later] == [0, 0, 0, 0]
