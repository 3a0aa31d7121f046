"""One name, one meaning in the C runtime: functions, types, enums, and what Python mirrors of them."""

import re
from collections import defaultdict
from pathlib import Path

import pytest
from oracles.c_model import compiled
from oracles.models import block

import bondgraph as bg
from codegen.batch import engine as batch_engine
from codegen.batch import plan
from codegen.c.runtime import FOLDERS, runtime_file, runtime_names
from codegen.engine import happened, located, sizes
from codegen.engine.status import Status
from codegen.fixed import boxes
from codegen.modes import blocks
from codegen.program.lower import lower
from codegen.standalone import friction, switchings

FILES = ("main.c", *(name for folder in FOLDERS for name in runtime_names(folder)))

FUNCTION = re.compile(
    r"^(?!typedef|extern|#|enum|struct \w+ \{)\w[\w \t*]*?\**\(?\*?\b(\w+)\(", re.M
)
TYPE = re.compile(r"^\} (\w+)(?:\[\w+\])*;|^(?:enum|struct) (\w+) \{", re.M)
ALIAS = re.compile(r"^typedef (?!struct|enum)[^;{}]*?\b(\w+)(?:\[\w+\])*(?:\([^;]*\))?;", re.M)


def _plain(name: str) -> str:
    """A file without comments, strings and what the preprocessor reads."""
    text = re.sub(r"/\*.*?\*/", "", runtime_file(name), flags=re.DOTALL)
    text = re.sub(r"\\\n", " ", text)
    return re.sub(r"^#.*$|\"[^\"\n]*\"", "", text, flags=re.MULTILINE)


def _defined(text: str) -> list[str]:
    """Names of the functions that have a body here, and of types."""
    found = []
    for match in FUNCTION.finditer(text):
        end = text.find("{", match.end())
        if end >= 0 and ";" not in text[match.end() : end]:
            found.append(match[1])
    types = {name for match in TYPE.finditer(text) for name in match.groups() if name}
    return found + sorted(types | set(ALIAS.findall(text)))


def test_no_function_or_type_is_defined_twice() -> None:
    """Not even static ones: a name means one thing wherever it is met."""
    where = defaultdict(list)
    for name in FILES:
        for one in _defined(_plain(name)):
            where[one].append(name)
    assert len(where) > 500
    assert {one: files for one, files in where.items() if len(files) > 1} == {}


def _constants(text: str) -> list[str]:
    """Names of values outside functions: enumerators, macros that are numbers, tables."""
    bodies = re.findall(r"^(?:typedef )?enum ?\w* ?\{(.*?)\}", text, re.MULTILINE | re.DOTALL)
    entries = [
        re.sub(r"\([^()]*\)|\?.*", "", entry) for body in bodies for entry in body.split(",")
    ]
    found = [entry.split("=")[0].strip() for entry in entries]
    found += re.findall(r"^#\s*define (\w+)[ (]", text, re.MULTILINE)
    for line in re.findall(r"^static const [\w ]*?\w+ (\w[^;{]* = .*)", text, re.MULTILINE):
        found += re.findall(r"(\w+)(?:\[[^\]]*\])* =", line)
    # What a few lines alone use is taken back behind them.
    passing = re.findall(r"^#\s*undef (\w+)", text, re.MULTILINE)
    return [name for name in found if name and name not in passing]


def test_no_constant_is_defined_twice() -> None:
    """A letter is the same size wherever it is met, so that all files together are one program, too.

    Of the two versions of the interface of units a program has one.
    """
    where = defaultdict(list)
    for name in FILES:
        text = re.sub(r"/\*.*?\*/", "", runtime_file(name), flags=re.DOTALL)
        for one in _constants(text):
            where[one].append(name.replace("fmu3", "fmu2"))
    assert {"K", "N", "BG_ROOM", "DOP_C", "RADAU_C", "SAFETY", "STAGES"} <= set(where)
    twice = {one: files for one, files in where.items() if len(files) > 1}
    assert {one for one, files in twice.items() if len(set(files)) > 1} - {"REFUSED", "VR"} == set()


def test_the_search_sees_what_it_has_to() -> None:
    read = "static const double A = 0.9, B[2] = {1.0, 2.0};\nenum { C = 3, D };\n#define E(n) (n)\n"
    assert sorted(_constants(read + "#define F 2.0\n")) == ["A", "B", "C", "D", "E", "F"]
    text = "static double *put(int a,\n  int b)\n{\n}\nint bg_run(void);\ntypedef int bg_block(void);\n"
    text += (
        "typedef struct {\n    int a;\n} bg_one;\nenum bg_two { BG_A };\ntypedef double three[4];\n"
    )
    assert sorted(_defined(text)) == ["bg_block", "bg_one", "bg_two", "put", "three"]


def test_no_file_tells_engines_apart() -> None:
    """The preprocessor guards headers and knows compilers; sizes of models are values."""
    for name in FILES:
        for line in re.findall(r"^#\s*if\w*.*$", runtime_file(name), re.MULTILINE):
            assert re.fullmatch(r"#ifndef \w+_H|#if defined\(__GNUC__\)", line), (name, line)


def _values(header: str, *, enum: str = "") -> dict[str, int]:
    """An enum's names and values as C counts them."""
    body = re.search(rf"enum {enum}\s*\{{(.*?)\}}", _plain(header), re.DOTALL)
    assert body is not None
    names = [part.strip() for part in body[1].split(",") if part.strip()]
    return {name: at for at, name in enumerate(names)}


def test_statuses_are_those_of_c() -> None:
    expected = {f"BG_{status.name}": int(status) for status in Status}
    assert _values("run_status.h", enum="bg_status") == expected


def test_kinds_of_events_and_methods_are_those_of_c() -> None:
    kinds = {f"BG_{kind.upper()}": at for at, kind in enumerate(happened.KINDS)}
    assert _values("port_events.h", enum="bg_kind") == kinds
    methods = {f"BG_{method.upper()}": at for at, method in enumerate(located.METHODS)}
    assert _values("located_request.h", enum="bg_method") == methods


def test_measures_are_those_of_c() -> None:
    whats = {f"BATCH_{what.upper()}": at for at, what in enumerate(plan.WHATS)}
    assert _values("batch_measure.h", enum="batch_what") == whats
    record = re.search(
        r"typedef struct \{\s*int ([^;]+);\s*\} batch_measure;", _plain("batch_measure.h")
    )
    assert record is not None
    assert tuple(record[1].split(", ")) == plan.Entry._fields


def test_matrices_come_in_the_order_of_c() -> None:
    program = lower(bg.derive(block()), None, {"m": 2.0, "F_c": 3.0})
    expected = {f"BG_{letter}": at for at, letter in enumerate(program.layout)}
    assert _values("model_internal.h", enum="bg_matrix") == {
        **expected,
        "BG_MATRICES": len(expected),
    }


def _constant(header: str, name: str) -> str:
    found = re.search(rf"\b{name} = ([^,}}]+?)\s*[,}}]", _plain(header))
    assert found is not None, name
    return found[1].strip()


def test_sizes_are_those_of_c() -> None:
    assert int(_constant("batch.h", "BATCH_STRIDE")) == batch_engine.STRIDE
    assert int(_constant("batch.h", "BATCH_SQUARES")) == batch_engine.SQUARES
    assert int(_constant("exact.h", "EX_DIGITS")) == sizes.DIGITS
    assert int(_constant("port_choosing.h", "BG_ENUMERATED")) == blocks.ENUMERATED
    assert int(_constant("port_choosing.h", "BG_BLOCK_TURNS")) == blocks.TURNS
    assert int(_constant("port_box.c", "BOX_PATIENCE")) == boxes.PATIENCE
    assert int(_constant("port_choose.c", "MOST_SLIPPING")) == friction.MOST_SLIPPING
    for name in ("ALL_WAYS", "FEW", "TURNS", "MOST_TURNS"):
        assert int(_constant("port_ways.c", name)) == getattr(switchings, name)
    assert sizes.ALIGNMENT % int(_constant("exact.h", "EX_ALIGNMENT")) == 0


@pytest.mark.parametrize("ports", [0, 1, 3])
def test_sizes_that_python_works_out_are_those_of_c(ports: int, tmp_path: Path) -> None:
    """Every size that declarations use, as a compiler sees it in the header."""
    wanted = sizes.Sizes(5, 4, 7, 2, ports, 3)
    checks = "\n".join(
        f"typedef char check_{name}[EX_{name} == {value} ? 1 : -1];"
        for name, value in wanted.numbers.items()
    )
    sources = {**sizes.sources(), "config.h": wanted.config}
    for name, text in sources.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "check.c").write_text(f'#include "exact.h"\n{checks}\n')
    compiled(
        tmp_path, [str(tmp_path / "check.c"), *_units(tmp_path, sources)], "-O0", "-shared", "-fPIC"
    )


def _units(folder: Path, sources: dict[str, str]) -> list[str]:
    return [str(folder / name) for name in sources if name.endswith(".c")]
