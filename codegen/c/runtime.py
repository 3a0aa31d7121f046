"""The hand-written C that every model comes with."""

from importlib.resources import files


def runtime_file(name: str) -> str:
    """The text of a hand-written file."""
    return files("codegen").joinpath("runtime", name).read_text(encoding="utf-8")
