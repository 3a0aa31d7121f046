"""The methods that a run may be integrated by; another one is another line."""

from functools import partial
from typing import Any

from scipy.integrate import DOP853, Radau

from codegen.runs.sundials import Cvode

METHODS: dict[str, tuple[Any, Any]] = {
    "auto": (DOP853, Radau),
    "DOP853": (DOP853, DOP853),
    "Radau": (Radau, Radau),
    "CVODE": (partial(Cvode, "Adams"), partial(Cvode, "BDF")),
}
"""The integrator of each method: where the model is not stiff, and where it is."""

EXACT = "exact"
"""The method of models that are affine in each friction mode: no integrator, matrix exponentials."""

CHOICES = (EXACT, *METHODS)
"""What a run's method may be."""
