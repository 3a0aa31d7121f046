"""What an advance of a stepper takes beside the work: against one run in C whose inputs are held alike.

``python benchmarks/stepping.py``: microseconds of the processor a step of 1 ms, the fastest in turns.
The run is C's own call for an affine model, with all that Python does around it left out.
"""

import math
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent)]

import bondgraph as bg  # noqa: E402
from codegen import Simulator, Stepper, ZeroOrderHold, simulator  # noqa: E402
from codegen.engine.located import LocatedRuns  # noqa: E402
from codegen.runs.completion import Beginning  # noqa: E402
from codegen.runs.track import Settings  # noqa: E402
from codegen.taking.asked import Request  # noqa: E402
from codegen.taking.blocks import Whole  # noqa: E402
from codegen.taking.located import run_located  # noqa: E402

STEPS, STEP, TURNS = 3000, 1e-3, 9

FORCES = np.random.default_rng(1).uniform(-8, 8, STEPS).tolist()

HELD = ZeroOrderHold(values=FORCES, period=STEP)


def spring(drag: str | None) -> bg.StateEquations:
    """A mass between a force, a spring and a damper, or a drag."""
    loss = bg.R("drag", "c") if drag is None else bg.R("drag", law=drag, flow="v_d")
    nodes = [bg.Se("force", "F"), bg.One("j"), bg.I("m", 1, flow="v"), bg.C("k", "1/20"), loss]
    return bg.derive(bg.graph(nodes, "force > j > m", "j > k", "j > drag"))


def clutch() -> bg.StateEquations:
    """Two masses with dry friction between."""
    rub = bg.R("clutch", law=bg.DryFriction(2))
    nodes = [bg.Se("force", "F"), bg.One("a"), bg.I("m_1", 1, flow="v"), bg.Zero("gap"), rub]
    nodes += [bg.One("b"), bg.I("m_2", 2), bg.R("drag", "c")]
    paths = "force > a > m_1", "a > gap > clutch", "gap > b > m_2", "b > drag"
    return bg.derive(bg.graph(nodes, *paths))


def whole(ready: Simulator) -> Callable[[], object]:
    """One run of the same, as C is called."""
    times, start = np.array([0.0, STEPS * STEP]), np.eye(1, len(ready.states))[0]
    if ready.engine is not None:
        return ready.engine.prepare(times, start, [HELD], keeping=False).call
    runs = LocatedRuns(ready.closed, None if ready.located is None else ready.located.library)
    begun = Beginning(start, (), {}, start)
    asked = Request(times, start, begun, [HELD], Settings(), events=False)
    return lambda: run_located(runs, Whole(len(times)), asked)


def stepped(one: Stepper, told: bool = True, read: bool = False) -> None:
    """All steps; ``told``: with a force for each, ``read``: and a signal."""
    for force in FORCES:
        now = one.advance(STEP, F=force) if told else one.advance(STEP)
        if read:
            now["v"]


def took(what: Callable[[], object]) -> float:
    """Microseconds of the processor a step."""
    begin = time.process_time()
    what()
    return (time.process_time() - begin) / STEPS * 1e6


def measured(equations: bg.StateEquations) -> list[float]:
    """The run; advances; with a signal read of each; without other inputs."""
    ready = simulator(equations, {"c": 0.5}, backend="c")
    one, run, best = ready.stepper({"v": 1.0}, {"F": FORCES[0]}), whole(ready), [math.inf] * 4
    begin = one.state
    for _ in range(TURNS):
        found = [took(run)]
        for ways in ({}, {"read": True}, {"told": False}):
            one.restore(begin)
            found.append(took(lambda more=ways: stepped(one, **more)))
        best = list(map(min, best, found))
    return best


def main() -> None:
    """A line for each model."""
    print("us a step           run  advance   beside  with a signal  inputs as they were")
    models = {"affine": spring(None), "with a clutch": clutch(), "nonlinear": spring("c*v_d**3")}
    for name, equations in models.items():
        run, told, read, held = measured(equations)
        print(f"{name:15} {run:7.2f} {told:8.2f} {told - run:8.2f} {read:14.2f} {held:20.2f}")


if __name__ == "__main__":
    main()
