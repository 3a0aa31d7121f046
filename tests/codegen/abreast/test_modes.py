"""Maps of many runs at once: those of each run by itself, and bounds beside numpy's eigenvalues."""

from itertools import product

import numpy as np
import pytest
from oracles.beside import many_chains
from oracles.sweeping import locking

from codegen.abreast.fit import Sound
from codegen.abreast.modes import ModesAbreast, _norms
from codegen.program.layout import INPUTS, RATE, READINGS


@pytest.mark.parametrize("seed", [0, 3, 4, 9])
def test_maps_are_those_of_single_runs(seed: int) -> None:
    many = many_chains(seed, 5)
    asked, rows = many.asked(), many.rows()
    models = [asked.family.simulator(**asked.changes(row)).closed for row in rows]
    inputs = len(models[0].program.external)
    modes = ModesAbreast(models[0], asked.parameters(rows), np.ones((5, inputs)))
    looked = 0
    for mode in product((1, 0, -1), repeat=len(models[0].program.friction)):
        found = modes.of(mode)
        for run, model in enumerate(models):
            affine = model.affine_map(mode, inputs)
            assert (found is None) == (affine is None)
            if found is None or affine is None or not found.sound[run]:
                continue
            for part in (INPUTS, READINGS, RATE):
                own, other = found.maps.rows(part)[run], affine.rows(part)
                assert own == pytest.approx(other, rel=1e-9, abs=1e-9 * np.abs(other).max()), mode
            assert found.fastest[run] == pytest.approx(affine.fastest, rel=1e-6, abs=1e-6)
            looked += 1
    assert looked > 10


def test_norms_are_bounds_and_close() -> None:
    rng = np.random.default_rng(2)
    scales = 10.0 ** rng.uniform(-4, 4, (40, 6))
    matrices = rng.normal(size=(40, 6, 6))
    far = matrices * scales[:, :, None] / scales[:, None, :]
    found, rates = _norms(far), np.abs(np.linalg.eigvals(matrices)).max(axis=1)
    assert (found >= rates).all()
    assert (found <= 1.5 * np.abs(matrices).sum(axis=2).max(axis=1)).all()


def test_values_near_zero_take_an_exact_look() -> None:
    equations = locking().equations
    values = {
        **{str(name): 1.0 for name in locking().parameters},
        "I_w1": np.array([1.0, 0.0, -2.0, np.inf]),
    }
    found = Sound(equations, frozenset(["I_w1"])).of(values, 4)
    assert found.tolist() == [True, False, True, False]
