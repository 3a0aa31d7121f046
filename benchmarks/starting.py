"""The first seconds of work, beside importing what everything rests on.

``python benchmarks/starting.py``: seconds are the least of some processes, each on its own and taken in
turns; the ratio is to `import sympy, networkx` alone. What compiles begins with an empty cache.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]

TURNS, BUILDS = 9, 3
"""Processes of each; of those that compile."""

BASE = "import sympy, networkx"

CASE = (
    "from differentials.scenarios import prepared; case = prepared('alsd', 'fig11')\n"
    "args = case.equations, case.parameters, case.laws\n"
)

LINES = {
    BASE: BASE,
    "import bondgraph": "import bondgraph",
    "import codegen": "import codegen",
    "bondgraph --help": "from differentials.__main__ import main; main(['--help'])",
    "bondgraph list": "from differentials.__main__ import main; main(['list'])",
    "derive a first graph": (
        "import bondgraph as bg\n"
        "g = bg.graph([bg.Se('F', 'F'), bg.One('j'), bg.I('m', 'm', flow='v')], 'F > j > m')\n"
        "print(bg.derive(g))"
    ),
}

BUILT = {
    "Fig. 11 by numpy": CASE
    + "import codegen; codegen.simulator(*args).run(case.times, case.initial, case.inputs)",
    "Fig. 11 by C, first": CASE
    + "import codegen; codegen.simulator(*args, backend='c').run(case.times, case.initial, case.inputs)",
    "the same with magic formula tires": (
        "import differentials as d; from differentials.scenarios import simulate\n"
        "laws = {'tire_1': d.magic_formula_tire(1), 'tire_2': d.magic_formula_tire(2)}\n"
        "simulate('alsd', 'fig11', backend='c', laws=laws)"
    ),
    "Fig. 11 as a unit": CASE
    + "import codegen; codegen.write_fmu('unit.fmu', *args, initial=case.initial, inputs=case.inputs)",
}


def seconds(lines: str, folder: Path) -> float:
    """How long a process takes, with nothing compiled before."""
    shutil.rmtree(folder / "cache", ignore_errors=True)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(folder / "cache")}
    begin = time.perf_counter()
    subprocess.run(
        [sys.executable, "-c", lines], env=environment, cwd=folder, check=True, capture_output=True
    )
    return time.perf_counter() - begin


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as folder:
        took: dict[str, list[float]] = {name: [] for name in (*LINES, *BUILT)}
        for turn in range(TURNS):
            for name, lines in (LINES | BUILT if turn < BUILDS else LINES).items():
                took[name].append(seconds(lines, Path(folder)))
    base = min(took[BASE])
    for name, found in took.items():
        print(f"{name:36s} {min(found):6.2f} s  {min(found) / base:5.2f} x")


if __name__ == "__main__":
    main()
