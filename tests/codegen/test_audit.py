"""Textbook cases and random runs close their power balance to 1e-9 of the energy turned over.

The suite takes a slice; ``BONDGRAPH_SOAK_AUDITS`` runs so many of each family.
"""

import os

import numpy as np
import pytest
from oracles.audited import CLOSED, FAMILIES, open_part, textbook
from references.cases import CASES as TEXTBOOKS

COUNTS = {"linear": 12, "rubbing": 6, "turning": 4, "rectifying": 4}
ASKED = os.environ.get("BONDGRAPH_SOAK_AUDITS")
RANDOM = [(family, seed) for family, few in COUNTS.items() for seed in range(int(ASKED or few))]


@pytest.mark.parametrize(("family", "seed"), RANDOM)
def test_random_runs_close(family: str, seed: int) -> None:
    result = FAMILIES[family](seed)
    if result is not None:
        assert open_part(result) < CLOSED


@pytest.mark.parametrize("name", TEXTBOOKS)
def test_textbook_cases_close(name: str) -> None:
    result = textbook(name)
    assert open_part(result) < CLOSED
    audit = result.audit()
    assert np.isfinite([*audit.gave.values(), *audit.took.values(), *audit.lost.values()]).all()
