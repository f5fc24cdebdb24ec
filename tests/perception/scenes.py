"""Pictures of tags, drawn by the homography from each tag's picture to the camera's: no renderer, no physics."""

import cv2
import numpy as np

from muster.motion.frames import moved, pose_transform
from muster.perception.camera import RB5_MOUNT, Intrinsics, View
from muster.perception.tags import CELLS, CELLS_OF_PICTURE, CORNERS, tag_image

FINER = 4
VGA = Intrinsics.of_view(640, 480, np.radians(60))
ON_GROUND = pose_transform([0.0, 0.0, 0.0, np.pi, 0.0, 0.0])
"""Of a tag that lies on the ground, its picture's x to the east: y of the tag is south, z down."""


def tag_pose(x, y, turned=0.0, z=0.0):
    """The pose of a tag that lies face up at (x, y, z)."""
    return pose_transform([x, y, z, 0.0, 0.0, turned]) @ ON_GROUND


def over(x, y, z, yaw=0.0, mount=RB5_MOUNT, intrinsics=VGA):
    """What the thesis' drone sees, level at a place."""
    return View.from_body(intrinsics, [x, y, z, 0.0, 0.0, yaw], mount)


def corners_in_map(pose, size_m):
    return moved(pose, CORNERS * size_m)


def drawn(view, tags, size_m=0.5, *, floor=110, noise=0.0, blur=0.0, seed=0):
    """The picture (height, width), uint8, of `tags`: pairs of id and pose (4, 4). All must be before the camera."""
    width, height = view.intrinsics.width, view.intrinsics.height
    fine = np.full((height * FINER, width * FINER), floor, dtype=np.uint8)
    for tag, pose in tags:
        picture = tag_image(tag, 16)
        side = picture.shape[0]
        ends = np.array([[0, 0], [side, 0], [side, side], [0, side]], dtype=np.float32)
        at = view.project(corners_in_map(pose, size_m * CELLS_OF_PICTURE / CELLS)) * FINER
        # OpenCV counts from the middle of the first pixel, Muster from its corner
        taken = cv2.getPerspectiveTransform(ends - 0.5, (at - 0.5).astype(np.float32))
        cv2.warpPerspective(
            picture, taken, fine.shape[::-1], dst=fine, flags=cv2.INTER_AREA, borderMode=cv2.BORDER_TRANSPARENT
        )
    image = cv2.resize(fine, (width, height), interpolation=cv2.INTER_AREA).astype(float)
    if blur:
        image = cv2.GaussianBlur(image, (0, 0), blur)
    image += np.random.default_rng(seed).normal(0, noise, image.shape)
    return np.clip(np.round(image), 0, 255).astype(np.uint8)
