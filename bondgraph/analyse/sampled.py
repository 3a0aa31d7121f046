"""`SampledModel`: small deviations of a loop with sampled controllers, from one instant to the next."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.expressions import expression
from bondgraph.analyse.linear_model import LinearModel
from bondgraph.errors import ExpressionError, SignalError
from bondgraph.nodes.tasks import Task
from bondgraph.sampling.space import SampledSpace, Tick, over_a_period


@dataclass(frozen=True)
class SampledModel:
    """What happens between instants, symbolic, and what tasks set at theirs; `numeric` puts them together.

    ``between``: its last outputs are the values that tasks set, in the order of ``sets``: how long into a
    period [s], and which state.

    >>> import bondgraph as bg
    >>> loop = bg.graph([bg.Se("F", "1*u"), bg.One("n"), bg.I("m", "m", flow="v"),
    ...                  bg.Controller("brake", every=0.1, gives={"u": "-K*v"})], "F > n > m")
    >>> model = bg.linearize(bg.derive(loop), period=0.1)
    >>> model.period, model.states, model.sets, model.between.F
    (1/10, (v, u), ((0, u),), Matrix([[-K, 0]]))
    """

    between: LinearModel
    period: sp.Rational
    sets: tuple[tuple[sp.Rational, sp.Symbol], ...]

    @property
    def states(self) -> tuple[sp.Symbol, ...]:
        """Of what happens between instants, and what controllers keep."""
        return self.between.states

    @property
    def inputs(self) -> tuple[sp.Symbol, ...]:
        """What is held from one instant of the period to the next."""
        return self.between.inputs

    @property
    def outputs(self) -> tuple[sp.Symbol, ...]:
        """The outputs that were asked for."""
        return self.between.outputs[: len(self.between.outputs) - self._values]

    @property
    def parameters(self) -> tuple[sp.Symbol, ...]:
        """The names that need numbers, sorted."""
        return self.between.parameters

    @property
    def _values(self) -> int:
        """How many different values tasks set."""
        return len({state for _, state in self.sets})

    def numeric(self, parameters: Mapping[str, object]) -> SampledSpace:
        """``x_{k+1} = P x_k + Q u_k`` with numbers, exact between instants.

        Raises `ParameterError` for names without a number, numbers at which A is singular, and where a
        task or an output shows the rate of an input.
        """
        space = self.between.numeric(parameters)
        A, B, C, D = space.proper()
        count = len(self.outputs)
        own = list(dict.fromkeys(state for _, state in self.sets))
        places = {state: self.states.index(state) for state in own}
        rows = {state: count + at for at, state in enumerate(own)}
        ticks = []
        for time in sorted({time for time, _ in self.sets}):
            now = [state for at, state in self.sets if at == time]
            of = [rows[state] for state in now]
            ticks.append(Tick(float(time), tuple(places[s] for s in now), C[of], D[of]))
        found = over_a_period(A, B, C[:count], D[:count], ticks, float(self.period))
        for array in found:
            array.setflags(write=False)
        return SampledSpace(
            space.states, space.inputs, space.outputs[:count], float(self.period), *found
        )


def check_told(tasks: Sequence[Task]) -> None:
    """Refuse what only a Python function tells: it has no slopes.

    Raises `SignalError`, naming the controller.
    """
    for task in tasks:
        if task.step is not None:
            raise SignalError(
                f"the step of controller {task.name!r} is a Python function, which has no slopes; write what "
                "it does as expressions, or linearize without a period"
            )


def sampled(between: LinearModel, tasks: Sequence[Task], period: object) -> SampledModel:
    """The model over a period [s], which each task's own has to divide.

    Raises `SignalError` for a period that is no positive number, or no multiple of a task's.
    """
    try:
        whole = expression(period, "period")
    except ExpressionError as error:
        raise SignalError(f"{error}; give a number of seconds") from None
    if not isinstance(whole, sp.Rational) or whole <= 0:
        raise SignalError(f"period is {period!r}; it must be a number above zero")
    sets: list[tuple[sp.Rational, sp.Symbol]] = []
    for task in tasks:
        every, offset = sp.Rational(task.every, task.unit), sp.Rational(task.offset, task.unit)
        times = whole / every
        if not times.is_integer:
            raise SignalError(
                f"period {whole} is no multiple of {every}, at which {task.name!r} works; give the least "
                "common multiple of all controllers' periods"
            )
        first = offset - every * sp.floor(offset / every)
        sets += [(first + k * every, state) for k in range(int(times)) for state in task.states]
    return SampledModel(between, whole, tuple(sets))
