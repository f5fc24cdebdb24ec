"""Several files as one: what is exported may be a file for each robot."""

from __future__ import annotations

import asyncio
import io
import zipfile
from base64 import b64decode
from collections.abc import Mapping


async def parcel(files: Mapping[str, str], name: str) -> tuple[bytes, str]:
    """Files by their names, in base64, as one and how it is called: as it is if it is one, otherwise a ZIP."""
    return await asyncio.to_thread(_packed, files, name)  # which lets go of the interpreter while it packs


def _packed(files: Mapping[str, str], name: str) -> tuple[bytes, str]:
    if len(files) == 1:
        ((only, data),) = files.items()
        return b64decode(data), only
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, data in files.items():
            archive.writestr(each, b64decode(data))
    return packed.getvalue(), f"{name}.zip"
