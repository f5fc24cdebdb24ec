"""Small missions with goods, batteries and stations, and plans of them, in few words."""

from dataclasses import replace

from muster.mission.model import Battery, Mission, Robot, Rules, Station, Task
from muster.mission.plan import Plan, Route, RouteStop
from muster.verification import verify


def robot(name="r", x=0.0, **keys):
    return Robot(id=name, position=(x, 0), **keys)


def task(name, x=0.0, **keys):
    return Task(id=name, position=(x, 0), **keys)


def charger(name="dock", x=0.0, rate=1.0, **keys):
    return Station(id=name, position=(x, 0), services=("charge",), charge_per_s=rate, **keys)


def swapper(name="rack", x=0.0, swap_s=60.0, **keys):
    return Station(id=name, position=(x, 0), services=("swap",), swap_s=swap_s, **keys)


def depot(name="depot", x=0.0, **keys):
    return Station(id=name, position=(x, 0), services=("unload",), **keys)


def battery(capacity, at_start=1.0, reserve=0.0):
    return Battery(capacity=capacity, at_start=at_start, reserve=reserve)


def mission(robots, tasks=(), stations=(), **rules):
    return Mission(name="m", rules=Rules(**rules), robots=tuple(robots), tasks=tuple(tasks), stations=tuple(stations))


def plan(**routes):
    """A plan that says nothing but its routes, each in words."""
    return Plan(routes=tuple(Route(name, tuple(text.split())) for name, text in routes.items()))


def judged(given, ignore=(), **routes):
    return verify(given, plan(**routes), ignore)


def faults(verdict):
    return [(found.kind, found.robot, found.task, found.detail) for found in verdict.violations]


def kinds(verdict):
    return [found.kind for found in verdict.violations]


def stops(verdict, name="r"):
    return next(route.stops for route in verdict.routes if route.robot == name)


def times(verdict, name="r"):
    """(name, arrives, starts, ends) of each stop of a robot."""
    return [(stop.name, stop.arrives_s, stop.starts_s, stop.ends_s) for stop in stops(verdict, name)]


def levels(verdict, name="r"):
    """(name, on arrival, after) of each stop of a robot."""
    return [(stop.name, stop.arrival_level, stop.level_after) for stop in stops(verdict, name)]


def loads(verdict, name="r"):
    return [dict(stop.load_after) for stop in stops(verdict, name)]


def stating(given, bare, ignore=(), *, charged=False):
    """The plan with the stops that the judge finds; with `charged` the amounts too."""
    verdict = verify(given, bare, ignore)
    found = {route.robot: route.stops for route in verdict.routes}
    return replace(
        bare,
        routes=tuple(replace(r, stops=tuple(_stated(stop, charged) for stop in found[r.robot])) for r in bare.routes),
    )


def _stated(stop, charged):
    amount = stop.charged if charged else None
    return RouteStop(stop.name, stop.arrives_s, stop.starts_s, stop.ends_s, stop.is_station, amount)


def charging(bare, *amounts):
    """The plan of one robot with the amounts that it charges stop by stop; times are of no meaning."""
    (route,) = bare.routes
    at = zip(route.tasks, amounts, strict=True)
    made = tuple(RouteStop(name, 0, 0, 0, amount is not None, amount) for name, amount in at)
    return replace(bare, routes=(replace(route, stops=made),))
