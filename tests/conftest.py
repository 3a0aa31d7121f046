"""What all tests share: the rig they run in, the option that rewrites files of exported text."""

import pytest

pytest_plugins = [
    "rig.bytecode",
    "rig.threads",
    "rig.examples",
    "rig.garbage",
    "rig.needs",
    "rig.used",
    "rig.guard",
    "rig.compilers",
    "rig.closely",
    "rig.walked",
    "rig.summary",
]


def pytest_addoption(parser: pytest.Parser) -> None:
    """``--update-golden``: write the files that exports are compared with."""
    parser.addoption("--update-golden", action="store_true", help="rewrite files of exported text")


@pytest.fixture
def update_golden(request: pytest.FixtureRequest) -> bool:
    """Whether files that exports are compared with are to be written anew."""
    return bool(request.config.getoption("--update-golden"))
