"""Compiling: what is kept, what is missing, and what a compiler refuses."""

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

import bondgraph as bg
from codegen.engine import build, cache
from codegen.engine import compiler as tools

SOURCE = {
    "one.c": '#include "two.h"\nint one(void) { return TWO - 1; }\n',
    "two.h": "#define TWO 2\n",
}
FLAGS = ("-O1", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror")


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


def test_a_library_is_compiled_and_called() -> None:
    _, library = build.loaded(build.compiled(SOURCE, FLAGS), "int one(void);")
    assert library.one() == 1


def test_a_library_is_compiled_once(monkeypatch: pytest.MonkeyPatch) -> None:
    first = build.compiled(SOURCE, FLAGS)
    assert first.parent == cache.cache_folder()
    made = first.stat().st_mtime_ns
    monkeypatch.setattr(build, "call", lambda *arguments: pytest.fail("compiled again"))
    with pytest.raises(pytest.fail.Exception, match="compiled again"):
        build.compiled(SOURCE, ("-O0",))
    assert build.compiled(SOURCE, FLAGS) == first
    assert first.stat().st_mtime_ns == made


def test_sources_and_flags_make_another_library() -> None:
    first = build.compiled(SOURCE, FLAGS)
    assert build.compiled(SOURCE, ("-O0",)) != first
    assert build.compiled({**SOURCE, "two.h": "#define TWO 3\n"}, FLAGS) != first
    assert sorted(path.suffix for path in first.parent.iterdir()) == [".so"] * 3


def test_flags_of_the_environment_come_last(monkeypatch: pytest.MonkeyPatch) -> None:
    source = {"one.c": "int one(void) { return ONE; }\n"}
    flags = (*FLAGS, "-DONE=1")
    first = build.compiled(source, flags)
    monkeypatch.setenv("CFLAGS", "-UONE -DONE=2")
    second = build.compiled(source, flags)
    assert second != first
    assert build.loaded(second, "int one(void);")[1].one() == 2


def test_several_processes_share_the_cache() -> None:
    # One starts, and becomes three when it has imported what they need.
    program = (
        "import os\n"
        "from codegen.engine import build\n"
        "children = [os.fork()]\n"
        "children += [os.fork()] if children[0] else []\n"
        f"path = build.compiled({SOURCE!r}, {FLAGS!r})\n"
        "one = build.loaded(path, 'int one(void);')[1].one()\n"
        "os.write(1, f'{path} {one}\\n'.encode())\n"
        "if all(children):\n"
        "    statuses = [os.waitpid(child, 0)[1] for child in children]\n"
        "    assert statuses == [0, 0]\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, check=True
    )
    first, *others = done.stdout.splitlines()
    assert first.endswith(" 1")
    assert others == [first] * 2
    assert len(list(cache.cache_folder().iterdir())) == 1


def test_without_a_compiler_both_ways_to_get_one_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(tools.shutil, "which", lambda name: None)
    monkeypatch.setattr(tools.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(bg.MissingExtraError, match=r"gcc or clang.*pip install ziglang"):
        tools.compiler()


def test_the_wheels_compiler_is_used_where_there_is_no_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(tools.shutil, "which", lambda name: None)
    monkeypatch.setattr(tools.importlib.util, "find_spec", lambda name: object())
    assert tools.compiler() == (sys.executable, "-m", "ziglang", "cc")


def test_the_environment_chooses_the_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "ccache some-cc -m64")
    assert tools.compiler() == ("ccache", "some-cc", "-m64")


def test_a_compiler_that_does_not_start_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "/no/such/compiler")
    with pytest.raises(bg.MissingExtraError, match=r"/no/such/compiler does not start"):
        build.compiled(SOURCE, FLAGS)


def test_without_cffi_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cffi", None)
    with pytest.raises(bg.MissingExtraError, match=r'pip install "bondgraph-toolkit\[c\]"'):
        build.check_tools()


def test_what_the_compiler_refuses_is_told() -> None:
    with pytest.raises(bg.SimulationError, match=r"(?s)the C compiler failed: .*one\.c"):
        build.compiled({"one.c": "int one(void) { return }\n"}, FLAGS)
    assert list(cache.cache_folder().iterdir()) == []


@pytest.mark.parametrize("spoilt", ["half", "nothing", "foreign", "unreadable"])
def test_a_library_that_is_not_what_was_kept_is_made_anew(spoilt: str) -> None:
    """Cut short it would end the process when it is called (SIGBUS), for ever."""
    path = build.compiled(SOURCE, FLAGS)
    good = path.read_bytes()
    if spoilt == "unreadable":
        path.unlink()
        path.mkdir()
    else:
        texts = {"half": good[: len(good) // 2], "nothing": b"", "foreign": b"\x7fELF" * 5000}
        path.write_bytes(texts[spoilt])
    again = build.compiled(SOURCE, FLAGS)
    assert again.read_bytes() == good
    assert (again == path) == (spoilt != "unreadable")
    assert build.loaded(again, "int one(void);")[1].one() == 1


def test_a_cache_that_cannot_be_used_gives_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_bytes(b"")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    path = build.compiled(SOURCE, FLAGS)
    assert path.parent == cache.temporary()
    assert build.compiled(SOURCE, FLAGS) == path
    assert build.loaded(path, "int one(void);")[1].one() == 1


def test_a_cache_without_room_for_the_compiler_gives_way(monkeypatch: pytest.MonkeyPatch) -> None:
    def call(command: Sequence[str], folder: Path, makes: Path) -> str:
        if folder.is_relative_to(cache.cache_folder()):
            raise bg.SimulationError("cc1: fatal error: one.s: No space left on device")
        return tools.call(command, folder, makes)

    monkeypatch.setattr(build, "call", call)
    path = build.compiled({"one.c": "int one(void) { return 7; }\n"}, FLAGS)
    assert path.parent == cache.temporary()
    assert list(cache.cache_folder().iterdir()) == []


def test_no_room_anywhere_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(cache.os, "replace", full)
    with pytest.raises(bg.WriteError, match=r"so cannot be written: No space left"):
        build.compiled({"one.c": "int one(void) { return 8; }\n"}, FLAGS)


KILLED = """
import os, signal
from codegen.engine import build
def call(*arguments):
    os.kill(os.getpid(), signal.SIGKILL)
build.call = call
build.compiled({sources!r}, {flags!r})
"""


def test_a_process_that_is_killed_while_it_compiles_leaves_nothing_that_stays() -> None:
    program = KILLED.format(sources=SOURCE, flags=FLAGS)
    done = subprocess.run([sys.executable, "-c", program], check=False)
    assert done.returncode == -9
    (left,) = cache.cache_folder().iterdir()
    assert left.is_dir()
    path = build.compiled(SOURCE, FLAGS)
    assert list(cache.cache_folder().iterdir()) == [path]


def test_folders_of_processes_that_live_and_of_other_machines_stay(tmp_path: Path) -> None:
    with cache.workshop(tmp_path) as mine:
        other = tmp_path / f"{cache.MAKING}-elsewhere-1-x"
        other.mkdir()
        with cache.workshop(tmp_path) as second:
            assert {mine, other, second} == set(tmp_path.iterdir())
    assert list(tmp_path.iterdir()) == [other]


@pytest.mark.parametrize("variable", ["CC", "CFLAGS"])
def test_an_open_quote_is_told(variable: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(variable, "gcc 'x")
    with pytest.raises(bg.MissingExtraError, match=rf"{variable} is .*No closing quotation"):
        build.compiled(SOURCE, FLAGS)


def test_a_compiler_that_makes_nothing_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "true")
    with pytest.raises(
        bg.SimulationError, match="compiler true says that all went well and made no"
    ):
        build.compiled(SOURCE, FLAGS)


def test_a_compiler_that_makes_rubbish_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = tmp_path / "fake"
    made = 'case "$*" in *"-o library.so"*) echo rubbish > library.so ;; esac'
    fake.write_text(f"#!/bin/sh\n{made}\n", encoding="utf-8")
    fake.chmod(0o755)
    monkeypatch.setenv("CC", str(fake))
    with pytest.raises(bg.SimulationError, match=r"so does not open"):
        build.loaded(build.compiled(SOURCE, FLAGS), "int one(void);")


def test_parts_are_compiled_as_one_text_each_and_linked(monkeypatch: pytest.MonkeyPatch) -> None:
    """Seven files in four parts, which know of one another's functions and not of their own names."""
    files = {
        f"f{k}.c": f"int f{k}(void) {{ return {'+'.join([str(k)] * (k + 1))}; }}\n"
        for k in range(6)
    }
    said = "".join(f"int f{k}(void);\n" for k in range(6))
    total = " + ".join(f"f{k}()" for k in range(6))
    files["sum.c"] = f"{said}int all(void) {{ return {total}; }}\n"
    calls = list[Sequence[str]]()

    def call(command: Sequence[str], folder: Path, makes: Path) -> str:
        calls.append(command)
        return tools.call(command, folder, makes)

    monkeypatch.setattr(build, "call", call)
    monkeypatch.setenv("CFLAGS", "-O1")
    _, library = build.loaded(build.compiled(files, FLAGS), "int all(void);")
    assert library.all() == sum(k * (k + 1) for k in range(6))
    assert len(calls) == build.PARTS + 1
    assert sorted(one[-1] for one in calls[:-1]) == [f"part_{k}.c" for k in range(build.PARTS)]
    assert calls[-1][-1] == "-lm"
    monkeypatch.setenv("CFLAGS", "-O0")
    calls.clear()
    build.compiled(files, FLAGS)
    assert len(calls) == 1
