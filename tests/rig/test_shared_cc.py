"""Compilers that share: an object is taken again only where the compiler would make the same."""

import shutil
import subprocess
from pathlib import Path

import pytest

from rig import shared_cc

COMPILER = shutil.which("cc", path="/usr/local/bin:/usr/bin:/bin")
pytestmark = pytest.mark.skipif(COMPILER is None, reason="no compiler")

QUICK = """#!/bin/sh
echo "$@" >> "{log}"
exec "{compiler}" "$@"
"""
"""A second compiler that notes what it is told."""

FILES = {
    "one.c": '#include "sizes.h"\nint one(void) { return ONE; }\n',
    "main.c": "int one(void);\nint main(void) { return one(); }\n",
    "sizes.h": "/* Of a model. */\n#define ONE 7\n",
}


def _status(folder: Path, *flags: str, **changed: str) -> tuple[int, list[str]]:
    """What the program returns, and what was compiled or shared for it."""
    place = folder / f"place{len(list(folder.iterdir()))}"
    place.mkdir()
    for name, text in FILES.items():
        (place / name).write_text(changed.get(name.replace(".", "_"), text))
    (folder / "log").write_text("")
    to = str(place / "run")
    units = [str(place / "main.c"), str(place / "one.c")]
    assert COMPILER
    arguments = [*flags, "-I", str(place), *units, "-o", to, "-lm"]
    assert shared_cc.main(str(folder), COMPILER, "", arguments) == 0
    return subprocess.run([to], check=False).returncode, (folder / "log").read_text().split()


def test_a_program_is_compiled_once(tmp_path: Path) -> None:
    assert _status(tmp_path) == (7, ["compiled"])
    assert _status(tmp_path) == (7, ["shared"])


def test_other_headers_flags_and_texts_make_other_objects(tmp_path: Path) -> None:
    _status(tmp_path)
    assert _status(tmp_path, sizes_h="#define ONE 5\n") == (5, ["compiled"])
    assert _status(tmp_path, "-O2") == (7, ["compiled"])
    assert _status(tmp_path, "-UX", "-D", "Y") == (7, ["compiled"])
    text = FILES["one.c"].replace("ONE;", "ONE + 1;")
    assert _status(tmp_path, one_c=text) == (8, ["compiled"])


def test_only_comments_do_not_count(tmp_path: Path) -> None:
    _status(tmp_path)
    assert _status(tmp_path, sizes_h="/* Of another. */\n#define ONE 7\n")[1] == ["shared"]
    quoted = FILES["one.c"] + 'const char *said(void) { return "%s"; }\n'
    _status(tmp_path, one_c=quoted % "/* a */")
    assert _status(tmp_path, one_c=quoted % "/* b */")[1] == ["compiled"]


def test_what_has_warnings_is_not_kept(tmp_path: Path, capfd) -> None:
    text = FILES["one.c"] + "static int unused(void) { return 0; }\n"
    for _ in range(2):
        assert _status(tmp_path, "-Wall", one_c=text) == (7, ["apart"])
        assert "unused" in capfd.readouterr().err


def test_files_that_are_no_program_as_one_are_compiled_one_by_one(tmp_path: Path, capfd) -> None:
    one = "enum { N = 7 };\nint one(void) { return N; }\n"
    main = "enum { N = 1 };\nint one(void);\nint main(void) { return one() + N; }\n"
    assert _status(tmp_path, one_c=one, main_c=main) == (8, ["apart"])
    assert capfd.readouterr().err == ""


def test_what_is_refused_has_the_compilers_status(tmp_path: Path, capfd) -> None:
    (tmp_path / "bad.c").write_text("int bad(void) { return }\n")
    assert COMPILER
    arguments = [str(tmp_path / "bad.c"), "-o", str(tmp_path / "bad")]
    assert shared_cc.main(str(tmp_path), COMPILER, "", arguments) == 1
    assert "bad.c:1" in capfd.readouterr().err
    assert not (tmp_path / "bad").exists()


@pytest.mark.parametrize(
    "arguments", [["--version"], ["-c", "one.c", "-o", "one.o"], ["one.c"], ["-E", "one.c", "-o", "x"],
                  ["-print-file-name=libasan.so"], ["one.o", "-o", "run"],
                  ["-Werror", "one.c", "-o", "run"]]
)  # fmt: skip
def test_other_calls_are_the_compilers_own(arguments: list[str]) -> None:
    assert shared_cc.split(arguments) is None


def test_arguments_of_a_build_are_told_apart() -> None:
    said = [
        "-O1",
        "-shared",
        "-fPIC",
        "-I.",
        "-D",
        "X=1",
        "-o",
        "a.so",
        "one.c",
        "two.c",
        "-L",
        "lib",
        "-lm",
    ]
    flags = ["-O1", "-shared", "-fPIC", "-D", "X=1"]
    rest = ["-o", "a.so", "-L", "lib", "-lm"]
    assert shared_cc.split(said) == (["one.c", "two.c"], flags, ["."], rest)


def test_units_of_one_model_share_what_is_not_their_own(tmp_path: Path) -> None:
    """Of a unit's own file and the rest the rest is taken again; a name in both files is no conflict."""
    for version in (2, 3):
        own = f"static int model(void) {{ return {version}; }}\nint unit(void) {{ return model(); }}\n"
        (tmp_path / f"fmu{version}.c").write_text(own)
    (tmp_path / "model.c").write_text(
        "int unit(void);\nstatic int model(void) { return 10; }\n"
        "int main(void) { return unit() + model(); }\n"
    )
    assert COMPILER
    for version, words in ((2, ["compiled", "compiled"]), (3, ["shared", "compiled"])):
        (tmp_path / "log").write_text("")
        files = [str(tmp_path / name) for name in ("model.c", f"fmu{version}.c")]
        to = str(tmp_path / f"run{version}")
        assert shared_cc.main(str(tmp_path), COMPILER, "", [*files, "-o", to]) == 0
        assert subprocess.run([to], check=False).returncode == 10 + version
        assert (tmp_path / "log").read_text().split() == words


def _quick(folder: Path, compiler: str) -> tuple[str, Path]:
    program, log = folder / "quick", folder / "told"
    program.write_text(QUICK.format(log=log, compiler=compiler))
    program.chmod(0o755)
    log.touch()
    return str(program), log


@pytest.mark.parametrize(
    ("flags", "told"),
    [
        (["-O0", "-std=c99", "-ffp-contract=fast", "-DX=1", "-U", "Y"], "-DX=1 -U Y "),
        (["-O3", "-march=native", "-O0"], ""),
        (["-O1"], None), (["-O0", "-O2"], None), ([], ""),
        (["-O0", "-g"], None), (["-O0", "-fsanitize=address"], None), (["-O0", "-Wl,-s"], None),
        (["-O0", "-Wall", "-Wextra"], ""),
    ],
)  # fmt: skip
def test_a_quick_compiler_is_asked_for_plain_code_alone(
    flags: list[str], told: str | None, tmp_path: Path
) -> None:
    assert COMPILER
    quick, log = _quick(tmp_path, COMPILER)
    (tmp_path / "one.c").write_text("int main(void) { return 7; }\n")
    arguments = [*flags, str(tmp_path / "one.c"), "-o", str(tmp_path / "run")]
    assert shared_cc.main(str(tmp_path), COMPILER, quick, arguments) == 0
    assert subprocess.run([tmp_path / "run"], check=False).returncode == 7
    lines = log.read_text().splitlines()
    assert [line.split("-o ")[0] for line in lines] == ([] if told is None else [told])


def test_what_a_quick_compiler_does_not_take_the_other_compiles(tmp_path: Path) -> None:
    assert COMPILER
    quick, log = _quick(tmp_path, "false")
    (tmp_path / "one.c").write_text("int main(void) { return 7; }\n")
    arguments = ["-O0", str(tmp_path / "one.c"), "-o", str(tmp_path / "run")]
    assert shared_cc.main(str(tmp_path), COMPILER, quick, arguments) == 0
    assert subprocess.run([tmp_path / "run"], check=False).returncode == 7
    assert len(log.read_text().splitlines()) == 1


@pytest.mark.parametrize(
    "text", ["static int unused(void) { return 0; }", "int rubbish(void) { int x; return x; }"]
)
def test_warnings_are_told_where_a_quick_compiler_makes_the_code(
    text: str, tmp_path: Path, capfd
) -> None:
    assert COMPILER
    quick, log = _quick(tmp_path, COMPILER)
    (tmp_path / "one.c").write_text(f"{text}\nint main(void) {{ return 7; }}\n")
    for flags, told in (["-O0"], 1), (["-O0", "-Wall"], 1):
        arguments = [*flags, str(tmp_path / "one.c"), "-o", str(tmp_path / "run")]
        assert shared_cc.main(str(tmp_path), COMPILER, quick, arguments) == 0
        assert ("[-Wun" in capfd.readouterr().err) == ("-Wall" in flags)
        assert len(log.read_text().splitlines()) == told
