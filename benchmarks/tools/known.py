"""The tools that are measured: ours and others, and how a row is asked of one."""

import shutil
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import asking, environments

SCRIPTS = Path(__file__).resolve().parent / "scripts"

Found = dict[str, Any]


@dataclass(frozen=True)
class Tool:
    """What is shown of it; its script's name; the backend of ours; the Python that runs it."""

    title: str
    script: str
    backend: str = ""
    python: str = sys.executable
    trouble: str = ""


OURS = (Tool("ours, C", "ours", "c"), Tool("ours, numpy", "ours", "numpy"))
TITLES = {
    "rumoca": "Rumoca", "modelica": "modelica", "pymoca": "Pymoca and CasADi", "jaxonomy": "Jaxonomy",
    "diffrax": "Diffrax",
}  # fmt: skip


def tools() -> tuple[Tool, ...]:
    """Ours and all others, installed where they were not."""
    found = list(OURS)
    for name, title in TITLES.items():
        said = environments.installed(name, SCRIPTS / f"{name}.txt")
        python = str(environments.ENVIRONMENTS / name / "bin" / "python")
        found.append(Tool(title, name, python=python, trouble=said))
    missing = "" if shutil.which("ngspice") else "not installed (Debian's package ngspice)"
    return (*found, Tool("ngspice", "ngspice", trouble=missing))


def asked(tool: Tool, row: str, spec: Found, seconds: float) -> Found:
    """What a tool says to a row."""
    if tool.trouble:
        return {"error": tool.trouble}
    return asking.asked(tool.python, tool.script, row, {**spec, "backend": tool.backend}, seconds)
