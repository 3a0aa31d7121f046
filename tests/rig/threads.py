"""Linear algebra takes one processor: the processes of a run have the others.

With more threads each waits for the others' processors, busily: tests of many small products then take
twice their time.
"""

import os

import pytest

VARIABLES = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")


def pytest_configure(config: pytest.Config) -> None:
    """The first process of a run settles it for those that it starts, unless it is told otherwise."""
    for name in VARIABLES:
        os.environ.setdefault(name, "1")
