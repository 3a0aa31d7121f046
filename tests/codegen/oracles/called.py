"""Units called function by function."""

from pathlib import Path

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description

from oracles.units import Case


class Unit:
    """One unit, unpacked, of which instances can be made."""

    def __init__(self, case: Case, version: str, folder: Path, **more) -> None:
        self.case, self.version = case, version
        path = case.written(folder / version / "calls.fmu", version, **more)
        self.description = read_model_description(str(path))
        self.place = extract(str(path), str(folder / f"unpacked{version[0]}"))
        self.at = {one.name: one.valueReference for one in self.description.modelVariables}

    def started(self, kind: str, **start: float):
        """An instance after its initialization."""
        made = instantiate_fmu(self.place, self.description, fmi_type=kind)
        if self.version == "2.0":
            made.setupExperiment(startTime=0.0)
        self.put(made, **start)
        if self.version == "2.0":
            made.enterInitializationMode()
        else:
            made.enterInitializationMode(startTime=0.0)
        made.exitInitializationMode()
        if kind == "ModelExchange":
            if self.version == "2.0":
                made.newDiscreteStates()
            else:
                made.updateDiscreteStates()
            made.enterContinuousTimeMode()
        return made

    def put(self, made, **values: float) -> None:
        if values:
            put = made.setReal if self.version == "2.0" else made.setFloat64
            put([self.at[name] for name in values], list(values.values()))

    def get(self, made, *names: str) -> np.ndarray:
        get = made.getReal if self.version == "2.0" else made.getFloat64
        return np.array(get([self.at[name] for name in names]))

    def slopes(self, made, unknowns, knowns, seed) -> np.ndarray:
        refs = [self.at[n] for n in unknowns], [self.at[n] for n in knowns]
        return np.array(made.getDirectionalDerivative(*refs, list(seed)))

    def free(self, *made) -> None:
        for one in made:
            one.terminate()
            one.freeInstance()
