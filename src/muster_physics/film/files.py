"""Film files: MP4 (VP9, which browsers play) by OpenCV, GIF by Pillow; and single pictures, PNG."""

from __future__ import annotations

import zlib
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any, ClassVar, Protocol

import cv2
import numpy as np

from muster.mission.errors import Finding, InputError
from muster.mission.system.extras import needs_extra
from muster.report.styles import ALARM, LEFT_OUT, PALETTE
from muster_physics.film.captions import Picture, rgb

CODEC = "vp09"
COLORS = 128


class FilmFile(Protocol):
    """A film file to which pictures are added one by one."""

    size: ClassVar[tuple[int, int]]
    """Width and height of its pictures, in pixels."""
    rate_hz: ClassVar[float]
    """Pictures in a second."""

    def __init__(self, path: str | Path) -> None: ...

    def add(self, picture: Picture) -> None:
        """Add a picture, RGB."""
        ...

    def close(self) -> None:
        """Complete the file."""
        ...


class Mp4:
    """Raises InputError if the file cannot be written."""

    size: ClassVar[tuple[int, int]] = (960, 540)
    rate_hz: ClassVar[float] = 25.0

    def __init__(self, path: str | Path) -> None:
        self._writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, _fourcc(), self.rate_hz, self.size)
        if not self._writer.isOpened():
            raise unwritable(path)
        self._worker = ThreadPoolExecutor(max_workers=1)  # encodes a picture while the next one is drawn
        self._last: Future[None] | None = None

    def add(self, picture: Picture) -> None:
        if self._last is not None:
            self._last.result()
        self._last = self._worker.submit(self._encode, picture)

    def _encode(self, picture: Picture) -> None:
        self._writer.write(cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))

    def close(self) -> None:
        self._worker.shutdown()
        self._writer.release()


class Gif:
    """Raises InputError if the file cannot be written, MissingExtraError if Pillow is not installed."""

    size: ClassVar[tuple[int, int]] = (640, 360)
    rate_hz: ClassVar[float] = 12.5

    def __init__(self, path: str | Path) -> None:
        require_pillow()
        self._path = Path(path)
        self._pictures: list[bytes] = []  # compressed: a long film is many

    def add(self, picture: Picture) -> None:
        from PIL import Image

        if not self._pictures:
            self._palette = Image.fromarray(np.concatenate([picture, _swatches(picture.shape[1])])).quantize(COLORS)
        image = Image.fromarray(picture).quantize(palette=self._palette, dither=Image.Dither.NONE)
        self._pictures.append(zlib.compress(image.tobytes(), 1))

    def close(self) -> None:
        if not self._pictures:
            return
        first, others = self._image(self._pictures[0]), map(self._image, self._pictures[1:])
        try:
            first.save(self._path, append_images=others, save_all=True, duration=round(1000 / self.rate_hz), loop=0)
        except OSError as error:
            raise unwritable(self._path) from error

    def _image(self, data: bytes) -> Any:
        from PIL import Image

        image = Image.frombytes("P", self.size, zlib.decompress(data))
        image.putpalette(self._palette.getpalette() or [])
        return image


KINDS: dict[str, type[FilmFile]] = {".mp4": Mp4, ".gif": Gif}


def film_file(path: str | Path) -> type[FilmFile]:
    """A film file of the kind that its path's suffix states.

    Raises
    ------
    InputError
        if there is no such kind.
    """
    check_ending(path, tuple(KINDS))
    return KINDS[Path(path).suffix.lower()]


def check_ending(path: str | Path, known: tuple[str, ...]) -> None:
    """Raise InputError unless a path ends in one of these; to be asked before a run, not after."""
    suffix = Path(path).suffix
    if suffix.lower() not in known:
        value = f"suffix {suffix!r}" if suffix else "no suffix"
        raise InputError([Finding(str(path), None, "", value, " or ".join(known))])


def check_film(path: str | Path) -> None:
    """Raise InputError unless a film can have this ending, MissingExtraError if it needs Pillow that is not there."""
    if film_file(path) is Gif:
        require_pillow()


def check_still(path: str | Path) -> None:
    """Raise InputError unless a still can have this ending."""
    check_ending(path, (".png",))


def write_png(path: str | Path, picture: Picture) -> None:
    """Write one picture, RGB.

    Raises
    ------
    InputError
        if the ending is not .png, or the file cannot be written.
    """
    check_still(path)
    whole, data = cv2.imencode(".png", cv2.cvtColor(picture, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_PNG_COMPRESSION, 9])
    assert whole
    try:
        Path(path).write_bytes(data.tobytes())
    except OSError as error:
        raise unwritable(path) from error


def require_pillow() -> None:
    """Raise MissingExtraError where Pillow is not installed."""
    with needs_extra("map", "a GIF"):
        import PIL  # noqa: F401


def _swatches(width: int) -> Picture:
    """Stripes of all colours that may occur later in a film, full and pale, for its palette."""
    colors = np.array([rgb(color) for color in (*PALETTE, ALARM, LEFT_OUT)], dtype=np.float64)
    shades = np.concatenate([colors, 0.7 * colors + 0.3 * 255, 0.4 * colors + 0.6 * 255])
    return np.repeat(np.repeat(shades[:, None, :], width, axis=1), 4, axis=0).astype(np.uint8)


def _fourcc() -> int:
    return int(cv2.VideoWriter.fourcc(*CODEC))


def unwritable(path: str | Path) -> InputError:
    return InputError([Finding(str(path), None, "", "cannot be written", "a path that can be written")])
