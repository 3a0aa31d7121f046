"""The differential as blocks of Jaxonomy, their rates by hand."""

from typing import Any

import jax.numpy as jnp
import jaxonomy as jx

from .jax_rates import START, clutched, hold, opened


class Clutched(jx.LeafSystem):  # type: ignore[misc]
    """With its clutch; modes are slip backwards, stuck, slip forwards."""

    def __init__(self, spec: dict[str, Any]) -> None:
        super().__init__(name="driveline")
        self.p, self.spec = spec["numbers"], spec
        self.declare_default_mode(0)
        self.declare_continuous_state(default_value=jnp.array([*START, 0.0]), ode=self.rates)
        self.declare_continuous_state_output(name="x")
        self.declare_mode_output()
        falls = {"direction": "positive_then_non_positive"}
        for mode, sign in ((0, -1.0), (2, 1.0)):
            self.declare_zero_crossing(self.slip(sign), start_mode=mode, end_mode=1, **falls)
        for mode, sign in ((0, -1.0), (2, 1.0)):
            self.declare_zero_crossing(self.margin(sign), start_mode=1, end_mode=mode, **falls)

    def slip(self, sign: float) -> Any:
        """Of a sign, beyond rounding."""
        return lambda time, state, **_: (
            sign * (state.continuous_state[0] - state.continuous_state[1]) / 2 + 1e-9
        )

    def margin(self, sign: float) -> Any:
        """Of what the clutch holds."""
        return lambda time, state, **_: (
            state.continuous_state[7] - sign * hold(self.p, state.continuous_state)
        )

    def rates(self, time: Any, state: Any, **_: Any) -> Any:
        """Of all states."""
        p, y = self.p, state.continuous_state
        friction = jnp.where(state.mode == 1, hold(p, y), (state.mode - 1.0) * y[7])
        demand_e = jnp.where(time >= self.spec["step_e"], p["torque_e"], 0.0)
        demand_h = jnp.where(time >= self.spec["step_h"], p["torque_h"], 0.0)
        return clutched(p, y, friction, demand_e, demand_h)


class Open(jx.LeafSystem):  # type: ignore[misc]
    """Without its clutch; stiffness and wheel inertia are parameters."""

    def __init__(self, spec: dict[str, Any]) -> None:
        super().__init__(name="driveline")
        self.spec = spec
        for name in ("k", "I_w"):
            self.declare_dynamic_parameter(name, spec["numbers"][name])
        self.declare_continuous_state(default_value=jnp.array(START), ode=self.rates)
        self.declare_continuous_state_output(name="x")

    def rates(self, time: Any, state: Any, k: Any = None, I_w: Any = None, **_: Any) -> Any:
        """Of all states."""
        p = {**self.spec["numbers"], "k": k, "I_w": I_w}
        return opened(p, state.continuous_state, self.spec["linear"])
