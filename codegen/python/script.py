"""A script that runs an exported Python module as a run was prepared."""

import json
from collections.abc import Sequence

from bondgraph.errors import SignalError
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant, Lag, Step, as_signal
from codegen.inputs.tables import NO_TABLE
from codegen.inputs.waves import Wave
from codegen.targets import Export

_LAGGED = '''

def lagged(time, demand, lag):
    """A step of a demand at a time [s], through a first-order lag."""
    return lambda t: 0.0 if t < time else demand * (1.0 - math.exp(-(t - time) / lag))
'''

_TERMS = '''

def summed(terms, tau):
    """A sum of polynomials times exponentials so long after its start: (rate, coefficients)."""
    return sum(
        (cmath.exp(rate * tau) * sum(c * tau**n for n, c in enumerate(row))).real for rate, row in terms
    )
'''

_PIECES = '''

def pieces(breaks, parts):
    """Between breaks [s] sums of terms, each from a start."""

    def value(t):
        start, terms = parts[bisect.bisect_right(breaks, t)]
        return summed(terms, t - start)

    return value
'''

_WAVE = '''

def wave(frequency, phase, parts, duty=None):
    """Periods that begin at (k + phase)/frequency; their parts by where they begin in one: (fraction, terms).

    A duty says at each period's start where the second of two begins.
    """

    def value(t):
        k = math.floor(t * frequency - phase)
        if (k + 1 + phase) / frequency <= t:
            k += 1
        elif (k + phase) / frequency > t:
            k -= 1
        found, start = parts[0][1], (k + phase) / frequency
        share = None if duty is None else min(max(duty(start), 0.0), 1.0)
        for fraction, terms in parts[1:] if share is None or share < 1 else ():
            begin = (k + (phase + (fraction if share is None else share))) / frequency
            if begin <= t:
                found, start = terms, begin
        return summed(found, t - start)

    return value
'''

_TOGETHER = '''

def together(*signals):
    """The sum of signals."""
    return lambda t: sum(signal(t) for signal in signals)
'''

_HELPERS = (
    ("summed", ("cmath",), _TERMS), ("pieces", ("bisect",), _PIECES), ("wave", ("math",), _WAVE),
    ("together", (), _TOGETHER), ("lagged", ("math",), _LAGGED),
)  # fmt: skip
"""What a signal's text may call, with the modules that it needs; each may call those before it."""


_UNKNOWN = "  # nothing was given: a constant, or a function of time, to change"


def script(name: str, export: Export, names: Sequence[str]) -> str:
    """The text of a script that runs the module ``name`` and writes every signal as a table.

    ``names``: the model's inputs; those that the run does not give are constants of zero, to be changed.
    """
    given = {one: _signal(as_signal(signal, one)) + "," for one, signal in export.inputs.items()}
    given |= {one: f"0.0,{_UNKNOWN}" for one in names if one not in given}
    inputs = "".join(f"    {_text(one)}: {value}\n" for one, value in given.items())
    initial = "".join(f"    {_text(one)}: {float(v)!r},\n" for one, v in export.initial.items())
    modules, helpers = _helpers(inputs)
    on = [str(node) for node in export.initially_on]
    told = f", initially_on={on!r}" if on else ""
    imports = "".join(f"import {one}\n" for one in modules)
    imports += "\n" if imports else ""
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


def _helpers(inputs: str) -> tuple[list[str], str]:
    """The modules and the functions that inputs need."""
    modules, texts = set[str](), list[str]()
    for word, needed, text in reversed(_HELPERS):
        if any(f"{word}(" in one for one in (inputs, *texts)):
            modules |= {*needed}
            texts.insert(0, text)
    return sorted(modules), "".join(texts)


def _signal(signal: Signal) -> str:
    """A signal as an expression of the script."""
    if isinstance(signal, Constant):
        return repr(float(signal.value))
    if isinstance(signal, Lag) and isinstance(signal.signal, Step) and signal.signal.initial == 0:
        step = signal.signal
        numbers = (step.time, step.value, signal.time_constant)
        return f"lagged({', '.join(repr(float(number)) for number in numbers)})"
    if signal.endless:
        parts = [_part(part) for part in signal.summands]
        return parts[0] if len(parts) == 1 else f"together({', '.join(parts)})"
    return _pieces(signal)


def _pieces(signal: Signal) -> str:
    """A function of time that has its breakpoints at hand."""
    parts = [(piece.start, piece.terms) for piece in signal.pieces]
    return f"pieces({list(signal.breakpoints)!r}, {parts!r})"


def _part(signal: Signal) -> str:
    """A part of an endless signal as a function of time."""
    if not signal.endless:
        return _pieces(signal)
    if not isinstance(signal, Wave):
        raise SignalError(NO_TABLE)
    parts = list(zip(signal.fractions, signal.forms, strict=True))
    duty = ""
    if signal.duty is not None:
        said = [_part(part) for part in signal.duty.summands]
        duty = f", together({', '.join(said)})"
    return f"wave({signal.frequency!r}, {signal.phase!r}, {parts!r}{duty})"
