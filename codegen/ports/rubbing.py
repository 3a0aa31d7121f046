"""Friction ports of a closed model in numbers: against the slip, or whatever holds."""

from collections.abc import Mapping

import numpy as np
import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.errors import SimulationError
from codegen.model.instant import Binding, Instant
from codegen.model.loops import solve_loop
from codegen.model.numbers import Numbers
from codegen.model.snapshot import Mode
from codegen.model.terms import LevelTerms, without_rounding
from codegen.numbers.arrays import Array
from codegen.ports.friction import Hold, SlopeNeededError, hold
from codegen.ports.sharing import fair_share
from codegen.ports.slips import slip_rows
from codegen.program.records import Program
from codegen.tuning import TUNING


class Rubbing:
    """What the friction ports of a program give in a mode, with these parameters."""

    def __init__(
        self,
        program: Program,
        equations: StateEquations,
        parameters: Mapping[str, sp.Rational],
        binding: Binding,
    ) -> None:
        self._program = program
        self._inputs = [port.input for port in program.friction]
        self._readings = [port.reading for port in program.friction]
        self._outside = [program.inputs.index(n) for n in program.external if n in program.inputs]
        self.slips = slip_rows(program, equations, parameters)
        self._beside = [self.slips.coupled(port) for port in range(len(self._inputs))]
        self._coupled = binding.function(program.coupled.values)
        self._friction = binding.function(program.friction_values)
        self._terms = LevelTerms(program, binding)
        self._holds: dict[Mode, Hold] = {}

    def coupled_directly(self, port: int) -> bool:
        """Whether a friction port's slip depends at once on efforts of friction ports."""
        return self._beside[port]

    def hold(self, mode: Mode, numbers: Numbers) -> Hold:
        """The holding equations of the ports that stick in a mode, with the matrices of an instant."""
        if mode not in self._holds or self._program.varying:
            ports = tuple(i for i, sign in enumerate(mode) if sign == 0)
            found = hold(self._program, numbers, self.slips, ports)
            self._check_differentiable(found)
            self._holds[mode] = found
        return self._holds[mode]

    def rub(self, now: Instant, mode: Mode, checked: bool) -> None:
        """The friction efforts of a mode: against the slip, or whatever holds."""
        stuck = [i for i, sign in enumerate(mode) if sign == 0]
        held = [self._inputs[i] for i in stuck]
        if self._program.joint:
            self._rub_jointly(now, mode, stuck, held, checked)
        else:
            against = self._against(now, mode, checked)
            now.u[self._inputs] = against
            if stuck:
                rule = self.hold(mode, now.numbers)
                now.u[held] = rule.efforts(now.x, now.u, now.du, held, now.caps[stuck])
            now.y += now.numbers.D[:, self._inputs] @ now.u[self._inputs]

    def _rub_jointly(
        self, now: Instant, mode: Mode, stuck: list[int], held: list[int], checked: bool
    ) -> None:
        """The same where friction efforts act back on slips or laws at once: all solved together."""
        coupled = list(self._program.coupled.inputs)

        def residual(at: Instant) -> Array:
            left = at.u[self._inputs] - self._against(at, mode, checked)
            if stuck:
                hold = self.hold(mode, at.numbers)
                rule = hold.X @ at.x + hold.U @ at.u + hold.V @ at.du
                left[stuck] = np.concatenate([rule, hold.share @ at.u[held]])
            return np.concatenate([left, at.u[coupled] - self._coupled(at)])

        names = [port.name for port in self._program.friction] + list(self._program.coupled.ports)
        columns = self._inputs + coupled
        rows = self._readings + list(self._program.coupled.readings)
        solve_loop(now, columns, rows, now.numbers.D, residual, names)
        if stuck and len(share := self.hold(mode, now.numbers).share):
            fair = fair_share(now.u[held], share, now.caps[stuck])
            now.give(held, fair - now.u[held], now.numbers.D)

    def _against(self, now: Instant, mode: Mode, checked: bool) -> Array:
        """Slipping ports' efforts, zero at sticking ones; notes every port's breakaway effort."""
        values = self._friction(now)
        if checked and (values < 0).any():
            values = without_rounding(values, self._terms(now))
        levels, caps, curves, at_rest = values.reshape(-1, 4).T
        if checked:
            self._check_friction(now.t, levels, caps, curves, at_rest)
        now.caps = caps
        efforts: Array = levels * curves * np.array(mode, dtype=float)
        return efforts

    def _check_friction(
        self, t: float, levels: Array, caps: Array, curves: Array, at_rest: Array
    ) -> None:
        """Refuse friction that would drive, or hold less than it brakes at standstill."""
        wrong = (levels < 0) | (curves < 0) | (caps < levels * at_rest * (1 - TUNING.breakaway))
        if wrong.any():
            at = int(np.argmax(wrong))
            raise SimulationError(
                f"at t = {t:g} the friction at {self._program.friction[at].name!r} has level "
                f"{levels[at]:g}, curve {curves[at]:g} and breakaway effort {caps[at]:g}: level and "
                "curve must not be negative, the breakaway not below the friction at standstill"
            )

    def _check_differentiable(self, found: Hold) -> None:
        """Refuse to stick where the slope of a law that the system rules would be needed."""
        allowed = {*self._outside, *self._program.known.inputs, *self._inputs}
        for column in np.flatnonzero(
            np.abs(found.V).max(axis=0, initial=0.0) > TUNING.nothing_held
        ):
            if column not in allowed:
                names = ", ".join(repr(self._program.friction[i].name) for i in found.ports)
                raise SlopeNeededError(
                    f"holding {names} would need the slope in time of {self._program.inputs[column]}, "
                    "which a law gives; put a storage between"
                )

    def correction(self, mode: Mode, rate: Array, du: Array, numbers: Numbers) -> Array:
        """What rounding in the holding efforts has to be added to rates, or slips that stick would drift."""
        change = np.zeros_like(rate)
        if 0 in mode:
            held, n = self.hold(mode, numbers), len(self._program.states)
            fixed = held.slip_u + (0.0 if self._program.varying else held.slip_x @ numbers.R)
            change[:n] = held.take_away @ (held.slip_x @ rate[:n] + fixed @ du)
        return change
