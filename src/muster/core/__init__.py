"""The hot loops, in C++20. A verb here has the name of the step that it carries out.

Called from `allocation`, `motion`, `simulation` and `traffic` alone. The stub of the extension says what there is.
"""

from muster.core._core import *  # noqa: F403
