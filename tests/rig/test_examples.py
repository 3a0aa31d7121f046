"""Files with examples are searched, and are the modules that the packages import."""

import sys

import pytest

from rig import examples


class Searched:
    """Stands for what pytest finds in a file."""


class DoctestModule(Searched):
    """As pytest calls what searches a file for examples."""


@pytest.mark.parametrize(
    ("name", "text", "left"),
    [("one.py", ">>> 1\n", 2), ("one.py", "", 1), ("__init__.py", "", 2), ("one.md", "", 2)],
)
def test_what_has_no_prompt_is_not_searched(name: str, text: str, left: int, tmp_path) -> None:
    (tmp_path / name).write_text(text)
    asked = examples.pytest_collect_file(tmp_path / name)
    next(asked)
    with pytest.raises(StopIteration) as told:
        asked.send([Searched(), DoctestModule()])
    assert len(told.value.value) == left


def test_searched_files_are_the_packages_modules() -> None:
    import bondgraph.algebra.exact as own
    from bondgraph.analyse import instant

    assert sys.modules["bondgraph.algebra.exact"] is own
    assert instant.SingularError is own.SingularError
