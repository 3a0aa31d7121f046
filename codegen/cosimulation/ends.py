"""Ends of connections: a signal of a participant, written ``"plant.omega"``."""

from collections.abc import Collection, Iterable, Sequence
from typing import NamedTuple

from bondgraph.errors import SignalError, nearest

MOST = 20
"""So many names are listed."""


class End(NamedTuple):
    """A signal of a participant."""

    part: str
    signal: str

    def __str__(self) -> str:
        return f"{self.part}.{self.signal}"


def end_of(text: object, parts: Collection[str], what: str) -> End:
    """What a text names; `SignalError` with the participants that there are.

    >>> end_of("plant.z.high", ["plant"], "a connection")
    End(part='plant', signal='z.high')
    """
    if not isinstance(text, str) or "." not in text:
        raise SignalError(
            f"{what}: {text!r} names no signal of a participant; write it as 'participant.signal'"
        )
    part, _, signal = text.partition(".")
    if part not in parts:
        raise SignalError(
            f"{what} {text!r}: there is no participant {part!r}{nearest(part, parts)}; there are "
            f"{', '.join(parts)}"
        )
    return End(part, signal)


def known_signal(end: End, known: Iterable[str], what: str, kind: str) -> None:
    """Refuse a signal that the participant does not have."""
    names = [*known]
    if end.signal not in names:
        raise SignalError(
            f"{what} {str(end)!r}: {end.part!r} has no {kind} {end.signal!r}"
            f"{nearest(end.signal, names)}; it has {listed(names)}"
        )


def listed(names: Sequence[str]) -> str:
    """Names as a message lists them; of many those in front, and how many more.

    >>> listed(["u", "v"]), listed([])
    ('u, v', 'none')
    """
    more = f" and {len(names) - MOST} more" if len(names) > MOST else ""
    return (", ".join(names[:MOST]) or "none") + more
