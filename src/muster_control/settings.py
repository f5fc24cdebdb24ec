"""The settings of a server: the options of `muster serve`."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from muster.mission.system.platforms import data_folder


def usual_database() -> str:
    """`muster.db` in the user's data folder."""
    return f"sqlite:///{data_folder() / 'muster.db'}"


@dataclass(frozen=True, kw_only=True)
class Settings:
    """The settings of a server.

    Parameters
    ----------
    host, port
        where it listens; port 0: any free one.
    database
        a URL of SQLAlchemy: `sqlite:///FILE` or `postgresql://USER@HOST/NAME`.
    workers, memory_mb, job_s
        how many processes plan at once, the memory of each and of each simulated run, and the longest time of one piece
        of work.
    queue
        how many jobs may wait.
    runs
        how many missions may be carried out at once.
    upload_bytes
        the largest body of a request.
    requests_per_s
        of one address, on average.
    tiles
        a folder of map tiles (`Z/X/Y.png`) to draw under missions on the earth.
    bridges
        worlds of real robots in which runs may be started here: `ros1`, `ros2`, `mavlink`.
    tokens
        a file of tokens with roles; None: no token is needed, which is allowed on loopback only.
    user_header, trusted_proxies, proxy_secret
        the header in which a reverse proxy names the user, the trusted addresses of proxies, and a file with the secret
        that the proxy must send.
    certificate, key
        of TLS.
    insecure_http
        whether to listen beyond loopback without TLS.
    public_origins
        origins (`https://control.example.org`) under which browsers reach this server through a proxy.
    sockets, sockets_per_address
        how many WebSockets may be open, in all and per address.
    """

    host: str = "127.0.0.1"
    port: int = 8117
    database: str = field(default_factory=usual_database)
    workers: int = field(default_factory=lambda: max(1, (os.cpu_count() or 2)))
    memory_mb: int = 2048
    job_s: float = 3600.0
    queue: int = 1000
    runs: int = 8
    upload_bytes: int = 16 * 2**20
    requests_per_s: float = 50.0
    tiles: Path | None = None
    bridges: tuple[str, ...] = ()
    tokens: Path | None = None
    user_header: str | None = None
    trusted_proxies: tuple[str, ...] = ()
    proxy_secret: Path | None = None
    certificate: Path | None = None
    key: Path | None = None
    insecure_http: bool = False
    public_origins: tuple[str, ...] = ()
    sockets: int = 1000
    sockets_per_address: int = 250
    log_format: Literal["text", "json"] = "text"

    @property
    def folder(self) -> Path:
        """The folder of further files: beside SQLite's database, or the user's data folder."""
        scheme, _, file = self.database.partition(":///")
        if scheme.startswith("sqlite") and file and file != ":memory:":
            return Path(file.partition("?")[0]).absolute().parent
        return data_folder()
