"""Perception is not imported without being used, and its optional parts not before they are needed."""

import subprocess
import sys

SCRIPT = """
import sys
import muster
assert not [name for name in sys.modules if name.startswith("muster.perception")]
from muster.perception import camera, clusters, detection
from muster.perception.cameras import calibration, images
from muster.perception import camera_observer, localisation, matching, points_of_interest, tags
loaded = {name.split(".")[0] for name in sys.modules}
print(*sorted(loaded & {"cv2", "apriltag", "scipy", "mujoco", "matplotlib"}))
"""


def test_importing_is_light():
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
