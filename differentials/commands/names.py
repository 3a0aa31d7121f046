"""Names that are typed: near misses, and parameter types of click that know and complete them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem

import bondgraph as bg
from bondgraph.errors import nearest

MOST = 20
"""Names that a message lists."""


def listed(known: Sequence[str]) -> str:
    """Names in a row, as many as one line of a message bears.

    >>> listed([]), listed(["a", "b"])
    ('none', 'a, b')
    """
    more = len(known) - MOST
    return ", ".join(known[:MOST]) + (f" and {more} more" if more > 0 else "") or "none"


def check_names(given: Iterable[str], known: Sequence[str], what: str) -> None:
    """Refuse the first name that is not known, with the nearest one and all there are."""
    for name in given:
        if name not in known:
            raise bg.SignalError(
                f"no {what} is called {name!r}{nearest(name, known)}; there is {listed(known)}"
            )


class OneOf(click.ParamType):  # type: ignore[type-arg]
    """One of some names."""

    def __init__(self, names: Sequence[str], what: str) -> None:
        self.names, self.name = tuple(names), what

    def convert(self, value: Any, param: Any, ctx: Any) -> str:
        """The name itself, or a refusal with the nearest one."""
        check_names([value], self.names, self.name)
        return str(value)

    def shell_complete(self, ctx: Any, param: Any, incomplete: str) -> list[CompletionItem]:
        """The names that begin so."""
        return [CompletionItem(name) for name in self.names if name.startswith(incomplete)]


class Assigned(click.ParamType):  # type: ignore[type-arg]
    """``NAME=VALUE`` as a pair, the value converted; a ``ValueError`` tells that it can't be.

    ``told``: what else the conversion takes, by what was read before.
    """

    def __init__(
        self, form: str, example: str, convert: Callable[..., object],
        told: Callable[[Any], Mapping[str, Any]] = lambda ctx: {},
    ) -> None:  # fmt: skip
        self.name, self._example, self._convert, self._told = form, example, convert, told

    def convert(self, value: Any, param: Any, ctx: Any) -> tuple[str, object]:
        """The name and what stands behind the first equals sign."""
        if isinstance(value, tuple):
            return value
        name, equals, text = value.partition("=")
        message = f"{value!r} is not {self.name}, as in {self._example}"
        if not name.strip() or not equals:
            raise click.BadParameter(message, ctx, param)
        try:
            return name.strip(), self._convert(text.strip(), **self._told(ctx))
        except bg.BondGraphError as error:
            message = f"{name.strip()}: {error}"
        except ValueError:
            pass
        raise click.BadParameter(message, ctx, param)


class FileOf(click.Path):
    """A file to write whose ending says what is written."""

    def __init__(self, *endings: str) -> None:
        super().__init__(dir_okay=False, path_type=Path)
        self.endings = endings

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        """The path; refused before any work is done if it ends in something else."""
        path = Path(str(super().convert(value, param, ctx)))
        if path.suffix.lower() not in self.endings:
            *some, last = self.endings
            message = f"{str(path)!r} must end in {', '.join(some)} or {last}"
            raise click.BadParameter(message, ctx, param)
        return path
