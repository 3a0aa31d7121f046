"""Python's search for circular garbage looks at what tests make, not at what stays for all of them.

What is imported and collected before the first test is some hundred thousand objects, and expressions make
many more that are no circles; a search at Python's own pace takes a twentieth of a run.
"""

import gc

import pytest

PACE = (50_000, 20, 50)
"""Objects made between searches, and searches of the young between those of older ones."""


def pytest_collection_finish(session: pytest.Session) -> None:
    """Leave out what is there."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(*PACE)
