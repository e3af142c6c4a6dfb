"""``emit --only``: the functions that are asked for, those that they call, and no other."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from click.testing import CliRunner
from support.compiled import Compiled
from support.emitted import load

from linegraph import ModelError, derive
from linegraph.cli.main import main
from linegraph.cli.options import FUNCTIONS
from linegraph.emission.emit import module_for, render
from linegraph.programs.register import PROGRAMS
from linegraph.programs.workspace import Workspace
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from pathlib import Path

PENDULUM = "examples/double_pendulum/double_pendulum.toml"
LOOP = "examples/four_bar/four_bar.toml"


def test_the_command_line_knows_all_functions() -> None:
    assert set(FUNCTIONS) == set(PROGRAMS) - {"algebraic_loop"}


@pytest.mark.one_in(3)
@pytest.mark.parametrize("function", FUNCTIONS)
@pytest.mark.parametrize("file", [PENDULUM, LOOP])
def test_each_alone_is_a_module(file: str, function: str, tmp_path: Path) -> None:
    """What a function calls is there, so that both languages load it; twins included."""
    model = modelfile.read(file)
    try:
        made = PROGRAMS[function](Workspace(derive(model), folded=False))
    except ModelError as refusal:
        with pytest.raises(ModelError, match=re.escape(str(refusal))):
            render(model, name="one", only=[function])
        return
    if not made:
        with pytest.raises(ModelError, match="nothing of the kind"):
            render(model, name="one", only=[function])
        return
    files = render(model, name="one", only=[function])
    module = load(files, "one", tmp_path)
    Compiled(files, "one", tmp_path)
    assert all(callable(getattr(module, program.name)) for program in made)


def test_numbers_are_those_of_the_whole(tmp_path: Path) -> None:
    model = modelfile.read(PENDULUM)
    whole = load(render(model, name="whole"), "whole", tmp_path)
    few = load(render(model, name="few", only=["equations"]), "few", tmp_path)
    q, v = np.array([0.3, -0.4]), np.array([0.5, 0.6])
    for found, expected in zip(
        few.equations(few.DEFAULT_PARAMETERS, q, v),
        whole.equations(whole.DEFAULT_PARAMETERS, q, v),
        strict=True,
    ):
        assert np.array_equal(found, expected)
    names = {name for name in vars(few) if name in FUNCTIONS}
    assert names == {"equations"}


def test_what_does_not_exist_is_refused(tmp_path: Path) -> None:
    run = CliRunner().invoke
    done = run(main, ["emit", PENDULUM, "--out", str(tmp_path), "--only", "project"])
    assert done.exit_code == 2
    assert 'function "project"' in done.output
    done = run(main, ["emit", PENDULUM, "--out", str(tmp_path), "--only", "equation"])
    assert done.exit_code == 2
    assert not list(tmp_path.iterdir())
    with pytest.raises(ModelError, match="is not one of"):
        module_for(modelfile.read(PENDULUM), "m", only=["equation"])
