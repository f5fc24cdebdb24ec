"""The first lines of the command `muster`, and of `python -m muster.cli`.

Importing the command takes a moment, on a loaded machine a second or more. Ctrl-C ends in one line all that time, so
nothing is imported here before it does.
"""

from __future__ import annotations

import os
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import TracebackType

_INTERRUPTED = 130  # as in `muster.cli.exits`, which is not imported yet


def main() -> None:
    """Run the command and exit."""
    sys.excepthook = _end_or_print
    sys.unraisablehook = _end_or_go_on
    import signal
    from time import perf_counter  # as `SystemClock` has it

    began_s = perf_counter()

    interrupts = signal.getsignal(signal.SIGINT)
    ends = _end if interrupts is signal.default_int_handler else interrupts  # a shell may ask programs to ignore it
    signal.signal(signal.SIGINT, ends)
    from muster.cli.main import run

    signal.signal(signal.SIGINT, interrupts)
    code = run(sys.argv[1:], began_s)
    signal.signal(signal.SIGINT, ends)
    sys.exit(code)


def _end(*_: object) -> None:
    """Say that the command was interrupted, and end at once: there is nothing to tidy up."""
    os.write(2, b"\ninterrupted\n")
    os._exit(_INTERRUPTED)


def _end_or_print(kind: type[BaseException], error: BaseException, traceback: TracebackType | None) -> None:
    """End at a Ctrl-C that came between two handlers; print any other exception."""
    if issubclass(kind, KeyboardInterrupt):
        _end()
    sys.__excepthook__(kind, error, traceback)


def _end_or_go_on(unraisable: sys.UnraisableHookArgs) -> None:
    """End at a Ctrl-C that came within a finaliser or a callback, where Python would print it and go on."""
    if issubclass(unraisable.exc_type, KeyboardInterrupt):
        _end()
    sys.__unraisablehook__(unraisable)


if __name__ == "__main__":
    main()
