"""A program with numbers for its parameters as what can be evaluated: laws, matrices, friction."""

from collections.abc import Callable

import numpy as np

from codegen.model.hybrid import hybrid
from codegen.model.instant import Binding
from codegen.ports.slips import ExactSlips
from codegen.program.records import Group, Program
from codegen.standalone.arrays import Array, Mode
from codegen.standalone.evaluation import Form, Laws
from codegen.standalone.friction import Friction, Ports
from codegen.standalone.instant import Instant
from codegen.standalone.joint import JointFriction
from codegen.standalone.loops import Loop
from codegen.standalone.matrices import Numbers


def formed(program: Program, binding: Binding, matrices: Callable[[Instant], Numbers]) -> Form:
    """The form of a program, which binds its formulas to where everything stands."""
    return Form(
        states=len(program.states),
        inputs=[name.name for name in program.inputs],
        readings=[name.name for name in program.readings],
        given=np.array(program.given, dtype=int),
        known=_laws(program.known, binding),
        known_rates=binding.function(program.known_rates) if program.rated else None,
        beyond=np.array(program.beyond, dtype=int),
        matrices=matrices,
        laws=[_laws(group, binding) for group in program.groups],
        early=program.early,
        law_rates=np.array(program.law_rates, dtype=int),
        varying=program.varying,
        momenta=binding.function(program.momenta) if program.momenta.results else None,
        momenta_rows=program.momenta_rows,
    )


def rubbing(
    program: Program, binding: Binding, form: Form, slips: ExactSlips, plain: Friction | None = None
) -> Friction:
    """The friction ports of a program; ``slips``: what these receive, exact.

    ``plain``: those of the same laws as they are, where these are on one side of each corner.
    """
    ports = Ports(
        names=[port.name for port in program.friction],
        inputs=np.array([port.input for port in program.friction], dtype=int),
        readings=np.array([port.reading for port in program.friction], dtype=int),
        received=np.array([port.received for port in program.friction], dtype=int),
        moving=np.array(
            [-1 if p.moving is None else p.moving for p in program.friction], dtype=int
        ),
        beside=[slips.coupled(port) for port in range(len(program.friction))],
        held=slips.held,
        values=binding.function(program.friction_values),
        exact=True,
    )
    coupled = _laws(program.coupled, binding)
    if plain is None:
        return (
            JointFriction(ports, form, coupled, hybrid) if program.joint else Friction(ports, form)
        )
    if program.joint:
        return _JointOnSides(ports, form, coupled, hybrid).beside(plain)
    return _OnSides(ports, form).beside(plain)


class _OnSides(Friction):
    """Friction by laws on one side of each corner: beyond one its level may be below zero."""

    def beside(self, plain: Friction) -> "_OnSides":
        """What is checked is that of laws as they are."""
        self._plain = plain
        return self

    @property
    def judge(self) -> Friction:
        """See `Friction.judge`."""
        return self._plain

    def against(self, now: Instant, mode: Mode, checked: bool) -> Array:
        """See `Friction.against`."""
        if checked:
            self._plain.against(now, mode, True)
        return super().against(now, mode, False)


class _JointOnSides(_OnSides, JointFriction):
    """The same of friction that acts back at once."""


def _laws(group: Group, binding: Binding) -> Laws:
    inputs, readings = np.array(group.inputs, dtype=int), np.array(group.readings, dtype=int)
    parts = (binding.function(group.values), inputs, readings, group.ports)
    return Loop(*parts, hybrid) if group.loop else Laws(*parts)
