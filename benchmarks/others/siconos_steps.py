"""Siconos's time stepping of a linear complementarity or relay system, by the Python that has it.

Reads JSON of standard input: ``x' = A x + B l``, ``y = C x + D l`` with ``0 <= y``, ``0 <= l``,
``y l = 0``; or, where there are ``limits``, l within minus and plus these, at the one against y where y is
not zero. Writes x after every so many steps of h, which are implicit ones of Euler.
"""

import json
import sys

import numpy as np
import siconos.kernel as sk


def main() -> None:
    """One run."""
    told = json.load(sys.stdin)
    A, B, C, D = (np.array(told[name], dtype=float) for name in "ABCD")
    size, h, count, every = len(C), told["h"], told["count"], told["every"]
    system = sk.FirstOrderLinearTIDS(np.array(told["x"], dtype=float), A)
    if told["limits"]:
        law, solver = sk.RelayNSL(size, -1.0, 1.0), sk.Relay()
        B, D = B * told["limits"], D * told["limits"]
    else:
        law, solver = sk.ComplementarityConditionNSL(size), sk.LCP()
    relation = sk.FirstOrderLinearTIR(C, B)
    relation.setDPtr(D)
    model = sk.NonSmoothDynamicalSystem(0.0, h * count)
    model.insertDynamicalSystem(system)
    model.link(sk.Interaction(law, relation), system)
    run = sk.TimeStepping(model, sk.TimeDiscretisation(0.0, h), sk.EulerMoreauOSI(1.0), solver)
    rows = [system.x().tolist()]
    for k in range(count):
        run.computeOneStep()
        if (k + 1) % every == 0:
            rows.append(system.x().tolist())
        run.nextStep()
    json.dump(rows, sys.stdout)


if __name__ == "__main__":
    main()
