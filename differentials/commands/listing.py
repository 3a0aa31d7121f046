"""``list``: the differentials and scenarios there are."""

from dataclasses import fields

import click

import bondgraph as bg
from differentials.aligned import table
from differentials.commands.helping import as_json, command
from differentials.control.manoeuvres import manoeuvres
from differentials.scenarios import scenarios
from differentials.topologies import catalog, graph


@command("list", "list --json")
@as_json
def list_all(as_json: bool) -> None:
    """The catalog's differentials, and the scenarios there are."""
    orders = {name: len(bg.assign_causality(graph(name)).integral) for name in catalog}
    if as_json:
        # What prints numbers of all kinds takes as long to import as everything else here.
        from differentials.commands.printing import print_json

        print_json({"differentials": [_row(name, orders[name]) for name in catalog],
                    "scenarios": [_case(name) for name in scenarios],
                    "manoeuvres": [_driven(name) for name in manoeuvres]})  # fmt: skip
        return
    rows = [("name", "states", "clutches", "scenario", "what it is")]
    for name, chosen in catalog.items():
        count = str(orders[name]) + (f" or {3 * chosen.wheels}" if chosen.full else "")
        title = f"{chosen.title} ({chosen.source})"
        rows.append((name, count, str(len(chosen.clutches)), chosen.scenario, title))
    click.echo(table(rows))
    click.echo(f"\nscenarios: {', '.join(scenarios)}")
    click.echo(f"in a car, with a controller: {', '.join(manoeuvres)}\n\nNext: bondgraph show alsd")


def _row(name: str, order: int) -> dict[str, object]:
    chosen = catalog[name]
    return {
        "name": name, "title": chosen.title, "source": chosen.source, "states": order,
        "full_states": 3 * chosen.wheels if chosen.full else None, "wheels": chosen.wheels,
        "clutches": chosen.clutches, "scenario": chosen.scenario,
    }  # fmt: skip


def _driven(name: str) -> dict[str, object]:
    case = manoeuvres[name]
    return {"name": name, **{key.name: getattr(case, key.name) for key in fields(case)}}


def _case(name: str) -> dict[str, object]:
    case = scenarios[name]
    keys = ("wheel_speed", "speed_difference", "engine_torque", "clutch_torques", "engine_step",
            "clutch_step", "duration", "lag", "parameters")  # fmt: skip
    return {"name": name, **{key: getattr(case, key) for key in keys}}
