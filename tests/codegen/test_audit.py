"""Textbook cases and random runs close their power balance to 1e-9 of the energy turned over."""

import numpy as np
import pytest
from oracles.audited import CLOSED, FAMILIES, open_part, textbook
from references.cases import CASES as TEXTBOOKS
from soak.families import seeds

SEEDS = {
    "linear": seeds("audits-linear"), "rubbing": seeds("audits-rubbing"),
    "turning": seeds("audits-turning"), "rectifying": seeds("audits-rectifying"),
}  # fmt: skip
RANDOM = [(family, seed) for family, row in SEEDS.items() for seed in row]


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
