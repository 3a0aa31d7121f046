r"""A derivation as LaTeX and as Markdown with formulas, names in Greek letters where they are called so."""

import re
from collections.abc import Iterator, Mapping, Sequence

import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.explaining.layout import first_few, fits, heading, shortened
from bondgraph.explaining.records import Equation, Formula, Step
from bondgraph.show.display import MOST_STATES
from bondgraph.show.latex_matrices import matrices_latex, notebook_matrices
from bondgraph.show.sums import Sum, latex_pieces, typeset

LONGEST_LINE = 6
"""Terms on one line of a formula."""

SHORT = 4
"""Terms in all of further sides that stand on one line."""

CONTINUED = r"\quad "
"""Begins a line that goes on with the side above it."""

SPECIAL = {
    "\\": r"\textbackslash{}", "_": r"\_", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#",
    "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
}  # fmt: skip

SPECIAL_IN_FORMULAS = {
    **SPECIAL, "\\": r"\backslash ", "~": r"\sim ", "^": r"\wedge ", " ": r"\ ",
}  # fmt: skip


def latex_of(steps: Sequence[Step], result: StateEquations, limit: int | None) -> str:
    """Paragraphs, lists and ``align*`` environments; needs the package amsmath."""
    names = _names(steps)
    lines = [*(f"{_worded(line, names, True)}\\\\" for line in heading(result)), ""]
    for step in steps:
        lines += [rf"\paragraph{{{escaped(step.title)}}}", ""]
        sentences, more = first_few(step.sentences, limit)
        if sentences:
            items = [*(_worded(sentence, names) for sentence in sentences), *_more(more)]
            lines += [r"\begin{itemize}", *(rf"  \item {item}" for item in items), r"\end{itemize}"]
        equations, more = first_few(step.equations, limit)
        if equations:
            rows = [row for one in equations for row in _rows(one, limit, rf"\tag{{{one.number}}}")]
            lines += [r"\begin{align*}", " \\\\\n".join(rows), r"\end{align*}", *_more(more)]
        for formula in step.formulas:
            text = _formula(formula, fits(result, limit))
            lines += [r"\begin{equation*}", rf"{text} \tag{{{formula.number}}}", r"\end{equation*}"]
        lines.append("")
    return "\n".join([*lines, *_ending(result)])


def markdown_of(steps: Sequence[Step], result: StateEquations, limit: int | None) -> str:
    """Headings, lists and ``$$`` formulas, for notebooks."""
    names = _names(steps)
    lines = [*(f"{_worded(line, names, True)}  " for line in heading(result)), ""]
    for number, step in enumerate(steps, 1):
        lines += [f"**{number}. {_plain(step.title)}**", ""]
        sentences, more = first_few(step.sentences, limit)
        lines += [f"- {_worded(sentence, names)}" for sentence in sentences]
        lines += [*(f"- {text}" for text in _more(more)), ""]
        equations, more = first_few(step.equations, limit)
        if equations:
            rows = [
                row
                for one in equations
                for row in _rows(one, limit, rf"&& \text{{({one.number})}}")
            ]
            lines += [
                r"$$\begin{aligned}",
                " \\\\\n".join(rows),
                r"\end{aligned}$$",
                *_more(more),
                "",
            ]
        for formula in step.formulas:
            text = _formula(formula, fits(result, limit))
            lines += [rf"$${text} \qquad \text{{({formula.number})}}$$", ""]
    return "\n".join([*lines, notebook_matrices(result), ""])


def escaped(text: str) -> str:
    r"""Text with what LaTeX would read as commands written out.

    >>> print(escaped("I_i & 50 %"))
    I\_i \& 50 \%
    """
    return "".join(SPECIAL.get(letter, letter) for letter in text)


def _plain(text: str) -> str:
    return re.sub(r"([\\`*_$<>\[\]#|])", r"\\\1", text)


def _names(steps: Sequence[Step]) -> dict[str, str]:
    """The LaTeX of every name in equations, and of every matrix in formulas."""
    equations = (one for step in steps for one in step.equations)
    used = (name for one in equations for side in one.expressions for name in side.free_symbols)
    found = {name.name: typeset(name) for name in used}
    formulas = (one for step in steps for one in step.formulas)
    factors = (factor for one in formulas for product in one.products for factor in product)
    return found | {factor.text: factor.latex for factor in factors}


def _worded(sentence: str, names: Mapping[str, str], every: bool = False) -> str:
    """A sentence with the signals it names as formulas; of names like words only those after their kind."""
    parts = re.split(r"([^\w']+)", sentence)
    shown = []
    for at, part in enumerate(parts):
        clear = every or "_" in part or (at > 1 and parts[at - 2] in ("effort", "flow"))
        shown.append(f"${names[part]}$" if part in names and clear else escaped(part))
    return "".join(shown)


def _more(count: int) -> list[str]:
    return [f"... and {count} more"] if count else []


def _rows(one: Equation, limit: int | None, tag: str) -> Iterator[str]:
    """Rows of an alignment: a side each, long ones on several; number and node stand at the first."""
    left, *rights = (_pieces(side, limit) for side in one.sides)
    if sum(map(len, rights)) <= SHORT:
        lines = [" = ".join(" ".join(pieces) for pieces in rights)]
    else:
        lines = [line for pieces in rights for line in _lines(pieces)]
    signs = ["" if line.startswith(CONTINUED) else "=" for line in lines]
    node = "" if one.node is None else rf"\mathrm{{{_in_formula(str(one.node))}}}"
    yield f"{' '.join(left)} &{signs[0]} {lines[0]} && {node} {tag}"
    yield from (f" &{sign} {line}" for sign, line in zip(signs[1:], lines[1:], strict=True))


def _lines(pieces: Sequence[str]) -> Iterator[str]:
    for start in range(0, len(pieces), LONGEST_LINE):
        yield (CONTINUED if start else "") + " ".join(pieces[start : start + LONGEST_LINE])


def _in_formula(text: str) -> str:
    return "".join(SPECIAL_IN_FORMULAS.get(letter, letter) for letter in text)


def _pieces(side: Sum, limit: int | None) -> list[str]:
    terms, more = shortened(side, limit, r"\langle\text{{{} operations}}\rangle")
    pieces = latex_pieces(terms)
    return [*pieces, rf"+ \dots \text{{({more} more terms)}}"] if more else pieces


def _formula(formula: Formula, matrices: bool) -> str:
    products = [" ".join(factor.latex for factor in product) for product in formula.products]
    text = f"{formula.left.latex} = {' + '.join(products)}"
    if matrices:
        values = (
            " ".join(sp.latex(sp.Matrix(factor.matrix)) for factor in product)
            for product in formula.products
        )
        text += f" = {' + '.join(values)}"
    return text


def _ending(result: StateEquations) -> list[str]:
    """The equations in matrices, while these can be read."""
    text = matrices_latex(result) if len(result.states) <= MOST_STATES else ""
    return [r"\begin{gather*}", text, r"\end{gather*}", ""] if text else []
