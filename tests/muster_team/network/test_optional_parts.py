"""Without the extra `net` one line says what to install."""

import pytest

from muster.mission.errors import MissingExtraError
from muster_team.network import optional_parts as extra
from muster_team.network.codec import Codec
from muster_team.network.encryption import Seal
from muster_team.network.zenoh_transport import ZenohTransport


@pytest.mark.parametrize(
    ("made", "module"),
    [
        (lambda: Codec(("r_0",), ("t_0",)), "msgpack"),
        (lambda: Seal(bytes(32), b"mission", "r_0", 1), "cryptography"),
        (lambda: ZenohTransport("mission", "r_0"), "zenoh"),
    ],
)
def test_what_to_install_is_told(monkeypatch, made, module):
    monkeypatch.setattr(extra, "find_spec", lambda name: None if name == module else "there")
    with pytest.raises(MissingExtraError, match=r"needs an optional part: pip install 'muster-robotics\[net\]'"):
        made()
