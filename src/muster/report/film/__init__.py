"""Films and stills of the physics world. Importing it without the extra `physics`: MissingExtraError."""

from muster.perception.optional_parts import require_physics

require_physics("the physics world", "mujoco")

from muster.report.film.files import check_film, check_still  # noqa: E402
from muster.report.film.film import FilmSummary, speed_for, write_film  # noqa: E402 (OpenCV comes with it)
from muster.report.film.footage import Footage  # noqa: E402
from muster.report.film.still import write_still  # noqa: E402

__all__ = ["FilmSummary", "Footage", "check_film", "check_still", "speed_for", "write_film", "write_still"]
