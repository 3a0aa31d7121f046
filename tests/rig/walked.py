"""Of every graph that a guide or a textbook case derives: what is shown of it is what the simulator computes.

Guides and pages of the API have it by themselves; a file of textbook cases says ``pytestmark = WALKED``.
"""

from collections.abc import Iterator

import pytest

WALKED = pytest.mark.usefixtures("walked")


@pytest.fixture
def walked() -> Iterator[None]:
    """Told when the test is over, so that what it says itself is told first."""
    from oracles.stated import misfits_somewhere
    from references.gathered import gathered

    with gathered() as found:
        yield
    # What a delay gives has no instant of its own: `codegen/delays` looks at whole runs.
    told = [equations for equations in found if not equations.delays]
    assert [text for equations in told for text in misfits_somewhere(equations)] == []


@pytest.fixture(autouse=True)
def guides_are_walked(request: pytest.FixtureRequest) -> None:
    """Files of examples ask for it, as they cannot say so."""
    if request.path.suffix == ".md":
        request.getfixturevalue("walked")
