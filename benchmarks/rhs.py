"""Nanoseconds an evaluation of the rates takes in exported C, beside the same by hand.

The active limited slip differential with halfshafts, six states; the hand-written rates are those of
``floor/fig11_floor.c``. ``python benchmarks/rhs.py``; ``CC`` and ``CFLAGS`` change the compiler.
"""

import os
import shlex
import subprocess
import tempfile
from pathlib import Path

import bondgraph as bg
from codegen import to_c
from differentials.model import model
from differentials.topologies import graph

HERE = Path(__file__).parent
FLAGS = "-O3 -march=native -ffp-contract=fast -std=c99 -D_POSIX_C_SOURCE=199309L"


def _files(damped: bool) -> dict[str, str]:
    """The export; without the halfshafts' dampers it has the terms of the hand-written rates."""
    full = model("alsd")
    values = {symbol: one.value for symbol, one in full.parameters.items()}
    values |= {"omega_t1_0": 80.0, "omega_t2_0": 82.0}
    equations = full.equations
    if not damped:
        plain = graph("alsd", halfshafts=True)
        plain.remove_nodes_from([n for n, a in plain.nodes(data=True) if a.get("value") == "b"])
        equations = bg.derive(plain, outputs=["clutch"])
        del values["b"]
    return to_c(equations, values, full.laws, name="alsd")


def _measured(damped: bool) -> list[float]:
    """Nanoseconds by hand, generated and by a full evaluation; the largest difference
    over the largest rate."""
    with tempfile.TemporaryDirectory() as folder:
        files = _files(damped)
        for name, text in files.items():
            Path(folder, name).write_text(text, encoding="utf-8")
        sources = [str(Path(folder, name)) for name in files if name.endswith(".c")]
        sources += [str(HERE / "rhs.c"), str(HERE / "floor" / "fig11_floor.c")]
        compiler, flags = os.environ.get("CC", "cc"), shlex.split(os.environ.get("CFLAGS", FLAGS))
        program = str(Path(folder, "rhs"))
        include = ["-I", folder, "-I", str(HERE / "floor")]
        command = [compiler, *flags, *include, *sources, "-o", program, "-lm", "-pthread"]
        subprocess.run(command, check=True)
        done = subprocess.run([program], capture_output=True, text=True, check=True)
    return [float(word) for word in done.stdout.split()]


def main() -> None:
    print(
        f"{'ns a call':<28}{'by hand':>10}{'generated':>11}{'ratio':>8}{'evaluate':>10}{'differ':>10}"
    )
    for damped in (False, True):
        hand, straight, full, apart = _measured(damped)
        name = "with damped halfshafts" if damped else "the same terms"
        ratio = straight / hand
        print(f"{name:<28}{hand:>10.2f}{straight:>11.2f}{ratio:>8.2f}{full:>10.0f}{apart:>10.1g}")


if __name__ == "__main__":
    main()
