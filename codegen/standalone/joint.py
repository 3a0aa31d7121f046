"""Friction whose efforts act back at once, on slips, levels or laws: all are solved together."""

import numpy as np

from codegen.standalone.arrays import Array, Mode
from codegen.standalone.evaluation import Form, Laws
from codegen.standalone.friction import Friction, Ports
from codegen.standalone.holding import Hold
from codegen.standalone.instant import Instant
from codegen.standalone.loops import Loop, Search
from codegen.standalone.sharing import fair_share


class JointFriction(Friction):
    """Friction ports, and the laws that depend on what they give; ``rescue``: a further search."""

    def __init__(
        self, ports: Ports, form: Form, coupled: Laws, rescue: Search | None = None
    ) -> None:
        super().__init__(ports, form, coupled)
        inputs = np.array([*ports.inputs, *coupled.inputs], dtype=int)
        readings = np.array([*ports.readings, *coupled.readings], dtype=int)
        names = [*ports.names, *coupled.names]
        self.coupled, self.every = coupled, Loop(ports.values, inputs, readings, names, rescue)

    def rub(self, now: Instant, mode: Mode, held: Hold | None, checked: bool) -> None:
        """Complete an instant by the friction efforts of a mode, and by what the laws give."""

        def left() -> Array:
            result = now.u[self.ports.inputs] - self.against(now, mode, checked)
            if held:
                shares = held.share @ now.u[held.inputs]
                result[held.ports] = np.concatenate([held.rule(now), shares])
            laws = now.u[self.coupled.inputs] - self.coupled.formula(now)
            return np.concatenate([result, laws])

        self.every.solve(now, left)
        if held and len(held.share):
            efforts = now.u[held.inputs]
            fair = fair_share(efforts, held.ways, now.caps[held.ports])
            now.give(held.inputs, fair - efforts)
