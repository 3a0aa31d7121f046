"""One row of one tool in a process of its own, with a limit of time."""

import json
import os
import subprocess
import tempfile
from pathlib import Path
from typing import Any

from .worker import OVER

HERE = Path(__file__).resolve().parent

PATIENCE = 3.0
"""Of the clock, over the limit."""


def asked(python: str, tool: str, row: str, spec: dict[str, Any], seconds: float) -> dict[str, Any]:
    """What a tool's script could say before it ended, by itself or after too long a time.

    What `worker.py` prints, as far as it came; or ``cannot``, ``error``, ``over``. The limit is in seconds of
    a processor, and a few times that by the clock.
    """
    command = [python, "-I", str(HERE / "worker.py"), str(HERE / "scripts" / f"{tool}.py"), row]
    # Nothing that a run before compiled is there.
    with tempfile.TemporaryDirectory() as cache:
        options: dict[str, Any] = {"env": {**os.environ, "XDG_CACHE_HOME": cache}, "cwd": cache}
        options |= {
            "input": json.dumps(spec),
            "text": True,
            "timeout": PATIENCE * seconds,
            "check": False,
        }
        try:
            done = subprocess.run([*command, str(seconds)], capture_output=True, **options)
        except subprocess.TimeoutExpired as over:
            return {**latest((over.stdout or b"").decode()), "over": seconds}
    if done.returncode == OVER:
        return {**latest(done.stdout), "over": seconds}
    failed = done.stderr.strip() if done.returncode else ""
    known = latest(done.stdout)
    if failed and not {"error", "cannot"} & set(known):
        known["error"] = failed.splitlines()[-1]
    return known


def latest(said: str) -> dict[str, Any]:
    """The last of a worker's lines after the word RESULT; nothing if there is none.

    >>> latest('hello\\nRESULT {"prepare": 1}\\nRESULT {"prepare": 1, "first": 2}\\nbye')
    {'prepare': 1, 'first': 2}
    """
    results = [line for line in said.splitlines() if line.startswith("RESULT ")]
    return dict(json.loads(results[-1].removeprefix("RESULT "))) if results else {}
