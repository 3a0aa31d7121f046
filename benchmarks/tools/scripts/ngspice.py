"""ngspice, in a process of its own for each run, which reads a netlist."""

import re
import subprocess
import tempfile
from pathlib import Path
from typing import Any

CONTROL = """.control
set wr_singlescale
set wr_vecnames
option numdgt=15
run
wrdata table.txt {}
.endc
.end
"""


def prepare(spec: dict[str, Any]) -> Any:
    """The netlist with what writes the capacitors' voltages."""
    vectors = " ".join(f"v(n{k})" for k in range(1, spec["sections"] + 1))
    return spec["netlist"].replace(".end\n", CONTROL.format(vectors))


def run(deck: str) -> Any:
    """Its steps, and the seconds that it says its analysis took."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "circuit.cir"
        path.write_text(deck, encoding="utf-8")
        done = subprocess.run(
            ["ngspice", "-b", str(path)], capture_output=True, text=True, check=False, cwd=folder
        )
        table = Path(folder) / "table.txt"
        if not table.exists():
            raise RuntimeError((done.stdout + done.stderr).strip()[-200:])
        rows = [list(map(float, line.split())) for line in table.read_text().splitlines()[1:]]
    told = re.search(r"Total analysis time \(seconds\) = ([\d.e-]+)", done.stdout)
    return rows, float(told[1]) if told else None


def told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Its own times and voltages."""
    rows, seconds = found
    return {
        "times": [row[0] for row in rows],
        "values": [row[1:] for row in rows],
        "inner": seconds,
    }


ROWS = {"ladder": (prepare, run, told)}
CANNOT = {
    "chain": "circuits only",
    "clutch": "circuits only",
    "sweep": "circuits only",
    "gradient": "circuits only",
}
