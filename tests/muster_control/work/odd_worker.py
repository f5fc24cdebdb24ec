"""A worker that also has tasks which go wrong in every way."""

import ctypes
import os
import signal
import sys
import time
from pathlib import Path
from types import ModuleType

from muster_control.work.tasks import TASKS, Task
from muster_control.work.worker import main


def echo(arguments, report):
    return arguments


def pid(arguments, report):
    return {"pid": os.getpid()}


def prints(arguments, report):
    sys.stdout.write('{"done": "rubbish"}\n')
    sys.stdout.flush()
    os.write(1, b"more rubbish\n")
    sys.stderr.write("x" * 1_000_000)
    return {"done": "true answer"}


def counts(arguments, report):
    for k in range(arguments["times"]):
        report({"k": k, "filling": "x" * arguments["size"]})
    return {}


def hoards(arguments, report):
    held = []
    while True:
        held.append(bytearray(10_000_000))


def hoards_small_things(arguments, report):
    held = []
    while True:
        held.append([len(held)])


def grows(arguments, report):
    held = b"x" * arguments["bytes"]
    return {"pid": os.getpid(), "held": len(held)}


def dies(arguments, report):
    os.kill(os.getpid(), signal.SIGKILL)


def crashes(arguments, report):
    ctypes.string_at(0)


def sleeps(arguments, report):
    """Deaf to everything that can be ignored, and with a child."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    child = os.fork()
    if not child:
        time.sleep(600)
    report({"pids": [os.getpid(), child], "folder": str(Path.cwd())})
    time.sleep(600)


def goes_on(arguments, report, stop):
    """Until it is stopped as often as it is said to be."""
    report({"pid": os.getpid()})
    while not (stop.hurried if arguments["times"] > 1 else stop.interrupted):
        time.sleep(0.01)
    return {"hurried": stop.hurried}


def stopped(arguments, report, stop):
    return {"stopped": stop.interrupted}


def fails(arguments, report):
    return arguments["absent"]


def recurses(arguments, report):
    return recurses(arguments, report)


ODD = (echo, pid, prints, counts, hoards, hoards_small_things, grows, dies, crashes, sleeps, fails, recurses)
STOPPABLE = (goes_on, stopped)


def module_of(function):
    """A module whose `run` is the function, as the worker imports it."""
    module = ModuleType(f"odd_{function.__name__}")
    module.run = function
    sys.modules[module.__name__] = module
    return module.__name__


if __name__ == "__main__":
    odd = {function.__name__: Task(module_of(function)) for function in ODD}
    stoppable = {function.__name__: Task(module_of(function), stoppable=True) for function in STOPPABLE}
    main(sys.argv[1:], {**TASKS, **odd, **stoppable})
