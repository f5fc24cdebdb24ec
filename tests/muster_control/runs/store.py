"""A database with a plan in it, as runs need."""

import muster
from muster.mission.yaml_writer import yaml_text
from muster_control.contract import User
from muster_control.settings import Settings

ADA = User("ada", "command")
EVE = User("eve", "watch")


def planned(store, mission, **how):
    """The id of a plan of a mission."""
    version = store.missions.create(mission.name, yaml_text(mission), {}, {"name": mission.name}, "ada")
    plan = muster.solve(mission, **{"iterations": 100, **how})
    return store.plans.add(version.mission, version.version, "planned", "ada", plan.as_dict()).id


def settings_of(store, **more):
    """Of a server with this database of SQLite: files beside it are the test's own."""
    return Settings(database=f"sqlite:///{store.database.file}", **more)
