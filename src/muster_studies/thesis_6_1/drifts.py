"""Table A6.1: how far a drone's estimate drifts from the truth, with and without fixes ([tcf-thesis], Appendix A6)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from statistics import fmean

from muster.perception.drift import Bias, Drift, air_drift, published_flight
from muster.perception.errors import AirErrors
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table, row
from muster_studies.thesis_6_1.flights import Flight, FlightResult
from muster_studies.thesis_6_1.published import seed_count

STEP_S, FIX_EVERY_S = 0.1, 1.0
BIAS = Bias(scale=0.005, drift_mps=0.001)
MEASURED_M = "0.15 to 0.5"
"""The thesis' errors, by visual inertial odometry without fixes."""
SENSORS = {"odometry": "odometry", "inertial": "and inertial unit", "fixes": "and a fix each second"}


@cache
def drift(seed: int) -> Drift:
    """One flight around the setpoints of Table A.21."""
    return air_drift(published_flight(), STEP_S, AirErrors(), BIAS, fix_every_s=FIX_EVERY_S, seed=seed)


@dataclass(frozen=True)
class Drifts:
    """A row for each set of sensors."""

    number: str = "A6.1"
    columns: tuple[str, ...] = ("sensors", "mean error", "greatest", "at the end", "% of the way")

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        """None: nothing is flown among tags."""
        yield from ()

    def table(self, effort: Effort, results: Mapping[Flight, FlightResult]) -> Table:
        drifts = [drift(seed) for seed in range(seed_count(effort))]
        rows = [row(self.columns, {"sensors": name} | _errors(drifts, which)) for which, name in SENSORS.items()]
        rows.append(row(self.columns, {"sensors": "thesis, in truth", "greatest": MEASURED_M}))
        way = drifts[0].travelled[-1]
        notes = (
            f"Five passes around the setpoints of Table A.21, {way:.1f} m; means over {len(drifts)} seeds, metres. The "
            "thesis measured visual inertial odometry, without fixes, by motion capture.",
            f"Errors are ours, not printed: odometry of {AirErrors().velocity_mps} m/s, {100 * BIAS.scale:g} % too "
            f"much and {BIAS.drift_mps} m/s beside; fixes of {AirErrors().position_m} m. So the order of size compares "
            "with the thesis, no more. Only with fixes errors stay bounded.",
        )
        return Table(self.number, "How a drone's estimate drifts", self.columns, tuple(rows), notes, decimals=3)


def _errors(drifts: list[Drift], which: str) -> dict[str, Cell]:
    errors = [getattr(one, which) for one in drifts]
    return {
        "mean error": fmean(float(each.mean()) for each in errors),
        "greatest": fmean(float(each.max()) for each in errors),
        "at the end": fmean(float(each[-1]) for each in errors),
        "% of the way": 100 * fmean(one.share(each) for one, each in zip(drifts, errors, strict=True)),
    }
