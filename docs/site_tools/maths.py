"""Formulas as MathML: an extension of Markdown, so that pages need no script to show them."""

import html
import re

from latex2mathml.converter import convert
from markdown import Markdown
from markdown.extensions import Extension
from markdown.postprocessors import Postprocessor

_FORMULA = re.compile(
    r'<(?P<tag>span|div) class="arithmatex">\\(?P<kind>[(\[])(?P<tex>.*?)\\[)\]]</(?P=tag)>',
    re.DOTALL,
)


class Maths(Postprocessor):
    """Turns the formulas that ``pymdownx.arithmatex`` marked into MathML."""

    def run(self, text: str) -> str:
        """A page's text with its formulas turned."""
        return _FORMULA.sub(_mathml, text)


class MathsExtension(Extension):
    """Registers `Maths` after everything else."""

    def extendMarkdown(self, md: Markdown) -> None:
        """Called by Markdown."""
        md.postprocessors.register(Maths(md), "mathml", -10)


def makeExtension(**_: object) -> Extension:
    """Called by Markdown."""
    return MathsExtension()


def _mathml(found: re.Match[str]) -> str:
    display = "block" if found["kind"] == "[" else "inline"
    return convert(html.unescape(found["tex"]).strip(), display=display)
