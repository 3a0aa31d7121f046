"""A strict reading of LaTeX without TeX: what has to be closed is, and alignments have columns."""

import re


def check_latex(text: str, tabs: int | None = None) -> None:
    r"""Environments, braces, ``\left`` and ``$`` balance; no name's underscore stands outside formulas.

    ``tabs``: the most ``&`` that a row of an alignment may have.
    """
    _check_braces(text)
    _check_environments(text)
    assert len(re.findall(r"\\left\b", text)) == len(re.findall(r"\\right\b", text))
    outside = re.sub(
        r"\$[^$]*\$", "", re.sub(r"\$\$.*?\$\$", "", _without_alignments(text), flags=re.S)
    )
    assert "$" not in outside.replace(r"\$", ""), "a formula is not closed"
    assert not re.search(r"(?<!\\)[_&^]", outside), outside
    for body in re.findall(r"\\begin\{align(?:\*|ed)\}(.*?)\\end", text, flags=re.S):
        for row in _rows(body):
            assert 1 <= len(re.findall(r"(?<!\\)&", row)) <= (tabs or 9), row


def _check_braces(text: str) -> None:
    depth = 0
    for brace in re.findall(r"(?<!\\)[{}]", text):
        depth += 1 if brace == "{" else -1
        assert depth >= 0, "a brace closes what none opens"
    assert depth == 0, "a brace is not closed"


def _check_environments(text: str) -> None:
    opened: list[str] = []
    for what, name in re.findall(r"\\(begin|end)\{([^}]*)\}", text):
        if what == "begin":
            opened.append(name)
        else:
            assert opened, f"{name} ends and never began"
            assert opened.pop() == name
    assert not opened


def _without_alignments(text: str) -> str:
    inner = r"\\begin\{(align\*|aligned|equation\*|gather\*|gathered)\}.*?\\end\{\1\}"
    return re.sub(inner, "", text, flags=re.S)


def _rows(body: str) -> list[str]:
    """The rows of an alignment; matrices inside it have rows of their own."""
    flat = re.sub(r"\\begin\{matrix\}.*?\\end\{matrix\}", "", body, flags=re.S)
    return [row for row in re.split(r"\\\\", flat) if row.strip()]
