"""What a start may tell of storages, as C."""

from codegen.c.text import integers, strings
from codegen.energy.holdings import Holdings


def held_sizes(held: Holdings) -> dict[str, int]:
    """How many names there are, and how many values they have."""
    return {"HOLDINGS": len(held.names), "HOLDING_VALUES": len(held.places)}


def held_tables(held: Holdings) -> list[str]:
    """What a start may tell of storages, and the states that follow from it."""
    return [
        *strings("bg_held_names", held.names),
        *integers("bg_held_begins", held.begins),
        *integers("bg_held_states", held.places),
        *integers("bg_held_by_law", map(int, held.by_law)),
    ]
