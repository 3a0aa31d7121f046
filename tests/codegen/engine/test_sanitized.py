"""Compiled engines under sanitizers: tests of theirs in one process that the sanitizers are loaded in."""

import pytest
from oracles.sanitized import check_clean

SANITIZED = """
import test_batch_energy as energy
import test_batch_located as many_located
import test_batch_ports as many
import test_c_backend as exact
import test_located as located
import test_pulsed as pulsed
from codegen.batch.engine import batch_engine
from codegen.engine.located import LocatedLibrary
from codegen.engine.runs import CRuns
from oracles.sanitized import sanitized

with sanitized(batch_engine):
    many.test_blocks_on_top_of_each_other(31)
    many.test_times_at_any_distance()
    many.test_runs_whose_parameters_do_not_change()
with sanitized(CRuns.__init__):
    exact.test_an_oscillator_on_a_belt_through_all_kinds_of_inputs()
    exact.test_blocks_on_top_of_each_other(641)
    exact.test_steps_much_longer_than_time_constants_are_divided()
    exact.test_random_chains_with_random_inputs_at_ragged_times(1)
    exact.test_a_level_below_zero_has_its_status_and_its_time()
    exact.test_models_without_friction_run()
with sanitized(LocatedLibrary.__init__, batch_engine):
    energy.test_friction_that_sticks_is_worked_out_by_hand()
    energy.test_a_stretch_of_many_time_constants()
    many_located.test_inputs_held_beside_others_that_change()
    many_located.test_models_of_every_kind("clutches")
    many_located.test_values_that_change_are_checked_run_by_run()
    for name in ("mixed", "braked_crank"):
        located.test_two_methods_agree_on_models_of_every_kind(name)
    located.test_room_for_events_grows()
    pulsed.test_integrators_pass_every_instant("DOP853")
"""


@pytest.mark.slow
def test_engines_and_loops_are_clean_under_sanitizers() -> None:
    check_clean(SANITIZED)


UNDEFINED = """
import ctypes, subprocess, tempfile
from oracles.sanitized import FLAGS
with tempfile.TemporaryDirectory() as folder:
    call = ["gcc", *FLAGS, "-shared", "-fPIC", "-o", folder + "/more.so", "-x", "c", "-"]
    subprocess.run(call, input="int more(int a) { return a + 2147483647; }", text=True, check=True)
    ctypes.CDLL(folder + "/more.so").more(5)
"""


def test_what_a_sanitizer_finds_is_told() -> None:
    with pytest.raises(AssertionError, match=r"signed integer overflow: 5 \+ 2147483647"):
        check_clean(UNDEFINED)
