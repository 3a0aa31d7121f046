"""Equations that are derived while something runs: guides and textbook cases bring their own graphs."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bondgraph as bg


@contextmanager
def gathered() -> Iterator[list[bg.StateEquations]]:
    """All that `derive` gives inside; what something asks for twice is there twice."""
    found: list[bg.StateEquations] = []
    # The package has a function of the module's name.
    module = sys.modules["bondgraph.derive"]
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
