"""`Kind`: the kinds of node, and the one table of what each of them is."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal

Role = Literal[
    "source", "storage", "resistance", "switch", "detector", "transformer", "gyrator", "junction",
    "signal",
]  # fmt: skip

_BOUNDED = ("low", "high", "restitution", "start", "stiffness", "damping")

BOUNDS = {"low": 1, "high": -1}
"""The bounds of a stop, and which way its flow leads off each."""

POSITION = "position"
"""The part of a stop that integrates its flow."""

EXPRESSIONS = ("value", "energy", "inverse", "on", "off", "rate", "falling", "time", *_BOUNDED)
"""The attributes that are numbers or expressions."""

_KEPT = ("states", "update", "outputs")

NAMED = (*_KEPT, "transitions")
"""The attributes that map names to expressions; those of transitions are no signals."""

INSTANTS = ("every", "offset")
"""The attributes that are numbers of seconds."""

_SWITCHED = frozenset({"on", "off", "reset"})
_NAMED = frozenset({"value", "effort", "flow", "law", "unit", "ports"})
_STORED = _NAMED | {"inverse", "energy", "priority", "start"}


@dataclass(frozen=True)
class Nature:
    """What a kind of node is; all that depends on the kind is read from here."""

    role: Role
    #: The attributes that a node may carry beside ``kind``.
    keys: frozenset[str]
    #: What it gives of itself, "effort" or "flow": sources and detectors always, storages where they can.
    gives: str = ""
    #: What the bonds of a junction have in common, "effort" or "flow".
    common: str = ""
    #: Stands for a junction in drawings, and begins its name in sentences: a 0-junction, a 1-junction.
    digit: str = ""
    #: Begins the name of the state that a storage's law has: a momentum p, a displacement q.
    letter: str = ""
    #: Which one-port is first to lie beside its junction in a drawing.
    place: int = 0


class Kind(StrEnum):
    """The kinds of node; the plain-dict form has their text as ``kind``; "0" and "1" are junctions, too.

    Raises `ValueError` for a text that is no kind.

    >>> Kind("I").stores, Kind("I").gives, Kind("C").letter, Kind("Zero").common, str(Kind("1"))
    (True, 'flow', 'q', 'effort', 'One')
    """

    nature: Nature

    SE = "Se", Nature("source", frozenset({"value", "flow", "unit"}), gives="effort", place=6)
    SF = "Sf", Nature("source", frozenset({"value", "effort", "unit"}), gives="flow", place=5)
    I = "I", Nature("storage", _STORED, gives="flow", letter="p")  # noqa: E741  the field's own letter
    C = "C", Nature("storage", _STORED, gives="effort", letter="q", place=1)
    R = "R", Nature("resistance", _NAMED | {"gives"}, place=7)
    TF = "TF", Nature("transformer", frozenset({"value", "unit"}))
    GY = "GY", Nature("gyrator", frozenset({"value", "unit"}))
    ZERO = (
        "Zero",
        Nature("junction", frozenset({"effort", *_SWITCHED}), common="effort", digit="0"),
    )
    ONE = "One", Nature("junction", frozenset({"flow", *_SWITCHED}), common="flow", digit="1")
    DE = (
        "De",
        Nature(
            "detector", frozenset({"effort", "integrate", "start", "unit"}), gives="flow", place=4
        ),
    )
    DF = (
        "Df",
        Nature(
            "detector", frozenset({"flow", "integrate", "start", "unit"}), gives="effort", place=3
        ),
    )
    STOP = "Stop", Nature("switch", frozenset({"flow", "reset", *_BOUNDED}), place=8)
    SW = "Sw", Nature("switch", frozenset({"effort", "flow", *_SWITCHED}), place=2)
    FUNCTION = "Function", Nature("signal", frozenset({"value", "unit", "ports"}), place=9)
    STATE = (
        "State",
        Nature("signal", frozenset({"rate", "start", "low", "high", "unit", "ports"}), place=10),
    )
    CONTROLLER = (
        "Controller",
        Nature("signal", frozenset({*INSTANTS, "reads", "step", "ports", *_KEPT}), place=11),
    )
    MACHINE = (
        "StateMachine",
        Nature(
            "signal",
            frozenset({"modes", "initially", "transitions", "states", "reset", "ports"}),
            place=12,
        ),
    )
    HYSTERESIS = (
        "Hysteresis",
        Nature(
            "signal", frozenset({"value", "low", "high", "off", "on", "unit", "ports"}), place=12
        ),
    )
    RATE_LIMITER = (
        "RateLimiter",
        Nature(
            "signal", frozenset({"value", "rate", "falling", "start", "unit", "ports"}), place=13
        ),
    )
    DELAY = (
        "Delay",
        Nature("signal", frozenset({"value", "time", "start", "unit", "ports"}), place=14),
    )

    def __new__(cls, text: str, nature: Nature | None = None) -> "Kind":
        """One of the rows above; ``Kind("I")`` looks one up and makes none."""
        if nature is None:
            raise TypeError(f"the kind {text!r} has no nature")
        kind = str.__new__(cls, text)
        kind._value_, kind.nature = text, nature
        return kind

    @classmethod
    def _missing_(cls, value: object) -> "Kind | None":
        """The junction that a digit stands for."""
        return next(
            (kind for kind in cls if kind.nature.digit and kind.nature.digit == value), None
        )

    @property
    def supplies(self) -> bool:
        """Whether it is a source."""
        return self.nature.role == "source"

    @property
    def stores(self) -> bool:
        """Whether it holds energy as a function of its state."""
        return self.nature.role == "storage"

    @property
    def resists(self) -> bool:
        """Whether effort and flow determine each other at once, by a value or by a law."""
        return self.nature.role == "resistance"

    @property
    def switches(self) -> bool:
        """Whether it is an ideal switch."""
        return self.nature.role == "switch"

    @property
    def detects(self) -> bool:
        """Whether it only reads, and takes no power."""
        return self.nature.role == "detector"

    @property
    def gyrates(self) -> bool:
        """Whether it turns efforts into flows and flows into efforts."""
        return self.nature.role == "gyrator"

    @property
    def signals(self) -> bool:
        """Whether it has no power at all: a function of signals, a state or a controller."""
        return self.nature.role == "signal"

    @property
    def two_port(self) -> bool:
        """Whether it passes power on from one bond to another."""
        return self.nature.role in ("transformer", "gyrator")

    @property
    def joins(self) -> bool:
        """Whether it is a junction."""
        return self.nature.role == "junction"

    @property
    def one_port(self) -> bool:
        """True for everything but transformers, gyrators, junctions and signals."""
        return not (self.two_port or self.joins or self.signals)

    @property
    def absorbs(self) -> bool:
        """Whether power counts into it whichever way the arrow points."""
        return self.one_port and not self.supplies

    @property
    def gives(self) -> str:
        """What it gives of itself, "effort" or "flow"; of kinds that choose freely an empty text."""
        return self.nature.gives

    @property
    def common(self) -> str:
        """What the bonds of a junction have in common, "effort" or "flow"; else an empty text."""
        return self.nature.common

    @property
    def symbol(self) -> str:
        """What stands for it in a drawing."""
        return self.nature.digit or str(self)

    @property
    def word(self) -> str:
        """What a sentence calls it."""
        return f"{self.nature.digit}-junction" if self.joins else str(self)

    @property
    def letter(self) -> str:
        """The letter of a storage's own state, p or q; else an empty text."""
        return self.nature.letter


SIGNALS = frozenset(str(kind) for kind in Kind if kind.signals)
"""The kinds of node without power, as texts."""
