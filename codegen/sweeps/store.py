"""Finished runs in a folder, so that a sweep can be continued."""

import json
import os
import secrets
import zipfile
from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from bondgraph.errors import StoreError
from bondgraph.writing import made_folder, replacing, write_bytes
from codegen.numbers.arrays import Array
from codegen.sweeps.chunks import Outcome

FORMAT = {"format": "bondgraph-sweep", "version": 1}
ABOUT = "sweep.json"


class Store:
    """A folder with a file for each finished chunk, and one that tells which sweep they belong to.

    ``about``: what identifies the sweep. Files appear whole or not at all.

    Raises `StoreError` for a folder of another sweep, or of other files, `WriteError` for one that
    cannot be written to.
    """

    def __init__(self, folder: str | PathLike[str], about: dict[str, Any]) -> None:
        self._folder = Path(folder)
        self._runs, self._width = int(about["runs"]), len(about["measures"])
        made_folder(self._folder)
        written = json.dumps({**FORMAT, **about}, indent=1)
        place = self._folder / ABOUT
        if place.exists():
            self._check(place, json.loads(written))
        elif any(not name.endswith(".tmp") for name in os.listdir(self._folder)):
            raise StoreError(
                f"{self._folder} holds other files; give the sweep a folder of its own"
            )
        else:
            write_bytes(place, written.encode())

    def _check(self, place: Path, about: dict[str, Any]) -> None:
        try:
            found = json.loads(place.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise StoreError(f"{place} cannot be read: {error}") from None
        if not isinstance(found, dict) or found.get("format") != FORMAT["format"]:
            raise StoreError(f"{place} does not belong to a sweep; choose another folder")
        names = [*about, *(name for name in found if name not in about)]
        other = [name for name in names if found.get(name) != about.get(name)]
        if other:
            raise StoreError(
                f"{self._folder} holds another sweep, which differs in {', '.join(other)}; choose "
                "another folder, or remove this one"
            )

    def finished(self) -> Iterator[Outcome]:
        """What is there from earlier; `StoreError` for a file that cannot be read."""
        for place in sorted(self._folder.glob("runs-*.npz")):
            try:
                yield self._read(place)
            except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile):
                raise StoreError(
                    f"{place} cannot be read; remove it, and its runs are done again"
                ) from None

    def _read(self, place: Path) -> Outcome:
        with place.open("rb") as raw, np.load(raw, allow_pickle=False) as file:
            about, values = json.loads(str(file["about"])), file["values"]
        results: list[tuple[Array, ...] | str] = []
        start = 0
        for found in about["results"]:
            if isinstance(found, str):
                results.append(found)
                continue
            if len(found) != self._width:
                raise ValueError
            parts = []
            for shape in found:
                size = int(np.prod(shape, dtype=int))
                parts.append(values[start : start + size].reshape(shape))
                start += size
            results.append(tuple(parts))
        indices = tuple(about["indices"])
        if len(indices) != len(results) or not all(0 <= index < self._runs for index in indices):
            raise ValueError
        completed = {int(index): own for index, own in about.get("completed", {}).items()}
        return Outcome(indices, tuple(results), 0.0, (), completed)

    def keep(self, outcome: Outcome) -> None:
        """Write a finished chunk."""
        indices = [int(index) for index in outcome.indices]
        results = [
            found if isinstance(found, str) else [part.shape for part in found]
            for found in outcome.results
        ]
        parts = [
            part.ravel()
            for found in outcome.results
            if not isinstance(found, str)
            for part in found
        ]
        told = {int(index): dict(own) for index, own in outcome.completed.items()}
        about = json.dumps(
            {"indices": indices, "results": results, **({"completed": told} if told else {})}
        )
        name = f"runs-{min(indices):09d}-{secrets.token_hex(4)}.npz"
        with replacing(self._folder / name) as file:
            np.savez(file, about=np.array(about), values=np.concatenate([np.zeros(0), *parts]))
