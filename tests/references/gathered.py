"""Equations that are derived while something runs: guides and textbook cases bring their own graphs."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

import bondgraph as bg


@contextmanager
def gathered() -> Iterator[list[bg.StateEquations]]:
    """All that `derive` gives inside; what something asks for twice is there twice."""
    found: list[bg.StateEquations] = []
    # The package has a function of the module's name.
    module = import_module("bondgraph.derive")
    original = module.state_equations

    def noted(*given: Any, **named: Any) -> bg.StateEquations:
        equations: bg.StateEquations = original(*given, **named)
        found.append(equations)
        return equations

    module.state_equations = noted
    try:
        yield found
    finally:
        module.state_equations = original
