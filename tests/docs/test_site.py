"""The documentation as a site: it builds without a warning, needs nothing from elsewhere, misses no name."""

import importlib
import os
import re
import subprocess
import sys
from pathlib import Path

import markdown
import pytest

ROOT = Path(__file__).parents[2]

LOADED = re.compile(
    r"""<(?:script|img|iframe)[^>]+src=["']?(?:https?:)?//"""
    r"""|<link[^>]+rel=["']?(?:stylesheet|preload|preconnect|icon)[^>]+href=["']?(?:https?:)?//"""
    r"""|url\(["']?(?:https?:)?//|@import["' ]+(?:https?:)?//"""
)
"""What makes a browser load something from another host."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built with warnings as errors."""
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)],
        cwd=ROOT, env=os.environ | {"NO_MKDOCS_2_WARNING": "1"}, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (0, ""), done.stdout + done.stderr
    return folder


def test_pages_load_nothing_from_elsewhere(site: Path) -> None:
    pages = [*site.rglob("*.html"), *site.rglob("*.css")]
    assert len(pages) > 12
    assert [page.name for page in pages if LOADED.search(page.read_text("utf-8"))] == []


def test_what_loads_from_elsewhere_would_be_found() -> None:
    for text in (
        '<script src="https://a/b.js">',
        '<link rel="stylesheet" href="//a/b.css">',
        "url(https://a/b)",
    ):
        assert LOADED.search(text)
    assert not LOADED.search('<a href="https://a/b"><link rel="canonical" href="https://a/">')


def test_formulas_are_mathml(site: Path) -> None:
    text = (site / "theory" / "index.html").read_text("utf-8")
    assert text.count('display="block"') > 8
    assert "arithmatex" not in text
    made = markdown.markdown(
        "$a_1 < b$ costs $5",
        extensions=["pymdownx.arithmatex", "docs.site_tools.maths"],
        extension_configs={"pymdownx.arithmatex": {"generic": True}},
    )
    assert re.search(
        r"<msub><mi>a</mi><mn>1</mn></msub><mo>&#x0003C;</mo><mi>b</mi>.* costs \$5", made
    )


def test_examples_in_docstrings_are_code(site: Path) -> None:
    text = (site / "api" / "bondgraph" / "index.html").read_text("utf-8")
    assert "<blockquote>" not in text
    assert text.count('<span class="gp">&gt;&gt;&gt; </span>') > 20


def test_names_of_the_api_lead_to_the_guides_that_use_them(site: Path) -> None:
    text = (site / "api" / "codegen" / "index.html").read_text("utf-8")
    below = text.partition('id="codegen.sweep"')[2].partition("<h3")[0]
    assert re.search(r'Used in .*<a href="\.\./\.\./tour/#many-runs">', below)


@pytest.mark.parametrize("package", ["bondgraph", "codegen", "differentials"])
def test_the_api_has_every_public_name(package: str) -> None:
    text = (ROOT / "docs" / "api" / f"{package}.md").read_text("utf-8")
    shown = [
        line.split(".")[-1] for line in text.splitlines() if line.startswith(f"::: {package}.")
    ]
    own = [name for name in shown if f"{package}.{name}" != "differentials.parts"]
    assert sorted(own) == sorted(importlib.import_module(package).__all__)


def test_links_between_readme_and_guides_lead_somewhere() -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    linked = set(re.findall(r"\]\((docs/[a-z0-9-]+\.md)\)", text))
    pages = {f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md")} - {"docs/index.md"}
    assert linked == pages
