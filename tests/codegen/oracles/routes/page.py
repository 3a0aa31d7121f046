"""The page that shows the table: ``docs/routes.md``."""

from collections.abc import Callable, Sequence

from oracles.routes.blocks import BLOCKS
from oracles.routes.exchanging import EXCHANGING
from oracles.routes.friction import FRICTION
from oracles.routes.going import COMPILED, ROUTES
from oracles.routes.jumping import JUMPING
from oracles.routes.kind import Kind
from oracles.routes.kinds import KINDS
from oracles.routes.lawful import LAWFUL
from oracles.routes.looped import LOOPED
from oracles.routes.machines import MACHINES
from oracles.routes.plain import PLAIN
from oracles.routes.signals import SIGNALS
from oracles.routes.sloped import SLOPED
from oracles.routes.switches import SWITCHES
from oracles.routes.table import REFUSALS, REFUSED
from oracles.routes.tabled import TABLED

HEAD = """# What goes which way

Every kind of port by every route that a model can take. Each kind is a small model whose run is known by
hand, in closed form. **y**: the route goes, and what comes of it is right: runs are held to the known run,
all others to what can be asked of them. A number: the route is refused, for the reason of that number below
the tables. `make routes` writes this page of what the tests hold; they fail where a cell says anything else
than the toolkit does.
"""

WHAT = """
| route | what is asked of it |
|---|---|
| print | what laws, sources and rates are said to be holds at an instant of the run, everything put in too |
| explain, latex | every state, switch and law is told; of hundreds of states, how many there are |
| explicit | its rates are the slopes of the run |
| drawing | every node, every bond with its stroke, every signal, a switch as one |
| JSON, GraphML | read again, the graph has the same equations, laws and switches |
| linearize | in the mode of the run its model changes rates as the run does |
| trim | a state from which a run does not move |
| numpy, stepper, sweep, command line, C exact | the known run, to 1e-7 of its range |
| C located, stepper in C, sweep in C, to_c located | to 1e-6, without a run that numpy does for C |
| FMI ME, CS | to 1e-5, in FMPy, by CVODE and at the samples' steps |
| to_python, to_c fixed steps | to 60 over their number (2,500 and 20,000), but for samples beside an event |
"""


def page() -> str:
    """The text of the page."""
    parts = [HEAD]
    for title, kinds in (
        ("Dry friction", (*FRICTION, *SLOPED)),
        ("Laws that jump", JUMPING),
        ("Switches", (*SWITCHES, *EXCHANGING)),
        ("No port that switches", (*PLAIN, *LAWFUL, *LOOPED)),
        ("Lookup tables", TABLED),
        ("Signals", SIGNALS),
        ("Blocks", BLOCKS),
        ("State machines", MACHINES),
    ):
        plain = [route for route in ROUTES if route not in COMPILED]
        parts += [f"\n## {title}\n", *_table(kinds, plain), "", *_table(kinds, COMPILED)]
    parts += ["\n## What is asked\n", WHAT.strip(), "\n## Refusals\n"]
    for at, one in enumerate(REFUSALS, 1):
        word = "For good" if one.genuine else "Not yet"
        parts.append(f"{at}. {word}. {one.reason}")
    cells = len(ROUTES) * len(KINDS)
    later = sum(not one.genuine for one in REFUSED.values())
    parts.append(
        f"\nOf {cells} cells {cells - len(REFUSED)} go, {len(REFUSED) - later} are refused for good, "
        f"{later} not yet."
    )
    return "\n".join(parts) + "\n"


def _table(kinds: Sequence[Callable[[], Kind]], routes: Sequence[str]) -> list[str]:
    lines = [f"| | {' | '.join(routes)} |", f"|---|{':-:|' * len(routes)}"]
    for make in kinds:
        cells = [_cell(make.__name__, route) for route in routes]
        lines.append(f"| {make().name} | {' | '.join(cells)} |")
    return lines


def _cell(kind: str, route: str) -> str:
    refusal = REFUSED.get((kind, route))
    return "y" if refusal is None else str(REFUSALS.index(refusal) + 1)
