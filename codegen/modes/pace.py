"""How short a moment is: the pace of a model and its sources, and never that of how long a run is to be.

So a run gives the same events however far it goes: what is told of an instant rests on what led to it.
"""

from codegen.tuning import TUNING


def time_constant(fastest: float, elapsed: float) -> float:
    """The shortest time constant [s] at the largest rate [1/s]; ``elapsed`` [s]: since the run began.

    What has no rate of its own is as slow as the run is old: a hundredth of that.

    >>> time_constant(1e3, 10.0), time_constant(0.0, 0.0), time_constant(0.0, 500.0)
    (0.001, 0.01, 5.0)
    """
    return 1 / max(fastest, TUNING.slowest / max(elapsed, 1.0))


def look_ahead(time: float, t: float, following: float) -> float:
    """How much later [s] ties at t are decided; never beyond ``following`` [s], the next breakpoint.

    >>> round(look_ahead(0.01, 1.0, 2.0), 9), look_ahead(1e4, 1.0, 2.0)
    (1e-06, 0.5)
    """
    return min(TUNING.look_ahead * time, 0.5 * (following - t))


def moment(time: float) -> float:
    """A time [s] too short to matter, in which what starts from complete rest gets going."""
    return TUNING.look_ahead * min(time, 1 / TUNING.slowest)


def hardly_apart(time: float) -> float:
    """Within this time [s] as many events as `TUNING.stalled` are a run that goes nowhere."""
    return 2 * TUNING.stalled * moment(time)


def longest_step(elapsed: float) -> float:
    """No step is longer [s]: laws that sleep where a run is must be found where it comes to.

    >>> longest_step(0.0), longest_step(500.0)
    (0.05, 25.0)
    """
    return max(elapsed, 1.0) / TUNING.coarsest
