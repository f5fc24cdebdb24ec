"""Draws the floor plan that ships with Muster: `floor-plan.png` and, as ROS map_server has it, `floor-plan.yaml`.

A storage hall, a corridor and seven rooms, 40 m x 25 m, at 0.05 m a pixel. Everything is laid out here by hand but the
crates in the hall, which are strewn with a seed: the same call draws the same files.

    python tools/draw_floor.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path
from random import Random

import numpy as np
from PIL import Image

RESOLUTION_M = 0.05
MARGIN_M = 1.0  # of unknown ground around the building
WIDTH_M, HEIGHT_M = 40.0, 25.0
WALL_M, DOOR_M = 0.2, 1.3
OCCUPIED, UNKNOWN, FREE = 0, 205, 254  # the shades that map_saver writes

FOLDER = Path(__file__).parents[1] / "src" / "muster" / "library" / "maps"

WALLS = [  # (x, y) of both ends, on the middle of the wall
    *[((0, y), (40, y)) for y in (0, 11, 14, 25)],
    *[((x, 0), (x, 25)) for x in (0, 40)],
    *[((x, 0), (x, 11)) for x in (18, 26, 33)],
    *[((x, 14), (x, 25)) for x in (10, 20, 30)],
]
DOORS = [  # the middle of each
    *[(x, 11) for x in (5, 14, 22, 29, 37)],
    *[(x, 14) for x in (3, 13, 27, 36)],
    *[(x, 20) for x in (10, 20)],
    (18, 3),
    (30, 17.5),
]
SHELVES = [(2.5, 2 + 2.4 * k, 9.0, 0.8) for k in range(3)]  # (x, y) of the lower left corner, width, height
PILLARS = [(x, y, 0.4, 0.4) for x in (5.8, 11.8) for y in (0.9, 9.3)]
TABLES = [
    *[(x, 7.8, 1.6, 0.8) for x in (19.2, 23.0, 27.2, 30.4, 34.4)],
    *[(x, 1.2, 1.6, 0.8) for x in (20.4, 27.2, 30.4, 37.2)],
    *[(x, 22.6, 0.8, 1.6) for x in (1.2, 4.2, 7.2)],
    (13.0, 18.4, 4.0, 1.4),
    (22.8, 17.2, 4.4, 1.6),
    *[(32.4 + 2.4 * k, 22.8, 1.8, 1.0) for k in range(3)],
    (33.0, 18.0, 4.2, 1.2),
]
HALL_CRATES = (12.5, 1.0, 17.0, 8.5)  # the rectangle they lie in: x, y, x, y
CRATES, CRATE_M, SEED = 7, 0.6, 25


def draw() -> np.ndarray:
    """The floor as shades of grey (rows, columns), the top row first."""
    size = [round((side + 2 * MARGIN_M) / RESOLUTION_M) for side in (HEIGHT_M, WIDTH_M)]
    shades = np.full(size, UNKNOWN, dtype=np.uint8)
    fill(shades, (0, 0, WIDTH_M, HEIGHT_M), FREE)
    for (x0, y0), (x1, y1) in WALLS:
        fill(shades, (x0 - WALL_M / 2, y0 - WALL_M / 2, x1 - x0 + WALL_M, y1 - y0 + WALL_M), OCCUPIED)
    for x, y in DOORS:
        fill(
            shades,
            (x - DOOR_M / 2, y - WALL_M / 2, DOOR_M, WALL_M)
            if y in (11, 14)
            else (x - WALL_M / 2, y - DOOR_M / 2, WALL_M, DOOR_M),
            FREE,
        )
    for box in [*SHELVES, *PILLARS, *TABLES, *crates()]:
        fill(shades, box, OCCUPIED)
    return shades[::-1]


def crates() -> list[tuple[float, float, float, float]]:
    """Crates on the open floor of the hall, none nearer than 1.5 m to another."""
    random, found = Random(SEED), []
    west, south, east, north = HALL_CRATES
    while len(found) < CRATES:
        x, y = random.uniform(west, east - CRATE_M), random.uniform(south, north - CRATE_M)
        if all((x - a) ** 2 + (y - b) ** 2 > (CRATE_M + 1.5) ** 2 for a, b, *_ in found):
            found.append((x, y, CRATE_M, CRATE_M))
    return found


def fill(shades: np.ndarray, box: tuple[float, float, float, float], shade: int) -> None:
    """Fill a box (x, y, width, height), metres in the map frame; row 0 is the lowest here."""
    x, y, width, height = box
    columns = slice(*(round((c + MARGIN_M) / RESOLUTION_M) for c in (x, x + width)))
    rows = slice(*(round((c + MARGIN_M) / RESOLUTION_M) for c in (y, y + height)))
    shades[rows, columns] = shade


TEXT = f"""\
# Drawn by tools/draw_floor.py.
image: floor-plan.png
mode: trinary
resolution: {RESOLUTION_M}
origin: [{-MARGIN_M}, {-MARGIN_M}, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


def main(folder: Path) -> None:
    """Write both files into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    Image.fromarray(draw()).save(folder / "floor-plan.png", optimize=True)
    (folder / "floor-plan.yaml").write_text(TEXT, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
