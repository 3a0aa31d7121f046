"""Every tolerance and choice of size that runs rest on, once.

numpy reads them here, as ``TUNING.rounding``; C as ``BG_ROUNDING`` of ``tuning.h``, which is printed from
this. Coefficients of methods are none: they stand in their tables.
"""

from dataclasses import dataclass, field, fields
from typing import Any


def _told(value: float, what: str) -> Any:
    """A number, and what it is and why."""
    return field(default=value, metadata={"what": what})


@dataclass(frozen=True)
class Tuning:
    """The numbers by name, in the order of what they are for."""

    # What counts as zero
    rounding: float = _told(1e-10, "of the terms that make a slip, an effort or a level up: zero")
    timed: float = _told(1e-14, "the same of what time alone rules")
    pushes: float = _told(
        10.0, "so many times that of a slip's rate: its terms have been solved for"
    )
    late: float = _told(16.0, "spacings of t by which an event's time may be off")
    term: float = _told(2.0**-20, "relative change whose effect, divided by it, is a term")
    far: float = _told(2.0**30, "how far out affine maps are probed: dividing by it is exact")

    # How friction ports are decided
    wide: float = _told(1e3, "an event's own rounding, in what counts as zero")
    moving: float = _told(1e-4, "a moment later, of what counts as zero: above it a change is real")
    seen: float = _told(1e-2, "the same where efforts change a slip at once")
    left: float = _told(10.0, "slips that inputs rule have left zero at so many times what is zero")
    hysteresis: float = _told(
        10.0, "roundings that a unit's indicators are beyond what still holds"
    )
    circles: float = _told(16.0, "times an importer is late by: slips so near to zero circle it")
    breakaway: float = _told(1e-12, "part by which a limit may fall short: its own rounding")
    nothing_held: float = _told(1e-12, "entries of a holding equation that are none")
    consistent: float = _told(1e-9, "part of a combination's terms that may be left of it")
    same_branch: float = _told(1e-6, "a start and what its law, turned round, makes of it are one")
    akima_level: float = _told(1e-9, "of the largest turn of Akima's chords: none, as scipy has it")
    nothing: float = _told(1e-11, "entries below this part of the largest are rounding")
    least_cap: float = _told(
        1e-15, "of the largest effort: the least that a port's limit counts as"
    )
    delayed: float = _told(1e-12, "of what a delay reads: how far its polynomials may be off")
    remembered: float = _told(0.1, "the same of a run's relative tolerance, if that is more")
    part_halves: int = _told(12, "a part that a delay reads is halved so often, at most")
    seam: float = _told(
        1e-9, "of what a delay reads: what steps over a seam of its parts may err by"
    )
    seam_rounding: float = _told(
        1e-12, "the same by rounding, times the lengths of parts over theirs"
    )
    seam_reach: float = _told(2.0**-5, "of a delay: no step over a seam counts as shorter")
    renewed: int = _told(
        40, "so often a unit renews what its delays read between an importer's points"
    )
    least_memory: int = _told(
        1024, "parts that exported C remembers for its delays, at the least .."
    )
    most_memory: int = _told(65536, ".. and at the most, unless its caller tells")
    tiny: float = _told(1e-300, "larger than nothing")
    exchanged: float = _told(1e-14, "of its terms, by which a shared effort may be above its share")
    exchanges: int = _told(10_000, "ports exchanged beyond which rounding alone would go on")

    # Products with large tables
    large_table: int = _told(4096, "entries from which it pays to look which are zero ..")
    few_entries: int = _told(10, ".. the others are multiplied alone if they are one in so many")

    # How short a moment is
    look_ahead: float = _told(1e-4, "ties are decided this part of a time constant later")
    slowest: float = _told(100.0, "1/s, below which nothing is called fast while a run is young")
    coarsest: float = _told(20.0, "no step is longer than what went before over this")
    impacts: int = _told(20, "so often a mode is decided again where one impact leads to another")
    renewals: int = _told(100, "so often events may reset states in one instant")
    stalled: int = _told(60, "so many events within a moment are a run that goes nowhere")
    quiet: int = _told(8, "so many events without motion are at rest, to and fro")
    together: float = _told(1e-12, "events so close, of the time, are one")

    # Stops
    bounce: float = _told(10.0, "of what counts as zero of a slip: what closes no faster stays")
    leap: float = _told(4.0, "of what counts as zero of a gap: what leaps no higher stays")
    lingers: float = _told(0.99, "of a speed two crossings before: swings that shrink no faster")
    lingering: float = _told(10.0, "speeds of theirs that count as unseen are so many times larger")
    short_of: float = _told(
        0.1, "of what a struck stop is to gain: one that lacks more hangs on another"
    )
    bounces: int = _told(2000, "so often stops are struck in one instant, at most")

    # Impulses through laws that bend
    bent: float = _told(1e-12, "of states and of what storages hold: what is left is rounding")
    bends: int = _told(100, "so many of Newton's steps are taken, at most ..")
    bent_halves: int = _told(40, ".. and each is halved so often, until what is left shrinks")

    # Laws that determine one another
    residual: float = _told(1e-9, "part of their magnitude to which laws are solved")
    residual_floor: float = _told(1e-3, "added to that magnitude")
    loop_difference: float = _told(1e-7, "relative difference for the slopes of laws")
    loop_floor: float = _told(1e-6, "added to what that is relative to")
    loop_lost: float = _told(2.0**-44, "of what is left: a smaller change is lost ..")
    loop_wider: float = _told(1024.0, ".. and the difference is made so much larger")
    root_turns: int = _told(
        1000, "steps of a root's search: four times as many as halve to nothing"
    )
    portions: int = _told(2000, "so often a part of what laws receive is solved for, at most")
    least_portion: float = _told(1e-15, "a smaller part more is none")
    huge: float = _told(1e300, "stands for what is no number")
    least_interval: float = _told(
        1e-30, "of the first interval of a root's search, where it is at 0"
    )

    # Integrators with step control
    rtol: float = _told(1e-8, "relative tolerance, unless it is told otherwise")
    atol: float = _told(1e-10, "the same in units of each state")
    stiff_span: float = _told(2e5, "run over time constant from which steps are implicit")
    stiff_step: float = _told(5e3, "the same, over time constant, of a unit's communication step")
    patience: int = _told(
        30, "explicit steps that stability alone holds back, before implicit ones"
    )
    eased: float = _told(1e-2, "error of a step, in tolerances, that stability alone holds back")
    held: float = _told(0.9, "of the longest stable step: longer ones are held back")
    worth: float = _told(300.0, "time constants left of a stretch that are worth implicit steps")
    lot_implicit: int = _told(10, "implicit steps whose mean length is looked at")
    gain: float = _told(1.0, "stable explicit steps, at the least, that an implicit one stands for")
    gain_size: float = _told(0.125, "the same, more for each state: what its equations cost")
    later: int = _told(8, "so many times the patience after implicit steps that were no longer")
    followed: float = _told(0.1, "an implicit step in time constants of the inputs")
    wary: int = _told(5, "explicit steps from a corner on that are judged by both estimates")
    risen: float = _told(8.0, "so many times that of the step before tells a corner of the rates")
    refresh: int = _told(50, "steps after which time constants are looked at again")
    checks: int = _told(6, "points inside a step at which events are looked for")
    dip: float = _told(1e-9, "of a step, to which the bottom of a dip is found")
    dip_looks: int = _told(60, "so often, at most")
    dip_inside: float = _told(0.1, "of the distance of two points, next to which none is looked at")
    clear: float = _told(3.0, "changes over half a step above which nothing falls to zero in it")
    settled: float = _told(
        1e-3, "of the tolerance, to which a multistep method's beginning is found"
    )
    evenly: float = _told(1e-9, "of what lies between samples, to which they lie evenly")
    first_small: float = _told(1e-5, "states or rates so small in tolerances tell no first step")
    first_step: float = _told(1e-6, "s, the first step then")
    first_part: float = _told(1e-2, "of what moves a state by itself: a first try; of a tolerance")
    first_flat: float = _told(1e-15, "rates so small change nothing")
    first_shorter: float = _told(1e-3, "of the first try, where nothing changes")
    first_least: float = _told(1e-12, "of the longest step: no first step is shorter")
    newton: float = _told(0.03, "of a tolerance to which stages are solved, or less")
    newton_slow: float = _told(1e-3, "stages that converge more slowly want new slopes")
    slope: float = _told(1e-6, "relative difference for the slopes of rates")
    slope_floor: float = _told(1e-9, "the same of what a rate does in a step, and at the least")
    slope_shorter: float = _told(1e-2, "by which it shrinks where laws have no value")

    # Whether an integrator advances
    lot: int = _told(200, "steps that are looked at together")
    short: float = _told(1e-2, "of what the model allows: shorter steps go nowhere in a slide")
    shorter: float = _told(1e-4, "of the same: shorter steps go nowhere at any jump")
    reach: int = _told(32, "so many such steps ahead a jump is looked for")
    back: float = _told(2.0**-10, "of the reach beyond a jump, where rates push back if they do")
    halves: int = _told(24, "a change that is whole after so many halvings is a jump")
    whole: float = _told(0.1, "of a change, which is left of a jump")
    felt: float = _told(1e-3, "tolerances that a jump changes rates by at the least")

    # Exact steps
    degree: int = _told(18, "of power series: over |M| h <= 1 what is left out is below rounding")
    powers: int = _told(30, "terms of a power series in C at most, over |M| h <= `longest` ..")
    left_out: float = _told(2.0**-57, ".. where one of this part of the first is the last")
    pair_degree: int = _told(21, "the same of pairs: over |M| h <= 1/4 it is below 1e-32")
    rungs: int = _told(62, "doublings beyond which rounding of pairs would show: 2^62 are 1e-13")
    rounded: float = _told(1e4, "so many steps in double precision leave all digits that count")
    many: float = _told(3e5, "so many steps are always taken where something is watched ..")
    least_part: float = _told(
        0.01, ".. of more, unless a smaller part follows what has not decayed .."
    )
    most: float = _told(1e9, ".. up to some half an hour's of numpy ..")
    most_in_c: float = _told(1e11, ".. or some hours' of C")
    gone: float = _told(40.0, "time constants after which a motion is below rounding")
    longest: float = _told(2.5, "|M| h of one step of a leap: bounds need its square below 8")
    radius: float = _told(0.75, "|M| h of the Taylor polynomial of degree 16: 0.75^17/17! = 2e-17")
    large: int = _told(500, "larger states than 2 to this power are scaled down")
    alike: float = _told(1e-9, "part by which distances of samples that are one may differ")
    narrow: float = _told(2.0**-44, "intervals of a polynomial are not divided further")
    polished: float = _told(1e-16, "part of a root by which Newton's last step moves it")
    halved: float = _told(4e-16, "part of a root that its interval is")
    bound_slack: float = _told(1e-9, "part by which bounds may be rounded")
    slots_floor: float = _told(
        1e-3, "1/s, added to a model's rates where inputs are weighed by them"
    )

    # Fixed steps
    band: float = _told(1e-6, "dead band of a port, unless it is told otherwise")
    still: float = _told(1e-12, "dead band where only an instant is asked for")
    step_rounding: float = _told(1e-9, "of what makes a slip or its rate up: zero to a step")
    brief: float = _told(1e-6, "of a step: in that time its start is decided, value before rate")
    shared: float = _told(1e-9, "of how a slip yields: ports that hold it together share by that")
    loose: float = _told(1e-8, "of what moves a slip: what is left of it where ports share is none")
    rounds: int = _told(
        6, "so often a step's start is decided again where one change causes others"
    )
    step_drift: float = _told(1e-2, "of what moves a held slip in a step: the step's own error")
    difference: float = _told(1e-7, "of the states' magnitudes: a difference for the fastest rates")
    part_in_time: float = _told(1e-5, "of a step: a difference for the slope of the rates in time")
    range_part: float = _told(1e-2, "of a state's range: a larger error of a step is told")
    farther: float = _told(8.0, "a second one, so many times as large, must find a like slope")
    unexplained: float = _told(0.2, "part of a fit of the fastest rates that may be left over")
    sine: float = _told(1e-2, "closer to one another, two vectors count as one")
    stirred: float = _told(0.01, "of every direction, mixed into the vector that is kept")
    seeded: float = _told(0.1, "of the kept vector, mixed into what the stages tell")
    reach_part: float = _told(1e-3, "of all states' magnitude: the least of each")
    reach_floor: float = _told(1e-10, "the same where all are zero")
    bracket: float = _told(1e-3, "by which the boundary of stability is searched farther")
    cuts: int = _told(1000, "parts that instants of tasks may cut a step of exported C into")
    whole_steps: float = _told(1e-9, "part by which a stretch may be longer than whole steps")

    # Many runs, and sources
    doubtful: float = _told(1e-9, "pivot of A, its diagonal 1, from which it may be singular")
    cancelled: float = _told(1e-6, "of an input's largest coefficient: above it nothing cancels")

    # Units
    most_scalars: int = _told(
        1000, "values of a table that a unit of FMI 2.0, without arrays, lists"
    )
    unit_difference: float = _told(6e-6, "relative difference for a unit's directional derivatives")
    switch_part: float = _told(
        1e-9, "of a switch's largest value by which it may be beyond zero .."
    )
    switch_floor: float = _told(1e-12, ".. and at the least")
    turns: float = _told(0.05, "radians, or powers of e, that known sources do little in")

    kept_closer: float = _told(1e-3, "of an importer's tolerance, which steps between its own keep")

    # What is numpy's alone, by the folders that read it
    sparse_rtol: float = _told(1e-8, "relative tolerance of runs of sparse models")
    sparse_atol: float = _told(1e-10, "absolute tolerance of the same")
    even: float = _told(1e-6, "part of a distance by which samples may be uneven for a spectrum")
    cancelling: float = _told(1e-12, "of its terms: a pivot of A below is none")
    one_length: float = _told(1e-13, "part by which lengths of stretches that are one may differ")
    unit_step: float = _told(1e-2, "s, the step of a unit that nothing bounds")
    unit_longest: float = _told(1e-3, "s, no step of a unit is longer where something moves")
    usual_step: float = _told(1e-4, "s, the longest step of exported Python by itself")
    hardly: float = _told(2.0**-40, "of an interval, by which branches are told apart")
    resonance: float = _told(
        1e-3, "rates so near each other, over one of them, are summed as a series"
    )
    zero_value: float = _told(
        2.0**-49,
        "of its terms: a value of an input below is zero",
    )
    segment_rounding: float = _told(2.0**-50, "of an expression of time: its own rounding")
    flat: float = _told(2.0**-20, "of a segment, by which its ends are no part of it")
    nothing_there: float = _told(1e-40, "expressions of time below are zero")
    narrowest: float = _told(2.0**-40, "of a run: segments of a source are no shorter")
    least_span: float = _told(1e-6, "s, the least span that segments are made for")
    called: float = _told(2.0**-40, "of a Python function, by which polynomials may miss it")
    energy_rounding: float = _told(1e-12, "of the entries of a storage: an energy below is zero")
    searched: float = _told(1e-13, "tolerance of a search for what laws give")
    beside: float = _told(1e-8, "of a root, by which one looks beside it")
    pole: float = _told(
        1e-3, "of the values about a change of sign: a larger one between is a pole"
    )
    shortest: float = _told(1e-6, "s, the shortest run that sources are told for")
    guard_moment: float = _told(1e-9, "of the time, in which a guard moves by rounding")
    guard_floor: float = _told(1e-3, "s, the least time for that")
    rate_rounding: float = _told(1e-12, "of the largest rate: smaller ones are rounding")
    tighter: float = _told(
        1e-2, "of the tolerances, which CVODE is given, as its error is a step's"
    )
    standing: float = _told(
        1e-3, "of a moment: how far after an instant without a run ties are decided"
    )
    quick: float = _told(1e-2, "s, the shortest chunk of runs that is handed out")
    least_each: float = _told(1e-6, "s, the least that a run counts as")
    close: float = _told(1e-10, "of its terms: what may be left of a steady state")
    trim_floor: float = _told(1e-9, "added to the terms of a steady state")
    regular: float = _told(
        1e-8, "of the largest singular value, or of terms: less takes an exact look"
    )
    side_by_side: int = _told(8, "runs of a sweep in numpy: fewer are done one by one")
    beside_at_once: int = _told(1_000_000, "numbers at samples of runs done side by side")
    products_beside: int = _told(
        500_000, "products of entries of a model whose runs go side by side"
    )
    ordinary: float = _told(1e100, "numbers that runs side by side stay below")
    surely: float = _told(4.0, "times what counts as zero: what is beyond is told alike everywhere")
    independent: float = _told(1e-13, "of the largest singular value: smaller ones are none")


TUNING = Tuning()
"""What all runs use."""


def tuning_text() -> str:
    """The numbers as C, ``tuning.h``."""
    lines = ["/* Tolerances and choices of size; written by bondgraph-toolkit. */"]
    lines += ["#ifndef BG_TUNING_H", "#define BG_TUNING_H", ""]
    for one in fields(TUNING):
        value, what = getattr(TUNING, one.name), one.metadata["what"]
        lines.append(f"#define BG_{one.name.upper()} {value!r} /* {what} */")
    return "\n".join([*lines, "", "#endif", ""])
