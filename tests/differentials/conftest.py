"""A differential's own model is derived once for all tests of scenarios and of commands."""

from collections.abc import Iterator, Mapping
from importlib import import_module

import pytest
from oracles.exported import model_of

from differentials.model import Model, model

USERS = (
    "identification",
    "scenarios",
    "commands.linearising",
    "commands.preparing",
    "commands.reading",
)


def _model(name: str, laws: Mapping[str, object] | None = None, backlash: bool = False) -> Model:
    """As `model`, whose records are frozen; derived anew for other laws and with backlash."""
    return model(name, laws, backlash) if laws or backlash else model_of(name)


@pytest.fixture(autouse=True, scope="module")
def _derived_once() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        for user in USERS:
            patch.setattr(import_module(f"differentials.{user}"), "model", _model)
        yield
