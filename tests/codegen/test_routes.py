"""The table of kinds by routes: every cell goes and is right, or is refused as `docs/routes.md` says."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from oracles.routes.bench import Bench
from oracles.routes.going import COMPILED, ROUTES
from oracles.routes.kinds import KINDS
from oracles.routes.page import page
from oracles.routes.table import REFUSALS, REFUSED
from soak.families import whole

import bondgraph as bg

pytestmark = pytest.mark.usefixtures("compiled_quickly")

ALWAYS = ("coulomb", "relay", "key_across", "latch")
"""Kinds that go every way in every run: friction, a jump, a key with impulses, one whose past decides."""

LONG = ("sweep", "command line", "to_python", *COMPILED)
"""What else takes its time; all kinds go these ways where they are asked for."""

SHORT = tuple(route for route in ROUTES if route not in LONG)


@pytest.fixture(scope="module")
def bench(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Bench]:
    """A kind with a folder; what its routes share lives as long as they need it."""
    folder = tmp_path_factory.mktemp(request.param)
    yield Bench(KINDS[request.param](), folder)
    shutil.rmtree(folder)


@pytest.mark.parametrize("route", SHORT)
@pytest.mark.parametrize("bench", KINDS, indirect=True)
def test_every_kind_goes_the_short_ways(
    bench: Bench, route: str, request: pytest.FixtureRequest
) -> None:
    _goes_as_told(bench, request.node.callspec.params["bench"], route)


@pytest.mark.parametrize("route", LONG)
@pytest.mark.parametrize("bench", KINDS if whole("routes") else ALWAYS, indirect=True)
def test_kinds_go_the_long_ways(bench: Bench, route: str, request: pytest.FixtureRequest) -> None:
    _goes_as_told(bench, request.node.callspec.params["bench"], route)


def _goes_as_told(bench: Bench, kind: str, route: str) -> None:
    refusal = REFUSED.get((kind, route))
    if refusal is None:
        ROUTES[route](bench)
        return
    with pytest.raises(bg.BondGraphError, match=refusal.says):
        ROUTES[route](bench)


def test_refusals_are_of_kinds_and_routes_that_there_are() -> None:
    assert len(REFUSED) == sum(len(one.kinds) * len(one.routes) for one in REFUSALS)
    assert {kind for kind, _ in REFUSED} <= {*KINDS}
    assert {route for _, route in REFUSED} <= {*ROUTES}


def test_a_wrong_run_is_seen(tmp_path: Path) -> None:
    """A hundred-thousandth of range at one sample, and a switch at one sample."""
    bench = Bench(KINDS["dog"](), tmp_path)
    right = {name: bench.run[name].copy() for name in ("w_1", "w_2", "dog")}
    bench.check(right, 1e-7)
    for name, change, message in (("w_1", 1e-4, "w_1 is off by"), ("dog", 1.0, "switch dog")):
        wrong = {**right, name: right[name].copy()}
        wrong[name][7] -= change
        with pytest.raises(AssertionError, match=message):
            bench.check(wrong, 1e-7)


def test_the_page_is_up_to_date() -> None:
    """``python -m oracles.routes`` writes it."""
    assert (Path(bg.__file__).parents[1] / "docs" / "routes.md").read_text("utf-8") == page()
