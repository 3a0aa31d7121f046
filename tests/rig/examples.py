"""Files without examples are not searched for any: two of three have none, and the search takes its time."""

from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest

PROMPT = b">>> "


@pytest.hookimpl(wrapper=True)
def pytest_collect_file(file_path: Path) -> Generator[None, list[Any], list[Any]]:
    """What pytest finds in a file, less a search for examples where there is no prompt.

    A package is searched all the same: a file of one that is not imported yet would be another module than
    that which the package imports later.
    """
    found = yield
    plain = file_path.suffix == ".py" and file_path.name != "__init__.py"
    if plain and PROMPT not in file_path.read_bytes():
        # The class is not one of those that pytest shows.
        return [one for one in found if type(one).__name__ != "DoctestModule"]
    return found
