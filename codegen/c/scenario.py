"""Tables of signals as C; what an exported main program runs unless it is told otherwise."""

from collections.abc import Sequence
from dataclasses import replace

from codegen.c.text import array, comment, doubles, integers
from codegen.inputs.signal import Signal
from codegen.inputs.tables import Row, SignalTable, signal_table


def signal_lines(table: SignalTable, name: str) -> list[str]:
    """The parts of a ``bg_signals`` as constant arrays that begin with a name."""
    terms = [
        f"{{{at}, {first}, {count}, {float(start)!r}, {{{rate.real!r}, {rate.imag!r}}}}}"
        for at, first, count, start, rate in table.terms
    ]
    pairs = [f"{{{c.real!r}, {c.imag!r}}}" for c in table.coefficients]
    return [
        *doubles(f"{name}_breaks", table.breaks, local=True),
        *doubles(f"{name}_fastest", table.fastest, local=True),
        *integers(f"{name}_begins", table.begins, local=True),
        *array(f"static const double {name}_coefficients[][2]", pairs, "{0.0, 0.0}"),
        *array(f"static const bg_term {name}_terms[]", terms, "{0, 0, 0, 0.0, {0.0, 0.0}}"),
    ]


def scenario_text(
    signals: Sequence[Signal], initial: Sequence[float], named: Sequence[bool]
) -> str:
    """scenario.h: tables of the signals, each with a constant of its own in front that is zero.

    The constant of input i has coefficient i; a program that gives an input a value sets it.
    ``named``: whether each state keeps its initial value where switches are on at first.
    """
    ends = [b for signal in signals for b in signal.breakpoints]
    begin = min([0.0, *ends])
    table = signal_table(signals, begin, max([begin, *ends]))
    rows: list[Row] = []
    begins = [0]
    for first, last in zip(table.begins, table.begins[1:], strict=False):
        rows += [(at, at, 1, 0.0, 0j) for at in range(len(signals))]
        rows += [(at, p + len(signals), *rest) for at, p, *rest in table.terms[first:last]]  # type: ignore[misc]
        begins.append(len(rows))
    coefficients = (*[0j] * len(signals), *table.coefficients)
    sizes = {
        "SEGMENTS": len(table.fastest), "TERMS": max(len(rows), 1),
        "COEFFICIENTS": max(len(coefficients), 1),
    }  # fmt: skip
    full = replace(table, begins=tuple(begins), terms=tuple(rows), coefficients=coefficients)
    lines = [
        *comment(
            "What main.c runs: inputs as sums of polynomials times exponentials, by segments."
        ),
        *(f"#define SCENARIO_{key} {value}" for key, value in sizes.items()),
        "",
        *doubles("scenario_states", initial, local=True),
        *integers("scenario_named", [int(one) for one in named], local=True),
        *signal_lines(full, "scenario"),
    ]
    return "\n".join(lines) + "\n"
