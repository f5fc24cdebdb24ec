"""The AprilTag library behind pupil-apriltags, with a detector that may be deleted.

As it comes (1.0.4.post11), deleting a detector frees its family first and then lets the library look into that: memory
is corrupted, and the process crashes sooner or later. Here the detector goes first.
"""

from __future__ import annotations

from typing import Any

from muster.perception.optional_parts import require_physics

FAMILY = "tag36h11"


def new_detector(purpose: str, **parameters: float) -> Any:
    """A `pupil_apriltags.Detector` of the family 36h11.

    Raises
    ------
    MissingExtraError
        if pupil-apriltags is not installed; it names `purpose`.
    """
    require_physics(purpose, "pupil_apriltags")
    from pupil_apriltags import Detector

    class DeletableDetector(Detector):  # type: ignore[misc]
        def __del__(self) -> None:
            made = self.__dict__
            if made.get("tag_detector_ptr") is None:
                return
            library, detector, families = made["libc"], made.pop("tag_detector_ptr"), made["tag_families"]
            library.apriltag_detector_destroy.restype = library.tag36h11_destroy.restype = None
            library.apriltag_detector_destroy(detector)
            for family in families.values():
                library.tag36h11_destroy(family)

    return DeletableDetector(families=FAMILY, **parameters)
