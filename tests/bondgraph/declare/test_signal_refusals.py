"""Mistakes at a controller on a clutch: each refusal says what was meant."""

from typing import Any

import pytest

import bondgraph as bg

GOOD: dict[str, Any] = {
    "every": 0.01, "reads": ["want", "error"], "states": {"z": 0}, "update": {"z": "z + K_i*error"},
    "gives": {"asked": "max(0, want)"},
}  # fmt: skip
LEVEL = bg.State("level", "(asked - level)/T", low=0)


def _validated(level: Any = LEVEL, path: str | None = None, **told: Any) -> Any:
    nodes = [
        bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("clutch"),
        bg.Function("error", "omega - allowed"), bg.Function("want", "K*error + z"), level,
        bg.Controller("pi", **(GOOD | told)),
    ]  # fmt: skip
    return bg.validate(bg.graph(nodes, "shaft > J, shaft > clutch", *([path] if path else [])))


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ({"reads": ["want"]}, "its expressions read error, which its reads leave out; add what is meant"),
        ({"reads": ["wnat", "error"]}, "its reads name wnat (did you mean 'want'?), but its expressions"),
        ({"gives": {"asked": "max(0, wnat)"}}, "its reads name want (did you mean 'wnat'?)"),
        ({"states": ["z"]}, "states must map names to expressions, such as states={'z': 0}, not be ['z']"),
        ({"gives": ["asked"]}, "such as gives={'u': 'K*e'}, not be ['asked']"),
        ({"update": {"asked": "want"}, "gives": {"z": "z"}, "reads": None},
         "update of asked, which is no state; tell where it begins, states={'asked': 0}, or write what "
         "others read into gives"),
        ({"gives": {"asked": "clip(want, 0, 9)"}}, "'clip' is not a function an expression may use; a bound "
         "is written max(low, min(high, x))"),
        ({"path": "level > pi"}, "'level' reads what it gives: turn the wire round, 'pi' > 'level'"),
        ({"path": "pi.askd > level"}, "'pi' gives no 'askd' (did you mean 'asked'?); it gives asked"),
        ({"level": bg.State("level", "(aksed - level)/T", low=0)}, "'level' reads aksed"),
        ({"level": bg.State("level", "asked", start=-5, low=0)}, "start -5 is beyond its bound, low 0"),
        ({"level": bg.State("level", "asked", start=5, high=3)}, "start 5 is beyond its bound, high 3"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_with_what_was_meant(told: dict[str, Any], message: str) -> None:
    _validated()
    with pytest.raises(bg.BondGraphError) as caught:
        _validated(**told)
    assert message in str(caught.value)


def test_a_state_may_start_at_its_bound_or_between_parameters() -> None:
    for start, low in ((0, 0), ("x_0", 0), (-1, "lowest")):
        _validated(bg.State("level", "(asked - level)/T", start=start, low=low))
