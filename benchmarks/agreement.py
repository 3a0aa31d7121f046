"""How far whatever is generated agrees: every differential and figure, every way to run it.

``python benchmarks/agreement.py`` prints three tables. Ways that locate events against the simulator's
matrix exponentials: the largest difference of any signal over its range, and of any event in time. Ways
with fixed steps against exported C. Then what their steps cost: errors of the states over their range at
steps of a millisecond and parts of it, and the order of their fall. Where a clutch sticks or slips, an
error depends on where in its step that is, so that single ones may be small by luck. Exported Python,
much slower than C, makes the longer steps only.
"""

import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "codegen")]

from oracles.apart import Apart, apart, order  # noqa: E402
from oracles.c_model import Pair  # noqa: E402
from oracles.methods import EVERY, LOCATED, STEPPED, Made, Outcome  # noqa: E402

from differentials.prepared import SAMPLE  # noqa: E402

COUNTS = (1, 3, 10, 30, 100)
"""Steps for each sample."""

SLOW, LONGER = "exported Python", (1, 3, 10)

UNSTABLE, ROUNDING = 0.5, 1e-11
"""Errors over the range beyond which a step is too long for the method of Runge and Kutta, and below which
nothing is left to fall: neither tells of the order."""


Runs = dict[int, Outcome]
"""A run by the steps for each sample."""


def main() -> None:
    """Measure and print."""
    pairs: dict[str, Pair] = {}
    with tempfile.TemporaryDirectory() as folder:
        made = [Made(*case, Path(folder), pairs) for case in EVERY]
        show_located(made)
        runs = {(one, name): stepped(one, name) for one in made for name in STEPPED}
    show_stepped(made, runs)
    show_convergence(made, runs)


def stepped(made: Made, name: str) -> Runs:
    """The runs of one way with fixed steps."""
    return {count: STEPPED[name](made, count) for count in (LONGER if name == SLOW else COUNTS)}


def show_located(made: Sequence[Made]) -> None:
    """Differences from the first of the ways that locate events."""
    reference, *others = LOCATED
    print(f"from {reference}: signals over their range, and events [s]\n")
    print(_row(["", "events", *others], 20))
    for one in made:
        expected = LOCATED[reference](one)
        found = [apart(LOCATED[name](one), expected) for name in others]
        print(_row([_title(one), len(expected.events), *map(_both, found)], 20), flush=True)


def show_stepped(made: Sequence[Made], runs: dict[tuple[Made, str], Runs]) -> None:
    """Differences from the first of the ways with fixed steps, the largest over all steps."""
    reference, *others = STEPPED
    print(f"\nfrom {reference} at the same step, the worst of all steps\n")
    print(_row(["", *others], 24))
    for one in made:
        found = [_worst(runs[one, name], runs[one, reference]) for name in others]
        print(_row([_title(one), *map(_both, found)], 24))


def _worst(found: Runs, expected: Runs) -> Apart:
    every = [apart(found[count], expected[count]) for count in found]
    worst = max(every, key=lambda one: one.signals)
    return Apart(worst.signals, worst.worst, max(one.events for one in every))


def show_convergence(made: Sequence[Made], runs: dict[tuple[Made, str], Runs]) -> None:
    """Errors of states against the step."""
    print("\nstates over their range from the exact run, by the step [s], and the order\n")
    print(_row(["", "", *(f"{SAMPLE / count:.2g}" for count in COUNTS), "order"], 10, 22))
    for one in made:
        for name in STEPPED:
            print(_row([_title(one), name, *_errors(one, runs[one, name])], 10, 22))


def _errors(made: Made, found: Runs) -> Iterator[str]:
    expected, names = LOCATED["numpy exact"](made), made.exact.states
    errors = {count: apart(run, expected, names).signals for count, run in found.items()}
    for count in COUNTS:
        error = errors.get(count)
        yield "-" if error is None else "unstable" if error > UNSTABLE else f"{error:.1e}"
    told = {SAMPLE / n: error for n, error in errors.items() if ROUNDING < error < UNSTABLE}
    yield f"{order([*told], [*told.values()]):.2f}"


def _title(made: Made) -> str:
    return f"{made.name} {made.scenario}"


def _both(found: Apart) -> str:
    return f"{found.signals:.1e}  {found.events:.1e}"


def _row(cells: Sequence[object], width: int, second: int = 0) -> str:
    head, *rest = map(str, cells)
    start = f"{head:<42}"
    if second:
        start += f"{rest.pop(0):<{second}}"
    return start + "".join(f"{cell:>{width}}" for cell in rest)


if __name__ == "__main__":
    main()
