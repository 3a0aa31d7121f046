"""The end of generated Python: the formulas put together with what is the same for every model."""

from codegen.corners.refusing import refusals
from codegen.energy.holdings import Holdings
from codegen.program.records import Group, Program
from codegen.python.beginning import beginning, held_table
from codegen.python.blocks import bound, law_names
from codegen.python.lagging import delayed_table, lagging
from codegen.python.looking import model_words, table_shapes
from codegen.python.tables import slip_rows
from codegen.python.text import RULE, listing, quoted
from codegen.python.ticking import clocks, reset_rows, ticking
from codegen.standalone.ranks import SlipRows
from codegen.standalone.switchings import Switching

_FORM = '''def form({given}):
    """The formulas with these parameters, and where everything stands."""
    return Form(
        states=len(X),
        inputs=U,
        readings=Y,
        given=GIVEN,
        known=Laws(BlockFormula({known}, parameters, len(KNOWN)), KNOWN, [], []),
        known_rates={rates},
        beyond=BEYOND,
        matrices=matrices({coefficients}, parameters, varying={varying}),
        laws={laws},
        early={early},
        law_rates=LAW_RATES,
        varying={varying},{exchanged}
    )'''

_EXCHANGED = """
        momenta=BlockFormula({momenta}, parameters, {count}),
        momenta_rows={rows},"""
"""Where impulses move slopes of A."""

_FRICTION = '''

def friction({given}):
    """The friction ports."""
    ports = Ports(
        names=FRICTION,
        inputs=FRICTION_INPUTS,
        readings=FRICTION_READINGS,
        received=FRICTION_RECEIVED,
        moving=FRICTION_MOVING,
        beside=BESIDE,
        held=lambda stuck: {held},
        values=BlockFormula({values}, parameters, 4 * len(FRICTION)),
        exact=parameters == PARAMETERS,
    )'''

_SWITCHES = '''

def switches({given}):
    """When the ports change over that are ideal switches."""
    guards = BlockFormula({conditions}, parameters, {count})
    return {record}(SWITCHING, FRICTION, guards, {count}{hung})'''

_MODEL = '''

class Model({base}):
    """The model with numbers for its parameters.

    ``rhs`` and ``outputs`` take x in the order of STATES and u in that of INPUTS.
    """
{resets}
    def __init__(self, parameters=None{tables}):
        self.parameters = named(parameters or {{}}, PARAMETERS, "parameter"){own}
        super().__init__({arguments})


def simulate(time, initial, inputs, parameters=None, step=STEP, dead_band=1e-6{also}{tables}):
    """Integrate with steps of at most ``step`` [s] and sample at the times given.

    ``initial``: states{also_held} by name, the rest start at {rest}. ``inputs``: a number or a
    function of time for each of INPUTS{but}. ``dead_band``: slips below it may stick. {told}The
    work of a step is bounded: nothing is located inside it. Returns arrays by name: t, states,
    inputs, outputs, {what}.{values}

    Raises `UnstableStep` for a step beyond the stability of its method, with the longest that is
    stable; LONGEST_STEP is that of the start.
    """
    {begin}return run({model}, time, {initial}, inputs, step, dead_band{given})'''


_FROM_ZERO = {"rest": "0", "initial": "begun"}
_TOLD = {"rest": "STARTS, or 0", "initial": "{**STARTS, **begun}"}
"""Where no start is declared, and where some are."""

_PLAIN = {"also": "", "given": "", "told": "", "what": "friction efforts"}

_SLIDES = ", slides=True"

_SWITCHED = {
    "also": ", initially_on=()",
    "given": ", initially_on",
    "what": "friction\n    efforts, and for each of SWITCHES 1 while it is on, 0 while it is off",
    "told": (
        "Switches\n    change over at starts of steps. ``initially_on``: those of SWITCHES that are on "
        "before the\n    first, as far as conditions let them; states that are not in ``initial`` then "
        "follow what these\n    hold, and a warning tells. "
    ),
}


def needed(program: Program, slips: SlipRows | None, implicit: bool, held: bool) -> list[str]:
    """The modules that a program's model works with, beside those that these import.

    ``slips``: what ports receive; None where every set's slips bind the states, each by itself. ``held``:
    whether a start may tell what storages hold.
    """
    also = {
        "settling": bool(program.friction) and not program.guarded,
        "switched": program.guarded and not (program.stopped or program.events or program.hanging),
        "joint": program.joint,
        "loops": any(group.loop for group in program.groups),
        "ranks": slips is not None,
        "rosenbrock": implicit,
    }
    folders = dict.fromkeys(also, "standalone") | {"settling": "fixed", "switched": "fixed"}
    names = [f"codegen.{folders[name]}.{name}" for name, wanted in also.items() if wanted]
    events = {"stopping": program.stopped, "resetting": program.events, "hanging": program.hanging}
    names += [f"codegen.stops.{name}" for name, wanted in events.items() if wanted]
    names += ["codegen.fixed.ticking"] if program.clocks else []
    names += ["codegen.fixed.remembering"] if program.delayed else []
    names += ["codegen.fixed.tabled"] if program.tables else []
    names += ["codegen.fixed.starting"] if held else []
    back = any(table.turned for table in program.tables)
    names += ["bondgraph.tables.backward"] if back else []
    names += ["bondgraph.searching"] if program.turnings else []
    return ["codegen.standalone.formulas", "codegen.standalone.running", *names]


def closing(
    program: Program, slips: SlipRows | None, told: bool, held: Holdings, implicit: bool = False
) -> list[str]:
    """Functions that bind formulas and tables to the rest, the class `Model`, and `simulate`.

    ``slips``: as `needed` takes them. ``told``: whether there is a table STARTS; ``held``: what a start may
    tell of storages; ``implicit``: whether steps are linearly implicit.
    """
    names = "STATES, INPUTS, SHOWN, SWITCHES" if program.guarded else "STATES, INPUTS, SHOWN"
    lines = [RULE, "# How this model is put together.", "", f"NAMES = Names({names})"]
    taken = "self.parameters, self.tables" if program.tables else "self.parameters"
    base, arguments = "FixedSteps", f"form({taken}), NAMES"
    if program.friction:
        base, arguments = "PortSteps", f"NAMES, friction({taken})"
        lines += [] if slips is None else slip_rows(slips)
    if program.guarded:
        base = _base(program)
        arguments = f"{arguments}, switches({taken})"
        lines += _switching(program)
    base = f"Rosenbrock, {base}" if implicit else base
    if program.clocks:
        base = f"TickingSteps, {base}"
        lines += clocks(program)
    if program.delayed:
        base = f"RememberingSteps, {base}"
        lines += delayed_table(program)
    if program.tables:
        lines += ["", *table_shapes(program)]
    base = f"InsideTables, {base}" if refusals(program) else base
    lines += held_table(held)
    lines += ["", "", *_form(program)]
    lines += _friction(program, slips) if program.friction else []
    if program.guarded:
        lines += _switches(program)
    words = (_SWITCHED if program.guarded else _PLAIN) | (_TOLD if told else _FROM_ZERO)
    resets = "\n    resets = RESETS\n" if program.events else ""
    resets += "\n    clocks, ticks = CLOCKS, TICKS\n" if program.clocks else ""
    resets += "\n    delayed = DELAYED\n" if program.delayed else ""
    resets += "\n    refusing = REFUSING\n" if refusals(program) else ""
    words |= model_words(program)
    words |= beginning(words, held)
    words["but"] = " but DELAYED" if program.delayed else ""
    words["own"] += ticking(program) + lagging(program)
    model = _MODEL.format(base=base, arguments=arguments, resets=resets, **words)
    return [*lines, *model.splitlines()]


def _given(program: Program) -> str:
    return "parameters, tables" if program.tables else "parameters"


def _base(program: Program) -> str:
    """The classes of fixed steps that a model with switches, stops or jumps of second order is of."""
    bases = ["ResettingSteps"] if program.events else []
    bases += ["HangingSteps"] if program.hanging else []
    bases += ["StoppedSteps"] if program.stopped else []
    return ", ".join(bases or ["SwitchedSteps"])


def _switches(program: Program) -> list[str]:
    words = {"record": "Switches", "hung": ""}
    words["given"] = _given(program)
    words["conditions"] = bound("switch_conditions", program.guards)
    if program.hanging:
        words |= {"record": "Hanging", "hung": f", {program.hanging}"}
    return _SWITCHES.format(count=len(program.guards.results), **words).splitlines()


def _switching(program: Program) -> list[str]:
    """When each port changes over."""
    note = (
        "When ports change over that are ideal switches: on while held?; side; place of conditions."
    )
    rows = [
        f"    {None if port.switch is None else _told(port.switch)}," for port in program.friction
    ]
    lines = ["", f"# {note}", "SWITCHING = (", *rows, ")"]
    if not program.events:
        return lines
    rows = reset_rows(program.events)
    note = "What resets states: the port and the mode it comes to; places of state and value."
    return [*lines, "", f"# {note}", "RESETS = (", *rows, ")"]


def _told(one: Switching) -> str:
    """A switch as text."""
    more = _SLIDES * one.slides
    if one.stops:
        more = f", place={one.place}, opening={one.opening}"
    if one.machine:
        more = f", machine={one.machine}"
    return f"Switching({one.on}, {one.side}, {one.guard}{more})"


def _form(program: Program) -> list[str]:
    slopes = bound("known_law_rates", program.known_rates)
    rates = f"BlockFormula({slopes}, parameters, len(KNOWN))" if program.rated else None
    laws: list[str] = []
    for name, group in zip(law_names(program), program.groups, strict=True):
        laws += _group("Loop(" if group.loop else "Laws(", name, group, "),", 12)
    listed = "\n".join(["(", *laws, "        )"]) if laws else "()"
    exchanged = _EXCHANGED.format(
        momenta=bound("momenta", program.momenta), count=len(program.momenta.results),
        rows=list(program.momenta_rows),
    ) if program.momenta.results else ""  # fmt: skip
    return _FORM.format(
        rates=rates, exchanged=exchanged, varying=program.varying, laws=listed,
        early=program.early, given=_given(program),
        known=bound("known_laws", program.known.values),
        coefficients=bound("coefficients", program.coefficients),
    ).splitlines()  # fmt: skip


def _group(opening: str, name: str, group: Group, closing: str, indent: int) -> list[str]:
    ports = ", ".join(quoted(str(port)) for port in group.ports)
    named = bound(name, group.values)
    parts = [f"BlockFormula({named}, parameters, {len(group.inputs)})", f"{list(group.inputs)}"]
    return listing(opening, [*parts, f"{list(group.readings)}", f"[{ports}]"], closing, indent)


def _friction(program: Program, slips: SlipRows | None) -> list[str]:
    held = "plain_set(len(stuck))" if slips is None else "held_set(SLIPS, stuck)"
    given, values = _given(program), bound("friction_values", program.friction_values)
    lines = _FRICTION.format(held=held, given=given, values=values).splitlines()
    if not program.joint:
        return [*lines, f"    return Friction(ports, form({given}))"]
    coupled = _group("coupled = Laws(", "coupled_laws", program.coupled, ")", 4)
    return [*lines, *coupled, f"    return JointFriction(ports, form({given}), coupled)"]
