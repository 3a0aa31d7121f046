"""Compiling: what is kept, what is missing, and what a compiler refuses."""

import subprocess
import sys
from pathlib import Path

import pytest

import bondgraph as bg
from codegen.engine import build

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
    assert first.parent == build.cache_folder()
    made = first.stat().st_mtime_ns
    monkeypatch.setattr(build, "_call", lambda *arguments: pytest.fail("compiled again"))
    monkeypatch.setattr(build, "_version", lambda command: pytest.fail("asked again"))
    with pytest.raises(pytest.fail.Exception, match="asked again"):
        build.compiled(SOURCE, FLAGS)
    monkeypatch.undo()
    monkeypatch.setenv("XDG_CACHE_HOME", str(first.parent.parent))
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
    program = (
        "from codegen.engine import build\n"
        f"path = build.compiled({SOURCE!r}, {FLAGS!r})\n"
        "print(path, build.loaded(path, 'int one(void);')[1].one())"
    )
    runs = [
        subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
        for _ in range(3)
    ]
    said = {run.communicate()[0].strip() for run in runs}
    assert len(said) == 1
    assert said.pop().endswith(" 1")
    assert len(list(build.cache_folder().iterdir())) == 1


def test_without_a_compiler_both_ways_to_get_one_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(build.shutil, "which", lambda name: None)
    monkeypatch.setattr(build.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(bg.MissingExtraError, match=r"gcc or clang.*pip install ziglang"):
        build.compiler()


def test_the_wheels_compiler_is_used_where_there_is_no_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(build.shutil, "which", lambda name: None)
    monkeypatch.setattr(build.importlib.util, "find_spec", lambda name: object())
    assert build.compiler() == (sys.executable, "-m", "ziglang", "cc")


def test_the_environment_chooses_the_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "ccache some-cc -m64")
    assert build.compiler() == ("ccache", "some-cc", "-m64")


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
    assert list(build.cache_folder().iterdir()) == []
