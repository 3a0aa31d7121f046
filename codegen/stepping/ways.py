"""Which ways of stepping a simulator has."""

from collections.abc import Callable
from functools import partial

from codegen.engine.located import METHODS, LocatedRuns
from codegen.engine.runs import CRuns
from codegen.runs.methods import EXACT
from codegen.runs.track import Settings
from codegen.stepping.falling import FallingGoing
from codegen.stepping.going import Going, refused_by_c
from codegen.stepping.in_exact import ExactGoing
from codegen.stepping.in_located import LocatedGoing
from codegen.stepping.plan import Plan


def going_of(
    plan: Plan, settings: Settings, engine: CRuns | None, located: LocatedRuns | None,
    in_numpy: Callable[[Plan, Settings], Going],
) -> Going:  # fmt: skip
    """What steps a model: numpy, unless there is C, which goes first as in a run."""
    last = partial(in_numpy, plan, settings)
    if located is None:
        return last()
    method, ways = settings.method, list[Callable[[], Going]]()
    if engine is not None and method in ("auto", EXACT):
        ways.append(partial(ExactGoing, plan, engine, method == EXACT))
    if method in METHODS:
        ways.append(partial(LocatedGoing, plan, located, settings))
    if not ways:
        ways.append(partial(refused_by_c, method, limit=method != EXACT))
    return FallingGoing([*ways, last])
