"""Circuits of ideal diodes and switches beside ngspice, whose diodes and switches are nearly ideal.

A diode there drops ``N Vt log(1 + i/IS)``: 0.8 mV at 10 A for an N of a thousandth. What that does is told by
a second run with 2 N: it is proportional to N, so that the two differ by as much as the first is off. A
switch has `CLOSED` when it is on and `OPEN` when it is off; steps are no longer than a `STEPS`-th of the run.
"""

import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from references.switched.named import (
    boost,
    bridge_chain,
    buck,
    full_bridge,
    half_bridge,
    opened_inductor,
    pulses,
    six_pulse,
    vienna,
)
from references.switched.network import Branch, Network, Wave, joined

ATTEMPTS = ((1e-3, 0.0, 1e-6), (1e-2, 1e-9, 1e-4), (3e-2, 1e-8, 1e-3))
"""N, capacitances [F] behind 1 kOhm across each diode and switch, and ngspice's tolerance: without the second
and with a tight third it finds no step short enough where coils are cut off."""

SATURATION = 1e-12
CLOSED, OPEN = 1e-6, 1e9
STEPS = 20_000
SAMPLES = 201


def _mains(V: float, f: float, phase: float = 0.3) -> Branch:
    return Branch("V", "V0", 0, 1, wave=Wave(amplitude=V, frequency=f, phase=phase))


def half_wave() -> Network:
    """A sine through a diode and a resistance onto a capacitor beside a load."""
    return joined(
        _mains(10, 50), Branch("R", "R0", 1, 2, 1.0), Branch("D", "D0", 2, 3),
        Branch("C", "C0", 3, 0, 1e-3, start=2.0), Branch("R", "R1", 3, 0, 100.0),
    )  # fmt: skip


def clamp() -> Network:
    """An oscillation of a coil and a capacitor that a diode keeps below a battery's voltage."""
    return joined(
        _mains(5, 50), Branch("R", "R0", 1, 2, 2.0), Branch("L", "L0", 2, 3, 5e-3),
        Branch("C", "C0", 3, 0, 2e-4), Branch("D", "D0", 3, 4),
        Branch("S", "S0", 0, 4, more=0.1, wave=Wave(6.0)),
    )  # fmt: skip


def doubler() -> Network:
    """Greinacher's: two diodes and two capacitors."""
    return joined(
        _mains(10, 50), Branch("R", "R0", 1, 2, 0.5), Branch("C", "C0", 2, 3, 2e-4),
        Branch("D", "D0", 0, 3), Branch("D", "D1", 3, 4), Branch("C", "C1", 4, 0, 2e-4),
        Branch("R", "R1", 4, 0, 500.0),
    )  # fmt: skip


def bridge_with_choke() -> Network:
    """Four diodes behind a source inductance, a choke and a resistance: they overlap as they commutate.

    With resistances that differ, as where a current may take two ways alike nothing tells which it takes.
    """
    ways = [(2, 4), (3, 4), (5, 2), (5, 3)]
    diodes = [Branch("D", f"D{k}", *way, more=0.05 * (k + 1)) for k, way in enumerate(ways)]
    return joined(
        Branch("V", "V0", 3, 1, wave=Wave(amplitude=20, frequency=50, phase=0.3)),
        Branch("L", "Ls", 1, 2, 1e-3), *diodes, Branch("L", "L0", 4, 6, 2e-2), Branch("R", "R0", 6, 5, 5.0),
        Branch("R", "R1", 5, 0, 1e3),
    )  # fmt: skip


ONE = pulses(1e-3, 0.5, 2e-3, 1e-4)
TURNS = [pulses(1e-3, 0.3 + 0.1 * k, 0.02, 1e-4 * (k + 1)) for k in range(3)]

CIRCUITS: dict[str, tuple[Network, float]] = {
    "buck": (buck(10, 1e-4, 1e-4, 1, pulses(5e-5, 0.4, 2e-4, 1e-6), 4, 4), 2e-4),
    "buck, discontinuous": (buck(10, 1e-5, 1e-4, 50, pulses(5e-5, 0.1, 2e-4, 1e-6)), 2e-4),
    "boost": (boost(10, 1e-4, 1e-4, 10, pulses(5e-5, 0.4, 2e-4, 1e-6), 8), 2e-4),
    "half bridge": (half_bridge(10, 1e-3, 1, 1e-2, ONE, pulses(1e-3, 0.4, 2e-3, 6.5e-4)), 2e-3),
    "full bridge": (full_bridge(10, 1e-3, 1, 1e-2, ONE, pulses(1e-3, 0.5, 2e-3, 4e-4), 1e-5, 0.5), 2e-3),
    "six-pulse rectifier, choke": (six_pulse(325, 50, 0.3, 1e-2, 10), 0.02),
    "six-pulse rectifier, overlap": (six_pulse(325, 50, 0.3, 1e-2, 10, 1e-3), 0.02),
    "Vienna rectifier": (vienna(325, 50, 0.2, 1e-3, 1e-3, 50, TURNS, 300, 500), 0.02),
    "freewheel": (opened_inductor(10, 1, 1, 2, 1), 3),
    "clamp": (clamp(), 0.06),
    "half-wave rectifier": (half_wave(), 0.06),
    "voltage doubler": (doubler(), 0.1),
    "bridge, choke and source inductance": (bridge_with_choke(), 0.06),
    "two bridges in series": (bridge_chain(2, 10, 50, 0.5, 0.02, 1e-2, 5), 0.02),
}  # fmt: skip


def missing() -> str:
    """Why it cannot be asked; nothing if it can."""
    return "" if shutil.which("ngspice") else "ngspice is not installed (Debian's package ngspice)"


Columns = dict[str, np.ndarray]


def both(network: Network, end: float, times: np.ndarray) -> tuple[str, Columns, Columns]:
    """How its diodes are, and what ngspice finds with these and with twice of it."""
    failed: RuntimeError | None = None
    for emission, snubber, tolerance in ATTEMPTS:
        with tempfile.TemporaryDirectory() as folder:
            try:
                one, two = (
                    waveforms(
                        network,
                        end,
                        times,
                        (many * emission, many * snubber, tolerance),
                        Path(folder),
                    )
                    for many in (1, 2)
                )
            except RuntimeError as error:
                failed = error
            else:
                return f"{emission:g}" + (", RC" if snubber else ""), one, two
    raise failed or RuntimeError


def waveforms(
    network: Network, end: float, times: np.ndarray, real: tuple[float, float, float], folder: Path
) -> Columns:
    """Voltages of capacitors and currents of coils at some times; `RuntimeError` if it gives up."""
    deck, table = folder / "circuit.cir", folder / "table.txt"
    table.unlink(missing_ok=True)
    stored = network.of("C", "L")
    deck.write_text(_deck(network, end, table, *real), encoding="utf-8")
    done = subprocess.run(
        ["ngspice", "-b", str(deck)], capture_output=True, text=True, check=False, cwd=folder
    )
    said = done.stdout + done.stderr
    if not table.exists() or re.search(r"aborted|singular|fatal", said, re.IGNORECASE):
        told = re.search(r"doAnalyses: *(.*)", said)
        raise RuntimeError(f"ngspice gives up: {told[1] if told else said[-300:]}")
    rows = np.loadtxt(table)
    time, found = rows[:, 0], {}
    assert time[-1] >= end * (1 - 1e-9), f"ngspice ended at {time[-1]}"
    for k, b in enumerate(stored):
        name = f"{'u' if b.kind == 'C' else 'i'}_{b.name}"
        found[name] = np.interp(times, time, rows[:, 2 * k + 1])
    return found


def _deck(
    network: Network, end: float, table: Path, emission: float, snubber: float, tolerance: float
) -> str:
    lines = ["networks that switch"]
    for b in network.branches:
        lines += _element(b)
        if snubber and b.kind in "DK":
            lines += [
                f"Cs{b.name} {b.tail} {b.name}s {snubber}",
                f"Rs{b.name} {b.name}s {b.head} 1k",
            ]
    longest = end / STEPS
    lines += [
        f".model ideal D(IS={SATURATION} N={emission})",
        f".model contact SW(VT=0.5 VH=0 RON={CLOSED} ROFF={OPEN})",
        f".options method=gear maxord=2 reltol={tolerance} abstol={1e-3 * tolerance}"
        f" vntol={1e-3 * tolerance} gmin=1e-12 itl4=200",
        f".tran {longest} {end} 0 {longest} uic",
        ".control", "run",
        *(f"let x{k} = {_column(b)}" for k, b in enumerate(network.of("C", "L"))),
        f"wrdata {table.name} " + " ".join(f"x{k}" for k in range(len(network.of("C", "L")))),
        ".endc", ".end", "",
    ]  # fmt: skip
    return "\n".join(lines)


def _column(b: Branch) -> str:
    if b.kind == "L":
        return f"{b.name.lower()}#branch"
    ends = [f"v({node})" if node else "0" for node in (b.tail, b.head)]
    return " - ".join(ends)


def _element(b: Branch) -> list[str]:
    """A branch's lines; inner nodes and names begin with its own."""
    ends = f"{b.tail} {b.head}"
    if b.kind == "R":
        return [f"{b.name} {ends} {b.value}"]
    if b.kind in "CL":
        return [f"{b.name} {ends} {b.value} IC={b.start}"]
    if b.kind == "D":
        if not b.more:
            return [f"{b.name} {ends} ideal"]
        return [f"{b.name} {b.tail} {b.name}i ideal", f"R{b.name} {b.name}i {b.head} {b.more}"]
    if b.kind == "K":
        return [f"S{b.name} {ends} {b.name}c 0 contact", f"V{b.name} {b.name}c 0 {_command(b)}"]
    # A source lifts its head above its tail, as ngspice's first node is above its second.
    wave = _wave(b.wave)
    if b.kind == "V":
        return [f"V{b.name} {b.head} {b.tail} {wave}"]
    return [f"V{b.name} {b.name}i {b.tail} {wave}", f"R{b.name} {b.name}i {b.head} {b.more}"]


def _command(b: Branch) -> str:
    """0 or 1; each change is short beside all between changes, its middle at its instant."""
    if not b.instants:
        return f"DC {int(b.on)}"
    width = 1e-5 * min(np.diff([0.0, *b.instants]).min(), b.instants[0] or 1.0)
    level, points = int(b.on), [(0.0, int(b.on))]
    for at in b.instants:
        points += [(at - width / 2, level), (at + width / 2, 1 - level)]
        level = 1 - level
    return "PWL(" + " ".join(f"{float(t)!r} {v}" for t, v in points) + ")"


def _wave(wave: Wave) -> str:
    assert not wave.steps
    if not wave.amplitude:
        return f"DC {wave.constant}"
    return f"SIN({wave.constant} {wave.amplitude} {wave.frequency} 0 0 {np.degrees(wave.phase)})"
