"""Every family of random models: which test it is of, its slice of every run, what a soak promises.

A test takes its seeds from here, `seeds("graphs")`; what it draws follows from the seed alone. A new family
is one more line of `FAMILIES`. `BONDGRAPH_SOAK_GRAPHS=500` makes it 500 seeds, `=1000:1500` those from 1000
on; `make soak` sets these. A fixed set of cases that takes too long for every run is a family of one seed,
which stands for the whole set: `whole("platforms")` says whether it is asked for.
"""

import os
from dataclasses import dataclass


@dataclass(frozen=True)
class Family:
    """Random models, one for each seed from 0 on.

    ``name``: words joined by hyphens. ``test``: the file that takes its seeds, and ``::`` the test where
    the file has several families. ``slice``: how many seeds every run of the tests takes. ``promised``:
    how many a soak has to pass.
    """

    name: str
    test: str
    slice: int
    promised: int

    @property
    def variable(self) -> str:
        """The name in the environment that chooses other seeds."""
        return "BONDGRAPH_SOAK_" + self.name.upper().replace("-", "_")

    @property
    def seeds(self) -> range:
        """The slice, or what the environment says instead: a count, or ``first:stop``."""
        first, _, stop = os.environ.get(self.variable, str(self.slice)).rpartition(":")
        return range(int(first or 0), int(stop))


def seeds(name: str) -> range:
    """The seeds of a family in this run."""
    return family(name).seeds


def whole(name: str) -> bool:
    """Whether this run takes all of a fixed set of cases rather than a part of it."""
    one = family(name)
    assert (one.slice, one.promised) == (0, 1), f"{name} is a family of seeds"
    return bool(one.seeds)


def family(name: str) -> Family:
    """A family by its name; `KeyError` for a name that is not in the table."""
    return {one.name: one for one in FAMILIES}[name]


FAMILIES = (
    # Derivation.
    Family("graphs", "bondgraph/test_random.py::test_small_graph_is_derived_as_brute_force_solves_it",
           400, 10_000),
    Family("larger-graphs",
           "bondgraph/test_random.py::test_larger_graph_is_derived_as_brute_force_solves_it", 60, 1_500),
    # Runs.
    Family("audits-linear", "codegen/test_audit.py::test_random_runs_close", 12, 200),
    Family("audits-rubbing", "codegen/test_audit.py::test_random_runs_close", 6, 200),
    Family("audits-turning", "codegen/test_audit.py::test_random_runs_close", 4, 200),
    Family("audits-rectifying", "codegen/test_audit.py::test_networks_with_diodes_close", 4, 200),
    Family("audits-swept", "codegen/test_audit.py::test_random_sweeps_in_c_close", 1, 300),
    Family("memory", "codegen/test_memory.py", 0, 1),
    Family("flat", "codegen/test_roots.py", 0, 1),
    Family("agreements", "differentials/test_agreement.py", 0, 1),
    Family("platforms", "codegen/test_fmu_platforms.py", 0, 1),
    Family("scenarios", "differentials/test_random_scenarios.py::test_random_scenarios_agree", 40, 2_000),
    Family("diodes", "codegen/test_switched_networks.py::test_diodes_with_resistances", 20, 1_000),
    Family("stiff-linear", "codegen/test_stiff_linear.py::test_states_are_the_exponential", 24, 500),
    Family("ideal-diodes", "codegen/test_switched_networks.py::test_ideal_diodes", 20, 1_000),
)  # fmt: skip
