"""An environment of its own for each package that is measured, in ``.peers/``.

What is wanted stands in a requirement file with a version for each package. A first line ``# python >= 3.12``
asks for a Python that is newer than the one that runs this, which is looked for.
"""

import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ENVIRONMENTS = Path(__file__).resolve().parents[2] / ".peers"
NEWEST = 14
"""The newest 3.x that is looked for."""


def installed(name: str, wanted: Path) -> str:
    """Make an environment if there is none; what went wrong in words, or nothing."""
    folder, told = ENVIRONMENTS / name, wanted.read_text(encoding="utf-8")
    ready = folder / "ready"
    if ready.exists() and ready.read_text(encoding="utf-8") == told:
        return ""
    ready.unlink(missing_ok=True)
    python = interpreter(minor(told))
    if python is None:
        return f"not installed: no Python 3.{minor(told)} or newer here"
    # All versions are pinned, so nothing else is asked of them.
    pip = ["-m", "pip", "install", "--quiet", "--no-deps", "--ignore-requires-python", "-r"]
    for command in (
        [python, "-m", "venv", "--clear", str(folder)],
        [str(folder / "bin" / "python"), *pip, str(wanted)],
    ):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            return f"not installed: {complaint(done.stderr)}"
    ready.write_text(told, encoding="utf-8")
    return ""


def complaint(said: str) -> str:
    """The line that tells what is wrong of what pip said.

    >>> complaint("WARNING: slow\\nERROR: No matching distribution\\n")
    'ERROR: No matching distribution'
    """
    every = said.splitlines()
    return ([line for line in every if line.startswith("ERROR")] or every or ["no message"])[0]


def minor(told: str) -> int:
    """The oldest 3.x that a requirement file asks for; 0 where it does not.

    >>> minor("# python >= 3.12\\nmodelica==1.0\\n"), minor("rumoca==1.0\\n")
    (12, 0)
    """
    found = re.match(r"# python >= 3\.(\d+)\n", told)
    return int(found[1]) if found else 0


def interpreter(least: int) -> str | None:
    """This Python, or the first that runs of those that are new enough."""
    if sys.version_info >= (3, least):
        return sys.executable
    for python in candidates(least):
        asked = [python, "-c", "import venv, ensurepip"]
        if not subprocess.run(asked, capture_output=True, check=False).returncode:
            return python
    return None


def candidates(least: int) -> Iterator[str]:
    """Pythons on the path, and those that pyenv keeps."""
    for version in range(least, NEWEST + 1):
        if found := shutil.which(f"python3.{version}"):
            yield found
        kept = Path.home().glob(f".pyenv/versions/3.{version}.*/bin/python")
        yield from sorted(map(str, kept))
