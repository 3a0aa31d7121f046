"""What can be refused, one class per stage; every message names the place, the rule and the way out.

What is done all the same, but should be looked at, is a `ModelWarning`.
"""

import difflib
from collections.abc import Iterable


class BondGraphError(ValueError):
    """Base of every refusal of this toolkit."""


class StructureError(BondGraphError):
    """The declaration is not a bond graph: a node, a bond or a name breaks a rule."""


class ExpressionError(StructureError):
    """A value or a law is not an expression the toolkit accepts."""


class CausalityError(BondGraphError):
    """No causality exists: what sources and fixed ports impose contradicts itself."""


class AlgebraicLoopError(BondGraphError):
    """A loop of bonds or resistances has a determinant that vanishes identically."""


class SingularStorageError(BondGraphError):
    """The storages do not determine their rates: the matrix A is singular."""


class DependentSourceError(BondGraphError):
    """A law or a step would have to be differentiated in time."""


class TableError(ExpressionError):
    """A lookup table's points, or what is asked of it, cannot be used."""


class ParameterError(BondGraphError):
    """A parameter is missing, is not a number, or leaves the equations without a solution."""


class SignalError(BondGraphError):
    """An input, an initial value or the time axis of a run is not usable."""


class FileFormatError(BondGraphError):
    """A file is not a bond graph's, or a graph holds what a file cannot say."""


class WriteError(BondGraphError, OSError):
    """A file cannot be written: no room, no right, or a folder in its place; the one before is kept."""


class MissingExtraError(BondGraphError):
    """A package that only an optional extra installs is missing."""


class StoreError(BondGraphError):
    """A folder holds other runs than those asked for, or a file in it cannot be read."""


class SimulationError(BondGraphError):
    """A run cannot go on; the message gives the time and the numbers."""


class UnitError(BondGraphError):
    """A functional mock-up unit of others cannot take part, or returned an error; the message has its log."""


class ModelWarning(UserWarning):
    """Base of this toolkit's warnings: what is run all the same, but should be looked at."""


def shortened(text: str) -> str:
    """A text as a message quotes it, cut where it is long."""
    return repr(text if len(text) <= 60 else text[:57] + "...")


def nearest(name: str, known: Iterable[str]) -> str:
    """A question after the name that was meant, or nothing.

    >>> nearest("alds", ["passive", "alsd"]), nearest("x", ["passive", "alsd"])
    (" (did you mean 'alsd'?)", '')
    """
    found = difflib.get_close_matches(name, list(known), n=1, cutoff=0.6)
    return f" (did you mean {found[0]!r}?)" if found else ""
