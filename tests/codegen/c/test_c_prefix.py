"""Two exported models in one program: no external symbol without its prefix, and no effect on results."""

import subprocess
from pathlib import Path

import pytest
from oracles.c_model import compiled, written
from oracles.exported import small_cases

import bondgraph as bg
from codegen import to_c

CASES = dict(small_cases())
MODELS = {"front_": "stacked", "rear_": "crank"}
"""Friction ports and straight-line rates, and coefficients that move."""

WRAPPER = """\
#include "{folder}/model_runtime.h"
#include <stdio.h>

int {folder}_run(void);

int {folder}_run(void)
{{
    static bg_model model;
    double states[BG_SIZE] = {{0}}, s[BG_SIZE], w[3 * BG_ROOM(BG_EXTERNAL)];
    for (int i = 0; i < 3 * BG_ROOM(BG_EXTERNAL); i++)
        w[i] = 2.0;
    if (bg_model_init(&model, NULL) || bg_model_vector(&model, 0.0, states, w, s))
        return 1;
    for (int k = 0; k < 50; k++)
        if (bg_model_step(&model, 0.01 * k, 0.01, s, w))
            return 1;
    for (int i = 0; i < BG_STATES + BG_LAW_STATES; i++)
        printf("%s %s %.17g\\n", bg_model_name, bg_state_names[i], s[i]);
    return 0;
}}
"""


def _export(folder: Path, prefix: str, case: str) -> str:
    """A model in a folder called like its prefix, and a file beside it that includes and runs it."""
    equations, values, laws = CASES[case]
    place = prefix.rstrip("_") or "plain"
    sources = written(folder / place, to_c(equations, values, laws, case, prefix=prefix))
    wrapper = folder / f"{place}.c"
    included = "".join(f'#include "{source}"\n' for source in sources)
    wrapper.write_text(included + WRAPPER.format(folder=place))
    return str(wrapper)


def _program(folder: Path, sources: list[str], places: list[str], to: str) -> list[str]:
    """What a program prints that runs these models in turn."""
    main = folder / f"main_{to}.c"
    heads = "".join(f"int {place}_run(void);\n" for place in places)
    calls = " || ".join(f"{place}_run()" for place in places)
    main.write_text(f"{heads}int main(void)\n{{\n    return {calls};\n}}\n")
    program = compiled(folder, [*sources, str(main)], "-O0", to=to)
    done = subprocess.run([program], capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


def test_two_models_in_one_program_run_as_each_does_alone(tmp_path: Path) -> None:
    sources, alone = [], []
    for prefix, case in MODELS.items():
        sources.append(_export(tmp_path, prefix, case))
        own = tmp_path / case
        own.mkdir()
        alone += _program(own, [_export(own, "", case)], ["plain"], "alone")
    together = _program(tmp_path, sources, ["front", "rear"], "together")
    assert together == alone
    assert len({line.split()[0] for line in together}) == 2


@pytest.mark.parametrize("case", ["stacked", "clutches_with_loss"])
def test_every_external_symbol_carries_the_prefix(case: str, tmp_path: Path) -> None:
    equations, values, laws = CASES[case]
    sources = written(tmp_path, to_c(equations, values, laws, prefix="front_"))
    library = compiled(tmp_path, sources, "-shared", "-fPIC", "-O0", to="model.so")
    listed = ["nm", "--extern-only", "--defined-only", "--format=posix", str(library)]
    found = subprocess.run(listed, capture_output=True, text=True, check=True).stdout
    names = {line.split()[0] for line in found.splitlines()} - {"_init", "_fini"}
    assert "front_bg_model_step" in names
    assert [name for name in sorted(names) if not name.startswith("front_bg_")] == []


def test_without_a_prefix_nothing_is_renamed() -> None:
    equations, values, laws = CASES["stacked"]
    plain = to_c(equations, values, laws)
    named = to_c(equations, values, laws, prefix="front_")
    assert "front_" not in "".join(plain.values())
    assert [name for name in plain if plain[name] != named[name]] == ["config.h", "model.c"]


@pytest.mark.parametrize("prefix", ["2nd", "a b", "front-", "τ_", "_front", "__", "int", 3])
def test_a_prefix_that_begins_no_name_in_c_is_refused(prefix: object) -> None:
    equations, values, laws = CASES["stacked"]
    with pytest.raises(bg.ParameterError, match=r"prefix .* take one such as 'front_'"):
        to_c(equations, values, laws, prefix=prefix)  # type: ignore[arg-type]
