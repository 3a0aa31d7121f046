"""What a run of the tests took, printed before its last line: minutes, and programs compiled."""

import os
import resource
import time
from typing import Any

import pytest

from rig.compilers import counted
from rig.used import used


def pytest_configure(config: pytest.Config) -> None:
    """One in each process; those that only run tests tell the first."""
    config.pluginmanager.register(Summary(), "summary")


class Summary:
    """Seconds since the run began, and of processors in all processes."""

    def __init__(self) -> None:
        self.began = time.monotonic()
        self.elsewhere = 0.0

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Tell the first process what this one and those that it started have used."""
        told = getattr(session.config, "workeroutput", None)
        if told is not None:
            told["seconds"] = used(resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any) -> None:
        """Take what a process tells."""
        self.elsewhere += getattr(node, "workeroutput", {}).get("seconds", 0.0)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Print it; pytest's own line comes after."""
        # Children of this process are those that have told already, if there are any.
        own = used(resource.RUSAGE_SELF)
        whole = own + (self.elsewhere or used(resource.RUSAGE_CHILDREN))
        lasted, programs = time.monotonic() - self.began, counted()
        terminalreporter.write_line(
            f"{lasted / 60:.1f} minutes, {whole / 60:.1f} of a processor ({os.cpu_count()} here); "
            f"C programs: {programs['compiled']} compiled, {programs['shared']} shared, "
            f"{programs['apart']} in parts"
        )
