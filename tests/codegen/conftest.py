"""Units that several files of tests call, and what they count."""

from collections.abc import Iterator
from typing import Any

import pytest


@pytest.fixture(scope="module")
def compiled_quickly() -> Iterator[None]:
    """Units are compiled without optimisation."""
    from codegen.fmu import binaries

    with pytest.MonkeyPatch.context() as patch:
        flags = ("-O0", *(flag for flag in binaries.FLAGS if flag != "-O2"))
        patch.setattr(binaries, "FLAGS", flags)
        yield


@pytest.fixture(scope="module", params=["2.0", "3.0"])
def slider(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    compiled_quickly: None,
) -> Any:
    """A unit of a mass on a belt, of either version of FMI."""
    from oracles.called import Unit
    from oracles.units import belt

    return Unit(belt(), str(request.param), tmp_path_factory.mktemp("belt"), name="belt")


@pytest.fixture
def evaluations(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How often the rates of models were asked for."""
    from codegen.modes.closed import ClosedModel

    count, plain = [0], ClosedModel.rates

    def counting(model: ClosedModel, *given: Any) -> Any:
        rates = plain(model, *given)

        def counted(t: float, s: Any) -> Any:
            count[0] += 1
            return rates(t, s)

        return counted

    monkeypatch.setattr(ClosedModel, "rates", counting)
    return count
