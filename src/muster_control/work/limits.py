"""Limits of processes that read missions of users."""

from __future__ import annotations

import errno
import resource


def limit_memory(most_mb: int) -> None:
    """Limit the memory of this process, and let it write no core file."""
    size = most_mb * 2**20
    resource.setrlimit(resource.RLIMIT_AS, (size, size))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def is_of_memory(error: BaseException) -> bool:
    """Whether an error means that memory ran out."""
    return isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno == errno.ENOMEM)
