"""Several files packed into one: an export may be one file per robot."""

from __future__ import annotations

import asyncio
import io
import zipfile
from base64 import b64decode
from collections.abc import Mapping


async def archive_of(files: Mapping[str, str], name: str) -> tuple[bytes, str]:
    """Pack files (base64, by name) into one file and its name: a ZIP, or the file itself if there is only one."""
    return await asyncio.to_thread(_packed, files, name)  # zlib releases the interpreter lock


def _packed(files: Mapping[str, str], name: str) -> tuple[bytes, str]:
    if len(files) == 1:
        ((only, data),) = files.items()
        return b64decode(data), only
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, data in files.items():
            archive.writestr(each, b64decode(data))
    return packed.getvalue(), f"{name}.zip"
