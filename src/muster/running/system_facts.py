"""What was found of the system that Muster runs on: processors and their limits, and programs that parts of it need."""

from __future__ import annotations

import math
import os
import platform
import shutil
import sys
from collections.abc import Mapping
from ctypes.util import find_library
from dataclasses import dataclass
from pathlib import Path

from muster.mission.system.platforms import usable_processors

_BROWSERS = ("chromium", "chromium-browser", "google-chrome")


@dataclass(frozen=True, kw_only=True)
class Processors:
    """Processors of the machine; those that this process may use; and how many its group is allowed, None: all."""

    machine: int
    usable: int
    group_limit: float | None


@dataclass(frozen=True)
class Found:
    """A program or library: where it is, None if it was not found; and what needs it."""

    name: str
    where: str | None
    needed_for: str


def system() -> str:
    """The operating system and the processor's kind, in one line."""
    return f"{platform.system()} {platform.release()}, {platform.machine()}"


def python() -> str:
    """The Python that runs this, and where it is."""
    return f"{platform.python_implementation()} {platform.python_version()} ({sys.executable})"


def processors() -> Processors:
    """How many processors there are."""
    return Processors(machine=os.cpu_count() or 1, usable=usable_processors(), group_limit=group_limit())


def group_limit(root: Path = Path("/")) -> float | None:
    """The processors that the control group of this process allows (cgroups 2, then 1), as containers set it.

    The least limit of all groups around it holds. None where there is none, or no such groups.
    """
    limits = [_quota_2(group / "cpu.max") for group in _groups(root)]
    limits.append(_quota_1(root / "sys/fs/cgroup/cpu"))
    least = min((limit for limit in limits if limit is not None), default=math.inf)
    return None if math.isinf(least) else least


def _groups(root: Path) -> list[Path]:
    """The folders of this process's group and of all around it."""
    mount = root / "sys/fs/cgroup"
    own = next((line[3:] for line in _lines(root / "proc/self/cgroup") if line.startswith("0::")), "/")
    parts = Path(own).parts[1:]
    return [mount.joinpath(*parts[:k]) for k in range(len(parts), -1, -1)]


def _quota_2(file: Path) -> float | None:
    words = " ".join(_lines(file)).split()
    return int(words[0]) / int(words[1]) if len(words) == 2 and words[0] != "max" else None


def _quota_1(folder: Path) -> float | None:
    quota, period = (" ".join(_lines(folder / f"cpu.cfs_{name}_us")) for name in ("quota", "period"))
    return int(quota) / int(period) if quota and period and int(quota) > 0 else None


def _lines(file: Path) -> list[str]:
    try:
        return file.read_text(encoding="ascii").splitlines()
    except OSError:
        return []


def programs(environment: Mapping[str, str] = os.environ) -> tuple[Found, ...]:
    """Programs and libraries beside Python's packages that parts of Muster use, found or not."""
    browsers = (environment.get("MUSTER_BROWSER", ""), *_BROWSERS)
    return (
        Found("ROS 1", shutil.which("rosmaster"), "muster ros"),
        Found(
            "ROS 2",
            environment.get("ROS_DISTRO") or _folder("/opt/ros") or shutil.which("ros2"),
            "tools beside muster ros2",
        ),
        Found("Gazebo", shutil.which("gz") or shutil.which("gazebo"), "a simulator of its own; Muster brings MuJoCo"),
        Found("PX4 or ArduPilot", shutil.which("px4") or shutil.which("arducopter"), "simulated drones of muster fly"),
        Found(
            "browser", next(filter(None, map(shutil.which, filter(None, browsers))), None), "films and tests of pages"
        ),
        Found("graphics library", find_library("EGL") or find_library("OSMesa"), "pictures of the physics world"),
        Found("PostgreSQL", shutil.which("psql"), "mission control on PostgreSQL"),
    )


def _folder(name: str) -> str | None:
    folder = Path(name)
    return ", ".join(sorted(str(inside) for inside in folder.iterdir())) or None if folder.is_dir() else None
