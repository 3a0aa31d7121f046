"""A script that runs an exported Python module as a run was prepared."""

import json
from collections.abc import Sequence

from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant, Lag, Step, as_signal
from codegen.targets import Export

_LAGGED = '''

def lagged(time, demand, lag):
    """A step of a demand at a time [s], through a first-order lag."""
    return lambda t: 0.0 if t < time else demand * (1.0 - math.exp(-(t - time) / lag))
'''

_PIECES = '''

def pieces(breaks, parts):
    """Between breaks [s] sums of polynomials times exponentials: (rate, coefficients), from a start."""

    def value(t):
        start, terms = parts[bisect.bisect_right(breaks, t)]
        return sum(
            (cmath.exp(rate * (t - start)) * sum(c * (t - start) ** n for n, c in enumerate(row))).real
            for rate, row in terms
        )

    return value
'''

_HELPERS = {"pieces": (("bisect", "cmath"), _PIECES), "lagged": (("math",), _LAGGED)}
"""What a signal's text may call, with the modules that it needs."""


_UNKNOWN = "  # nothing was given: a constant, or a function of time, to change"


def script(name: str, export: Export, names: Sequence[str]) -> str:
    """The text of a script that runs the module ``name`` and writes every signal as a table.

    ``names``: the model's inputs; those that the run does not give are constants of zero, to be changed.
    """
    given = {one: _signal(as_signal(signal, one)) + "," for one, signal in export.inputs.items()}
    given |= {one: f"0.0,{_UNKNOWN}" for one in names if one not in given}
    inputs = "".join(f"    {_text(one)}: {value}\n" for one, value in given.items())
    initial = "".join(f"    {_text(one)}: {float(v)!r},\n" for one, v in export.initial.items())
    used = [helper for word, helper in _HELPERS.items() if f": {word}(" in inputs]
    on = [str(node) for node in export.initially_on]
    told = f", initially_on={on!r}" if on else ""
    imports = "".join(f"import {one}\n" for modules, _ in used for one in modules)
    imports += "\n" if imports else ""
    helpers = "".join(text for _, text in used)
    begin, end = float(export.times[0]), float(export.times[-1])
    return f'''"""Runs {name} as it was exported and writes every signal as comma-separated columns."""

{imports}import numpy as np

from {name} import simulate
{helpers}

inputs = {{
{inputs}}}
initial = {{
{initial}}}
times = np.linspace({begin!r}, {end!r}, {len(export.times)})
result = simulate(times, initial, inputs{told})
table = np.column_stack([*result.values()])
header = ",".join(result)
np.savetxt("{name}.csv", table, delimiter=",", header=header, comments="")
print("wrote {name}.csv")
'''


def _text(name: str) -> str:
    """A name as a text of the script."""
    return json.dumps(name, ensure_ascii=False)


def _signal(signal: Signal) -> str:
    """A signal as an expression of the script."""
    if isinstance(signal, Constant):
        return repr(float(signal.value))
    if isinstance(signal, Lag) and isinstance(signal.signal, Step) and signal.signal.initial == 0:
        step = signal.signal
        numbers = (step.time, step.value, signal.time_constant)
        return f"lagged({', '.join(repr(float(number)) for number in numbers)})"
    parts = [(piece.start, piece.terms) for piece in signal.pieces]
    return f"pieces({list(signal.breakpoints)!r}, {parts!r})"
