"""The generators by name, including those of installed packages."""

from __future__ import annotations

from muster.generation.generator import Generator
from muster.mission.system.plugins import Registry, instance_expected

GENERATORS: Registry[Generator] = Registry("generator", "muster.generators", instance_expected(Generator))
