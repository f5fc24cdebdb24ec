"""What a world declares of itself to those that make it by name, before it is made."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING, Protocol, TypeVar

from muster.mission.system.plugins import declaring, require_words
from muster.motion.laws import PROFILE
from muster.simulation.energy import LACKS_ENERGY

if TYPE_CHECKING:
    from muster.mission.model import Mission
    from muster.motion.grid import Floats
    from muster.perception.camera import Intrinsics
    from muster.perception.cameras.images import Image

EXACT, BODIES = ABILITIES = ("exact", "bodies")
"""What a world may be able to do: move robots exactly as commanded where there is no noise; show their bodies in films
and stills."""
SETTINGS: Mapping[str, str] = {
    "law": f"expected {PROFILE}: the world {{world}} has no other",
    "wind": "expected none: the world {world} has no wind; {others} has",
    **LACKS_ENERGY,
    "rotor_level": "expected the world {others}: {world} has no rotors",
    "snapshot": "expected none: the world {world} cannot be resumed",
}
"""Keyword arguments that worlds may take beside those of all, and what is said of one that does not, if `others` do."""

M = TypeVar("M", bound=Callable[..., object])


class PlacedCamera(Protocol):
    """A camera that is put anywhere in a mission's world, and draws what it sees there."""

    def image(self, body: Floats, mount: Floats) -> Image:
        """Return the picture from a body's pose (4, 4) with the camera at the pose `mount` (4, 4) on it."""
        ...


MakePlacedCamera = Callable[["Mission", "Intrinsics"], PlacedCamera]


def declares(
    *, settings: Collection[str], abilities: Collection[str] = (), placed_camera: MakePlacedCamera | None = None
) -> Callable[[M], M]:
    """Declare what a class or function that makes a world takes, and what the world can do.

    Parameters
    ----------
    settings : collection of str
        Which of `SETTINGS` it takes. Without a declaration they are those in its signature.
    abilities : collection of str, optional
        Which of `ABILITIES` the world has.
    placed_camera : callable, optional
        Returns a camera of given intrinsics in the world of a mission: the cameras of the world have pictures.
    """
    require_words("settings", settings, SETTINGS)
    require_words("abilities", abilities, ABILITIES)
    return declaring(settings=frozenset(settings), abilities=frozenset(abilities), placed_camera=placed_camera)
