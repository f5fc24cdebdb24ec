"""Films and stills of the physics world. Importing it without the extra `physics`: MissingExtraError."""

from muster.perception.optional_parts import require_physics

require_physics("the physics world", "mujoco")

from muster_physics.film.files import check_film, check_still  # noqa: E402
from muster_physics.film.film import FilmSummary, speed_for, write_film  # noqa: E402 (OpenCV comes with it)
from muster_physics.film.footage import Footage  # noqa: E402
from muster_physics.film.still import write_still  # noqa: E402

__all__ = ["FilmSummary", "Footage", "check_film", "check_still", "speed_for", "write_film", "write_still"]
