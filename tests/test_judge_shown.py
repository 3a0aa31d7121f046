"""The judge of notebooks sees other words, other numbers and other kinds of output."""

import pytest
from nbformat.v4 import new_output
from references.shown import alike, differences, kept


@pytest.mark.parametrize(
    ("found", "want", "same"),
    [
        ("slip at 0.50122 s", "slip at 0.50122 s", True), ("0.50122", "0.50123", True),
        ("error 1.2e-09", "error 8.8e-08", True), ("0.50122", "0.52", False),
        ("error 1.2e-09", "error 1.2e-03", False), ("stick", "slip", False),
        ("0", "0.001", False), ("-2", "2", False), ("x_1", "x_2", False), ("1 2", "1", False),
        ("0.00001", "0.00002", False),
    ],
)  # fmt: skip
def test_texts(found: str, want: str, same: bool) -> None:
    assert alike(found, want) is same


def test_outputs() -> None:
    one = new_output("stream", name="stdout", text="a\n")
    other = new_output("stream", name="stdout", text="b\n")
    picture = new_output("display_data", data={"image/png": "AAAA", "text/plain": "<Figure>"})
    assert differences([one, picture], [one, picture]) == []
    assert differences([one], [other]) == ["'a\\n' instead of 'b\\n'"]
    assert differences([one], [one, picture])
    assert differences([picture], [one])


def test_what_every_run_has_otherwise_is_not_kept() -> None:
    prints = [new_output("stream", name="stdout", text=text) for text in ("a\n", "b\n")]
    assert [one.text for one in kept(prints, 3)] == ["a\nb\n"]
    ids = "12345678-1234-1234-1234-123456789abc", "00005678-1234-1234-1234-123456789abc"
    html = "{0} {1} {0}"
    made = [
        new_output("execute_result", data={"text/html": html.format(*pair)}, execution_count=9)
        for pair in (ids, ids[::-1])
    ]
    first, second = (kept([one], 3) for one in made)
    assert first == second
    assert first[0].execution_count == 3
