"""What a process that reads the missions of strangers may take of this machine."""

from __future__ import annotations

import errno
import resource


def limit_memory(most_mb: int) -> None:
    """From now on this process gets no more memory than that, and leaves no core file."""
    size = most_mb * 2**20
    resource.setrlimit(resource.RLIMIT_AS, (size, size))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def is_of_memory(error: BaseException) -> bool:
    """Whether an error says that there was no more memory."""
    return isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno == errno.ENOMEM)
