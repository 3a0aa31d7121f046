"""Processes that tests start find the Python that those before them have compiled, in any environment.

With `PYTHONDONTWRITEBYTECODE` each of them would compile the packages again, in as long as
it imports the rest.
"""

import os
import sys

import pytest

VARIABLE = "PYTHONDONTWRITEBYTECODE"


def pytest_configure(config: pytest.Config) -> None:
    """The first process of a run settles it for those that it starts."""
    if os.environ.pop(VARIABLE, None):
        sys.dont_write_bytecode = False
