"""Every family of random models: which test it is of, its slice of every run, what a soak promises.

A test takes its seeds from here, `seeds("graphs")`; what it draws follows from the seed alone. A new family
is one more line of `FAMILIES`. `BONDGRAPH_SOAK_GRAPHS=500` makes it 500 seeds, `=1000:1500` those from 1000
on; `make soak` sets these. A fixed set of cases that takes too long for every run is a family of one seed,
which stands for the whole set: `whole("platforms")` says whether it is asked for.
"""

import math
import os
from dataclasses import dataclass


@dataclass(frozen=True)
class Family:
    """Random models, one for each seed from ``first`` on; `BONDGRAPH_SLICE=0.25` has a quarter of each slice.

    ``name``: words joined by hyphens. ``test``: the file that takes its seeds, and ``::`` the test where
    the file has several families. ``slice``: how many seeds every run of the tests takes. ``promised``:
    how many a soak has to pass.
    """

    name: str
    test: str
    slice: int
    promised: int
    first: int = 0

    @property
    def variable(self) -> str:
        """The name in the environment that chooses other seeds."""
        return "BONDGRAPH_SOAK_" + self.name.upper().replace("-", "_")

    @property
    def seeds(self) -> range:
        """The slice, or what the environment says instead: a count, or ``first:stop``."""
        part = math.ceil(self.slice * float(os.environ.get("BONDGRAPH_SLICE", "1")))
        first, _, stop = os.environ.get(self.variable, str(part)).rpartition(":")
        return range(int(first), int(stop)) if first else range(self.first, self.first + int(stop))


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
    # Values that read inputs.
    Family("supplied", "codegen/test_supplied_random.py", 8, 500),
    # Laws, moving values and tables against all bond equations at once.
    Family(
        "nonlinear",
        "codegen/test_nonlinear_random.py::test_all_bond_equations_hold_at_an_instant_and_a_moment_later",
        16,
        3_000,
    ),
    Family(
        "nonlinear-runs",
        "codegen/test_nonlinear_random.py::test_whole_runs_are_those_of_all_bond_equations_integrated_at_once",
        3,
        300,
    ),
    # Steps from outside.
    Family("stepped", "codegen/stepping/test_random_steps.py", 8, 300),
    # What is shown of equations.
    Family("whole-equations", "codegen/test_whole_equations.py", 12, 1_000),
    # Graphs judged.
    Family(
        "drawn-strokes",
        "bondgraph/checking/test_drawn_strokes.py::test_random_strokes_against_all_that_are_possible",
        40,
        2_000,
    ),
    Family(
        "drawn-causality",
        "bondgraph/checking/test_drawn_strokes.py"
        "::test_as_many_storages_are_blamed_as_have_derivative_causality_without_need",
        40,
        2_000,
    ),
    Family("causal-paths", "bondgraph/checking/test_causal_paths.py", 30, 1_000),
    Family("merged-graphs", "bondgraph/checking/test_merging.py", 30, 1_000),
    Family("derivative-first", "bondgraph/causality/test_derivative_first.py", 40, 2_000),
    # Blocks.
    Family("pid-loops", "bondgraph/blocks/test_pid_plants.py", 50, 1_000),
    # Derivation.
    Family(
        "graphs",
        "bondgraph/test_random.py::test_small_graph_is_derived_as_brute_force_solves_it",
        200,
        10_000,
    ),
    Family(
        "larger-graphs",
        "bondgraph/test_random.py::test_larger_graph_is_derived_as_brute_force_solves_it",
        30,
        1_500,
    ),
    Family(
        "best-causality",
        "bondgraph/test_random.py::test_causality_is_the_best_regular_choice_in_order_of_preference",
        50,
        1_500,
        2_000,
    ),
    Family(
        "mass-matrices",
        "bondgraph/test_random.py::test_mass_matrix_is_symmetric_and_positive_definite_for_positive_storages",
        30,
        600,
        3_000,
    ),
    Family(
        "switched-columns",
        "bondgraph/test_switched_modes.py::test_no_switch_drives_a_dependent_storage",
        60,
        4_000,
    ),
    Family(
        "switched-modes",
        "bondgraph/test_switched_modes.py::test_every_mode_is_a_choice_of_rows",
        40,
        2_000,
    ),
    Family(
        "linear-modes",
        "bondgraph/analyse/test_modes.py::test_a_linear_model_in_a_mode_is_that_of_the_mode_alone",
        25,
        1_000,
    ),
    Family(
        "explicit-graphs",
        "bondgraph/rates/test_random.py::test_rates_of_a_random_graph_solve_its_matrices",
        40,
        1_000,
    ),
    Family(
        "explicit-shafts",
        "bondgraph/rates/test_random.py::test_rates_of_coupled_shafts_solve_their_matrices",
        6,
        20,
    ),
    Family("explicit-laws", "bondgraph/rates/test_loops_of_laws.py::test_random_laws", 15, 400),
    Family(
        "accelerating-mechanisms",
        "bondgraph/analyse/test_accelerating_random.py",
        4,
        200,
    ),
    Family(
        "turned-friction",
        "bondgraph/analyse/test_turned.py::test_turned_equations_are_those_of_the_same_graph",
        30,
        2_000,
    ),
    Family(
        "lossless",
        "bondgraph/test_random.py::test_structure_without_resistances_is_skew_symmetric",
        30,
        600,
        4_000,
    ),
    Family(
        "float-values",
        "bondgraph/test_float_values.py::test_floats_are_derived_as_the_decimals_they_are_written_as",
        50,
        1_500,
    ),
    Family(
        "symbols-as-floats",
        "bondgraph/test_float_values.py::test_symbols_decide_as_floats_unless_a_value_makes_something_vanish",
        50,
        1_500,
    ),
    Family(
        "late-values",
        "bondgraph/test_float_values.py::test_values_given_late_decide_as_values_given_early",
        40,
        1_000,
    ),
    Family(
        "assignments",
        "bondgraph/causality/test_assignments.py::test_put_in_one_after_the_other_they_are_the_readings",
        50,
        1_200,
    ),
    Family(
        "assignments-in-symbols",
        "bondgraph/causality/test_assignments.py::test_the_same_with_symbols",
        15,
        400,
        500,
    ),
    Family(
        "drawings",
        "bondgraph/drawing/test_drawing_geometry.py::test_strokes_of_random_graphs",
        60,
        1_700,
    ),
    Family("files", "bondgraph/files/test_files.py::test_random_graphs_come_back", 15, 400),
    # Runs.
    Family(
        "corners",
        "codegen/runs/test_cornered.py::test_random_chains_are_what_scipy_finds_branch_by_branch",
        3,
        400,
    ),
    Family(
        "friction-chains",
        "codegen/ports/test_friction_random.py::test_every_sample_is_consistent",
        20,
        1_000,
    ),
    Family(
        "breakaway-chains",
        "codegen/ports/test_friction_random.py::test_every_sample_is_consistent_with_breakaway",
        15,
        1_000,
        100,
    ),
    Family(
        "implicit-steps",
        "codegen/ports/test_friction_random.py::test_velocities_are_those_of_small_implicit_steps",
        4,
        200,
    ),
    Family("chain-power", "codegen/ports/test_friction_random.py::test_power_is_balanced", 4, 200),
    Family(
        "sparse",
        "codegen/sparse/test_sparse.py::test_small_graph_has_the_matrices_of_the_exact_derivation",
        100,
        3_000,
    ),
    Family(
        "larger-sparse",
        "codegen/sparse/test_sparse.py::test_larger_graph_has_the_matrices_of_the_exact_derivation",
        8,
        500,
        1_000,
    ),
    Family("audits-linear", "codegen/energy/test_audit.py::test_random_runs_close", 12, 200),
    Family("audits-rubbing", "codegen/energy/test_audit.py::test_random_runs_close", 6, 200),
    Family("audits-turning", "codegen/energy/test_audit.py::test_random_runs_close", 4, 200),
    Family(
        "audits-rectifying", "codegen/energy/test_audit.py::test_networks_with_diodes_close", 4, 200
    ),
    Family("audits-swept", "codegen/energy/test_audit.py::test_random_sweeps_in_c_close", 1, 500),
    Family("memory", "codegen/engine/test_memory.py", 0, 1),
    Family("units", "codegen/fmu/test_fmu_switches.py", 0, 1),
    Family("switches-in-c", "codegen/engine/test_switches_in_c.py", 0, 1),
    Family("switches-swept", "codegen/batch/test_batch_switches.py", 0, 1),
    Family("flat", "codegen/numbers/test_roots.py", 0, 1),
    Family("agreements", "differentials/test_agreement.py", 0, 1),
    Family("routes", "codegen/test_routes.py", 0, 1),
    Family("platforms", "codegen/fmu/test_fmu_platforms.py", 0, 1),
    Family(
        "scenarios",
        "differentials/test_random_scenarios.py::test_random_scenarios_agree",
        20,
        2_000,
    ),
    Family(
        "ruled-friction",
        "codegen/ports/test_friction_ruled.py::test_random_drivelines_move_as_the_judge_finds",
        30,
        2_000,
    ),
    Family(
        "ruled-friction-in-c",
        "codegen/ports/test_friction_ruled.py::test_random_drivelines_move_as_the_judge_finds_in_c",
        4,
        2_000,
    ),
    Family(
        "pulses",
        "codegen/runs/test_known_runs.py::test_pulses_a_ten_thousandth_of_the_run_wide_are_seen",
        6,
        200,
    ),
    Family("pulsed", "codegen/runs/test_pulsed.py::test_any_frequency", 6, 200),
    Family("pulsed-in-c", "codegen/runs/test_pulsed.py::test_any_frequency_in_c", 6, 200),
    Family("dips", "codegen/runs/test_dipping_guards.py", 12, 600),
    Family(
        "diodes",
        "codegen/switched/test_switched_networks.py::test_diodes_with_resistances",
        12,
        1_000,
    ),
    Family(
        "stiff-linear",
        "codegen/runs/test_stiff_linear.py::test_states_are_the_exponential",
        24,
        500,
    ),
    Family(
        "ideal-diodes", "codegen/switched/test_switched_networks.py::test_ideal_diodes", 12, 1_000
    ),
    Family("stops", "codegen/modes/test_bounce_random.py::test_random_stops", 8, 1_000),
    Family("stops-everywhere", "codegen/modes/test_bounce_routes.py", 1, 50),
    Family("exchanged", "codegen/modes/test_exchange.py", 6, 300),
    Family("converters", "codegen/modes/test_choices.py", 4, 300),
    Family(
        "mixed-ports",
        "codegen/switched/test_mixed_ports.py::test_random_networks",
        12,
        1_000,
        1,
    ),
    Family(
        "mixed-ports-in-c",
        "codegen/switched/test_mixed_ports.py::test_random_networks_in_c",
        3,
        1_000,
        1,
    ),
    # The judge of networks that switch.
    Family("judge-steps", "test_judge_switched_steps.py::test_random_networks", 3, 300),
    Family(
        "judge-modes", "test_judge_switched_steps.py::test_no_second_mode_is_consistent", 4, 300
    ),
    Family("large-circuits", "test_judge_switched_steps.py::test_named_circuits", 0, 1),
)
