"""The hand-written C: its files by folder, each under a name of its own, as exports lie flat."""

from functools import cache
from importlib.resources import files

FOLDERS = ("model", "ports", "run", "located", "exact", "paused", "batch", "lanes", "fmu")
"""Of `codegen/runtime`: evaluating a model; holding and choosing; the loop; steps with a tolerance; exact
steps; runs that pause; many runs; several of these side by side; units."""

SHARED = (
    "port_set.h", "port_log.h", "port_switch.h", "port_switch.c", "port_ways.h", "port_ways.c",
    "port_choosing.h", "port_bounce.c", "port_throw.c", "port_reset.c", "port_clock.c",
    "port_block.c", "port_choose.h", "port_choose.c", "port_verdict.c", "port_events.h", "port_events.c",
    "port_rounding.h",
)  # fmt: skip
"""Of ``ports`` what needs no model."""


@cache
def runtime_names(folder: str) -> tuple[str, ...]:
    """The files of a folder, in alphabetical order."""
    found = files("codegen").joinpath("runtime", folder).iterdir()
    return tuple(sorted(one.name for one in found if one.name.endswith((".c", ".h"))))


@cache
def runtime_file(name: str) -> str:
    """The text of a file, whatever folder it is in."""
    folder = next((one for one in FOLDERS if name in runtime_names(one)), ".")
    return files("codegen").joinpath("runtime", folder, name).read_text(encoding="utf-8")
