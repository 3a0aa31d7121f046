"""Packages whose public names are imported as they are asked for, so that importing a package is quick."""

import ast
import sys
from importlib import import_module
from importlib.resources import files
from types import ModuleType
from typing import Any


class Offering(ModuleType):
    """A package that offers names of its modules: each is imported when it is first asked for."""

    _homes: dict[str, str]
    _beside: tuple[str, ...]

    def __getattr__(self, name: str) -> Any:
        """A public name from its home, or a module of this package."""
        home = self._homes.get(name)
        if home is not None:
            self.__dict__[name] = found = getattr(import_module(home), name)
            return found
        if not name.startswith("_"):
            inside = f"{self.__name__}.{name}"
            try:
                return import_module(inside)
            except ModuleNotFoundError as error:
                if error.name != inside:
                    raise
        raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")

    def __setattr__(self, name: str, value: object) -> None:
        """Importing a module of the package does not hide what is offered under its name."""
        if not (isinstance(value, ModuleType) and name in self._homes):
            super().__setattr__(name, value)

    def __dir__(self) -> list[str]:
        """What is public; the modules that hold it are found by their own imports."""
        return [*self.__all__, *self._beside]


def offer(package: str, beside: tuple[str, ...] = ()) -> list[str]:
    """Make a package offer what its stub, ``__init__.pyi``, imports; the public names.

    Type checkers and pages of the API read the stub, so there is one list. ``beside``: modules that
    are shown with them.

    >>> import bondgraph
    >>> offer("bondgraph") == bondgraph.__all__
    True
    """
    tree = ast.parse(files(package).joinpath("__init__.pyi").read_text(encoding="utf-8"))
    homes = {
        (alias.asname or alias.name): node.module
        for node in tree.body if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
    }  # fmt: skip
    module = sys.modules[package]
    module.__dict__.update(_homes=homes, _beside=beside)
    module.__class__ = Offering
    return sorted(homes)
