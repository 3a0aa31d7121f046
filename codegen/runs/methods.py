"""The methods that a run may be integrated by; another one is another line."""

from functools import partial
from typing import Any

import scipy

from codegen.runs.explicit import explicit
from codegen.runs.sundials import Cvode

METHODS: dict[str, tuple[str, str]] = {
    "auto": ("DOP853", "Radau"),
    "DOP853": ("DOP853", "DOP853"),
    "Radau": ("Radau", "Radau"),
    "CVODE": ("Adams", "BDF"),
}
"""The integrator of each method by name: where the model is not stiff, and where it is."""

EXACT = "exact"
"""The method of models that are affine in each friction mode: no integrator, matrix exponentials."""

CHOICES = (EXACT, *METHODS)
"""What a run's method may be."""


def integrator(name: str) -> Any:
    """What makes the solver of a stretch: CVODE's, or scipy's class, which is loaded when first asked for."""
    if name in METHODS["CVODE"]:
        return partial(Cvode, name)
    return explicit() if name == "DOP853" else getattr(scipy.integrate, name)
