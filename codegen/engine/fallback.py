"""Why C does not run what it was asked to, and the warning that tells so."""

import warnings
from collections import Counter
from dataclasses import dataclass

from bondgraph.errors import ModelWarning
from codegen.model.outside import outside


class BackendWarning(ModelWarning):
    """A run that was asked of compiled C is done by numpy, which is slower; the message tells why."""


@dataclass(frozen=True)
class Stopped:
    """Why C gave a run up, and when [s]; ``limit``: the limit is C's alone, so that numpy goes on."""

    reason: str
    time: float | None = None
    limit: bool = False

    def __str__(self) -> str:
        return self.reason if self.time is None else f"{self.reason}, at {self.time:.9g} s"


def tell(stopped: Stopped) -> None:
    """Warn, at the user's line."""
    text = f"numpy runs what backend 'c' was asked to: {stopped}"
    warnings.warn(text, BackendWarning, stacklevel=outside())


def tell_all(reasons: Counter[str], runs: int) -> None:
    """Warn once of a sweep's runs that C did not do, with what was said of them and how often."""
    count = reasons.total()
    if count:
        parts = "; ".join(f"{often} of them: {why}" for why, often in sorted(reasons.items()))
        text = f"numpy did {count} of {runs} runs that backend 'c' was asked to do: {parts}"
        warnings.warn(text, BackendWarning, stacklevel=3)
