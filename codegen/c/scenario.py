"""The inputs and initial states that an exported main program runs unless it is told otherwise."""

from collections.abc import Sequence

from codegen.c.text import array, comment, doubles, integers
from codegen.inputs.signals import Signal
from codegen.inputs.tables import Row, signal_table


def scenario_text(signals: Sequence[Signal], initial: Sequence[float]) -> str:
    """scenario.h: tables of the signals, each with a constant of its own in front that is zero.

    The constant of input i has coefficient i; a program that gives an input a value sets it.
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
    coefficients = [*[0j] * len(signals), *table.coefficients]
    sizes = {
        "SEGMENTS": len(table.fastest), "TERMS": max(len(rows), 1),
        "COEFFICIENTS": max(len(coefficients), 1),
    }  # fmt: skip
    terms = [
        f"{{{at}, {first}, {count}, {start!r}, {{{rate.real!r}, {rate.imag!r}}}}}"
        for at, first, count, start, rate in rows
    ]
    pairs = [f"{{{c.real!r}, {c.imag!r}}}" for c in coefficients]
    lines = [
        *comment(
            "What main.c runs: inputs as sums of polynomials times exponentials, by segments."
        ),
        *(f"#define SCENARIO_{name} {value}" for name, value in sizes.items()),
        "",
        *doubles("scenario_states", initial, local=True),
        *doubles("scenario_breaks", table.breaks, local=True),
        *doubles("scenario_fastest", table.fastest, local=True),
        *integers("scenario_begins", begins, local=True),
        *array("static const double scenario_coefficients[][2]", pairs, "{0.0, 0.0}"),
        *array("static const bg_term scenario_terms[]", terms, "{0, 0, 0, 0.0, {0.0, 0.0}}"),
    ]
    return "\n".join(lines) + "\n"
