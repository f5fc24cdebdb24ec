"""What the tests of workers share."""

import asyncio

import pytest

from muster_control.work import Pool


@pytest.fixture(scope="module")
def asked():
    """Gives a worker a piece of work; what it answers."""
    with asyncio.Runner() as runner:
        pool = Pool(workers=1, memory_mb=512)

        def ask(task, limit_s=None, on_progress=None, stop_request=None, **arguments):
            return runner.run(
                pool.run(task, arguments, limit_s=limit_s, on_progress=on_progress, stop_request=stop_request)
            )

        yield ask
        runner.run(pool.close())
