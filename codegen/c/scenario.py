"""Tables of signals as C; what an exported main program runs unless it is told otherwise."""

from collections.abc import Sequence
from dataclasses import replace

from codegen.c.text import array, comment, doubles, integers
from codegen.inputs.signal import Signal
from codegen.inputs.tables import Row, SignalTable, known_span, signal_table


def signal_lines(table: SignalTable, name: str) -> list[str]:
    """The parts of a ``bg_signals`` as constant arrays that begin with a name; its duties as a whole."""
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
        *_wave_lines(table, name),
    ]


def _wave_lines(table: SignalTable, name: str) -> list[str]:
    """What repeats, and what says how long."""
    waves = [
        f"{{{first}, {count}, {duty}, {f!r}, {phase!r}, {pace!r}}}"
        for first, count, duty, f, phase, pace in table.waves
    ]
    parts = [f"{{{first}, {count}, {fraction!r}}}" for first, count, fraction in table.parts]
    lines = [
        *array(f"static const bg_wave {name}_wave[]", waves, "{0, 0, 0, 0.0, 0.0, 0.0}"),
        *array(f"static const bg_part {name}_parts[]", parts, "{0, 0, 0.0}"),
    ]
    if table.duties is not None:
        own = f"{name}_duties"
        lines += [*signal_lines(table.duties, own), *signals_record(table.duties, own, "static ")]
    return lines


def signals_record(table: SignalTable, name: str, kind: str = "") -> list[str]:
    """A ``bg_signals`` whose parts stand in arrays that begin with its name."""
    fields = ("breaks", "begins", "terms", "coefficients", "fastest")
    listed = ", ".join(f"{name}_{field}" for field in fields)
    return [
        f"{kind}const bg_signals {name} = {{",
        f"    {len(table.fastest)}, {listed},",
        f"    {len(table.waves)}, {name}_wave, {name}_parts, {duties_of(table, name)}",
        "};",
    ]


def duties_of(table: SignalTable, name: str) -> str:
    """Where the duties of a table's waves are; 0 where it has none."""
    return "0" if table.duties is None else f"&{name}_duties"


def scenario_text(
    signals: Sequence[Signal], initial: Sequence[float], named: Sequence[bool]
) -> str:
    """scenario.h: tables of the signals, each with a constant of its own in front that is zero.

    The constant of input i has coefficient i; a program that gives an input a value sets it.
    ``named``: whether each state keeps its initial value where switches are on at first.
    """
    table = signal_table(signals, *known_span(signals))
    rows: list[Row] = []
    begins = [0]
    for first, last in zip(table.begins, table.begins[1:], strict=False):
        rows += [(at, at, 1, 0.0, 0j) for at in range(len(signals))]
        rows += [(at, p + len(signals), *rest) for at, p, *rest in table.terms[first:last]]  # type: ignore[misc]
        begins.append(len(rows))
    moved = len(rows) - table.begins[-1]
    parts = tuple((first + moved, count, fraction) for first, count, fraction in table.parts)
    rows += [(at, p + len(signals), *rest) for at, p, *rest in table.terms[table.begins[-1] :]]  # type: ignore[misc]
    coefficients = (*[0j] * len(signals), *table.coefficients)
    sizes = {
        "SEGMENTS": len(table.fastest), "TERMS": max(len(rows), 1),
        "COEFFICIENTS": max(len(coefficients), 1), "WAVES": len(table.waves),
        "DUTIES": duties_of(table, "scenario"),
    }  # fmt: skip
    full = replace(
        table, begins=tuple(begins), terms=tuple(rows), coefficients=coefficients, parts=parts
    )
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
