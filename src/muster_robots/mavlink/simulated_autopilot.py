"""The simulated autopilot behind a UDP socket: `python -m muster_robots.mavlink.simulated_autopilot --port 14550`.

It speaks to a port, as a real one does, at which `muster fly --endpoint r_0=udp:127.0.0.1:14550` listens.
"""

from __future__ import annotations

import argparse
import socket
import time
from collections.abc import Callable
from dataclasses import fields

from muster.mission.errors import ParameterError
from muster.mission.model import Origin
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.simulated.drone import SimulatedAutopilot
from muster_robots.mavlink.simulated.faults import Faults

_STEP_S = 0.02
_MOST_S = 0.2
"""By so much the drone's time goes on at once: a simulator that stood still has not lost its link meanwhile."""


def serve(
    drone: SimulatedAutopilot,
    address: tuple[str, int],
    *,
    until: Callable[[], bool] = lambda: False,
    speed: float = 1.0,
) -> None:
    """Let a drone fly at `speed` times real time, and send to an address, until `until` is true."""
    drone_s, seen_s = 0.0, time.monotonic()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
        end.bind(("", 0))
        end.setblocking(False)
        while not until():
            try:
                while True:
                    drone.receive(end.recv(65535))
            except (BlockingIOError, ConnectionRefusedError):
                pass
            before_s, seen_s = seen_s, time.monotonic()
            drone_s += min(_MOST_S, (seen_s - before_s) * speed)
            for packet in drone.advance(drone_s):
                try:
                    end.sendto(packet, address)
                except ConnectionRefusedError:  # nobody listens yet
                    break
            time.sleep(_STEP_S / speed)


def faults_of(text: str) -> Faults:
    """`refuse_arm,loss=0.1,low_battery_at_s=5` as faults.

    Raises
    ------
    ParameterError
        for a fault that there is not, or without its number.
    """
    kinds = {field.name: field.type for field in fields(Faults)}
    values: dict[str, float | int | bool] = {}
    for part in filter(None, text.split(",")):
        name, _, amount = part.partition("=")
        try:
            if name not in kinds or (kinds[name] == "bool") == bool(amount):
                raise ValueError
            values[name] = True if not amount else int(amount) if name == "reject_item" else float(amount)
        except ValueError:
            raise ParameterError(
                f"--faults: {part}; expected of {', '.join(kinds)}, those of a number with it"
            ) from None
    return Faults(**values)  # type: ignore[arg-type]


def main() -> None:
    """Serve one drone until Ctrl-C."""
    parser = argparse.ArgumentParser(prog="python -m muster_robots.mavlink.simulated_autopilot", description=__doc__)
    parser.add_argument("--port", type=int, default=14550, help="UDP port on this machine to which it speaks")
    parser.add_argument("--kind", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument("--at", default="35.53,24.06", metavar="LAT,LON", help="degrees, where it is switched on")
    parser.add_argument("--system", type=int, default=1, help="its MAVLink system id")
    parser.add_argument("--faults", default="", metavar="NAME[=N],...", help=", ".join(f.name for f in fields(Faults)))
    parser.add_argument("--seed", type=int, default=0, help="of what is lost")
    given = parser.parse_args()
    try:
        lat, lon = (float(part) for part in given.at.split(","))
        origin, faults = Origin(lat_deg=lat, lon_deg=lon), faults_of(given.faults)
    except ValueError as error:  # a ParameterError is one
        parser.error(str(error) if isinstance(error, ParameterError) else f"--at: {given.at}; expected LAT,LON")
    kind = PX4 if given.kind == "px4" else ARDUPILOT
    drone = SimulatedAutopilot(kind, origin, faults, system=given.system, seed=given.seed)
    try:
        serve(drone, ("127.0.0.1", given.port))
    except KeyboardInterrupt:
        return


if __name__ == "__main__":
    main()
