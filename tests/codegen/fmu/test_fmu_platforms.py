"""Binaries for other platforms: each in that platform's own format."""

import struct
import zipfile
from pathlib import Path

import pytest
from oracles.units import belt
from soak.families import whole

from codegen.fmu import binaries
from codegen.fmu.binaries import PLATFORMS, this_platform

pytest.importorskip("ziglang")

SLOWEST = frozenset() if whole("platforms") else {"x86_64-windows"}
"""The first time, building Windows' C library takes minutes; BONDGRAPH_SOAK_PLATFORMS=1 has it, too."""

OTHERS = [name for name in PLATFORMS if name != this_platform() and name not in SLOWEST]


def _format(data: bytes) -> str:
    """System and processor, from a library's first bytes."""
    if data[:4] == b"\x7fELF":
        machine = struct.unpack_from("<H", data, 18)[0]
        return {62: "x86_64", 183: "aarch64"}[machine] + "-linux"
    if data[:2] == b"MZ":
        start = struct.unpack_from("<I", data, 0x3C)[0]
        assert data[start : start + 4] == b"PE\0\0"
        return {0x8664: "x86_64"}[struct.unpack_from("<H", data, start + 4)[0]] + "-windows"
    magic, kind = struct.unpack_from("<II", data)
    assert magic == 0xFEEDFACF
    return {0x01000007: "x86_64", 0x0100000C: "aarch64"}[kind] + "-darwin"


#: The first time, ziglang builds a platform's own C library: minutes for Windows.
pytestmark = pytest.mark.most(900)


@pytest.fixture(autouse=True)
def _plainly(monkeypatch: pytest.MonkeyPatch) -> None:
    """No code of these is run: what optimising takes is saved, and what checks for undefined behaviour.

    So is ziglang's own library, which takes longer than all else to make and of which no unit needs a thing.
    """
    flags = ("-O0", "-fno-sanitize=undefined", *(f for f in binaries.FLAGS if f != "-O2"))
    flags += ("-rtlib=none",) if SLOWEST else ()
    monkeypatch.setattr(binaries, "FLAGS", flags)


@pytest.mark.slow
@pytest.mark.parametrize("name", OTHERS)
def test_a_binary_has_its_platforms_format(name: str, tmp_path: Path) -> None:
    path = belt().written(tmp_path / "unit.fmu", "3.0", platforms=name)
    archive = zipfile.ZipFile(path)
    (binary,) = [entry for entry in archive.namelist() if entry.startswith("binaries/")]
    assert binary == f"binaries/{name}/unit{PLATFORMS[name].ending}"
    assert _format(archive.read(binary)) == name


@pytest.mark.slow
def test_fmi_2_has_both_macs_in_one_library(tmp_path: Path) -> None:
    macs = ["x86_64-darwin", "aarch64-darwin"]
    path = belt().written(tmp_path / "unit.fmu", "2.0", platforms=macs)
    data = zipfile.ZipFile(path).read("binaries/darwin64/unit.dylib")
    magic, count = struct.unpack_from(">II", data)
    assert (magic, count) == (0xCAFEBABE, 2)
    found = []
    for at in range(count):
        kind, _, start, length, _ = struct.unpack_from(">IIIII", data, 8 + 20 * at)
        part = data[start : start + length]
        assert struct.unpack_from("<I", part, 4)[0] == kind
        found.append(_format(part))
    assert sorted(found) == sorted(macs)
