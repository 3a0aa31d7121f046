"""Works, integrals and power balances of many runs: which signals C must know, and what to make of totals."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.errors import SignalError
from codegen.batch.plan import Column, Gathering, Numbers, Plan, plain
from codegen.energy.accounts import Account, Accounts, Product, accounts, with_signals
from codegen.energy.ledger import GAVE, LOST, TOOK, sides
from codegen.energy.stored import stored_energy
from codegen.family import Family
from codegen.model.exact_values import exact_parameters
from codegen.numbers.arrays import Array
from codegen.numbers.lambdified import lambdified
from codegen.program.layout import places
from codegen.record.measures import READY, Measure

ENERGETIC = ("integral", "work", "balance")
"""Measures of integrals."""


def telling(family: Family, measures: Iterable[Measure]) -> tuple[Family, Accounts]:
    """The family whose programs know all signals that measures of integrals need; itself if it does."""
    if family not in _accounts:
        _accounts[family] = accounts(family.equations)
    made, known = _accounts[family], places(family.program)
    needed = _needed(measures, made)
    strange = {p.one for p in needed if not p.other} - known.keys()
    strange &= set(map(str, family.equations.signals))
    if strange:
        made = with_signals(made, strange)
    elif all(name in known for p in needed for name in (p.one, p.other) if name):
        return family, made
    elif family in _told:
        return _told[family], made
    told = replace(family, equations=made.equations)
    if not strange:
        _told[family] = told
    return told, made


_accounts: WeakKeyDictionary[Family, Accounts] = WeakKeyDictionary()
_told: WeakKeyDictionary[Family, Family] = WeakKeyDictionary()


def plan(
    measures: Iterable[Measure], family: Family, made: Accounts | None, time: Array,
    swept: Iterable[str],
) -> Plan | None:  # fmt: skip
    """How the loop gets these measures; None where one is none that it can do.

    ``made``: what measures of integrals are made of.
    """
    gathered, columns = Gathering(family.program, len(time)), list[Column]()
    for measure in measures:
        name = READY[measure.function]
        if made is not None and name == "balance":
            column: Column | None = _balance(gathered, family, made, time, set(swept))
        elif made is not None and name in ENERGETIC:
            (account,) = _whole(measure, made)
            known = all(gathered.knows(n) for p in account for n in (p.one, p.other) if n)
            column = _summed(gathered.account(account)) if known else None
        else:
            column = plain(measure, gathered)
        if column is None:
            return None
        columns.append(column)
    return gathered.plan(columns)


def _needed(measures: Iterable[Measure], made: Accounts) -> list[Product]:
    return [p for measure in measures for account in _whole(measure, made) for p in account]


def _whole(measure: Measure, made: Accounts) -> list[Account]:
    """The accounts that a measure is made of."""
    name = READY[measure.function]
    if name == "integral":
        return [(Product(1.0, measure.arguments[0], ""),)]
    if name == "work":
        return [made.of(measure.arguments[0])]
    return [*made.power.values(), *made.moved.values()] if name == "balance" else []


def _summed(account: Callable[[Array], Array]) -> Column:
    return lambda found, numbers: account(found)


def _balance(
    gathered: Gathering, family: Family, made: Accounts, time: Array, swept: set[str]
) -> Column:
    """What the power balance leaves open, of the energy turned over."""
    fixed = exact_parameters({n: v for n, v in family.parameters.items() if n not in swept})
    given: list[tuple[float, Callable[[Array], Array]]] = []
    held: list[tuple[Callable[[Array], Array] | None, Column, Column]] = []
    for node, side in sides(family.equations).items():
        if side in (GAVE, LOST):
            sign = 1.0 if side == GAVE else -1.0
            given.append((sign, gathered.account(made.of(node))))
        if side != TOOK:
            continue
        try:
            energy = stored_energy(family.equations, node, fixed)
        except SignalError:
            given.append((-1.0, gathered.account(made.of(node))))
            continue
        moved = tuple(p for part in made.parts(node) for p in made.moved.get(part, ()))
        begin = _energy(gathered, energy, "start", float(time[0]))
        end = _energy(gathered, energy, "final", float(time[-1]))
        held.append((gathered.account(moved) if moved else None, begin, end))

    def column(found: Array, numbers: Numbers) -> Array:
        left, turned = np.zeros(len(found)), np.zeros(len(found))
        for sign, account in given:
            left += sign * account(found)
            turned += np.abs(account(found))
        for gained, first, last in held:
            begin, end = first(found, numbers), last(found, numbers)
            took = end - begin + (0.0 if gained is None else gained(found))
            left -= took
            turned += np.abs(took) + np.abs(begin) + np.abs(end)
        return np.divide(np.abs(left), turned, out=np.abs(left), where=turned > 0)

    return column


def _energy(gathered: Gathering, energy: sp.Expr, what: str, t: float) -> Column:
    """What a storage holds at one end of a run."""
    names = sorted(energy.free_symbols, key=str)
    function = lambdified(names, energy)
    at: Mapping[str, int] = {
        n.name: gathered.signal(what, n.name) for n in names if gathered.knows(n.name)
    }

    def column(found: Array, numbers: Numbers) -> Array:
        known = [
            found[:, at[n.name]] if n.name in at else t if n == TIME else numbers[n.name]
            for n in names
        ]
        result: Array = np.zeros(len(found)) + np.asarray(function(*known), dtype=float)
        return result

    return column
