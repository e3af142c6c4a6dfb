"""Every model of this project by name, in all coordinates, and all that can be asked of one.

What is asked is what the commands do: `derive`, `graph`, `trees`, `check` and `emit` with every function.
"""

from __future__ import annotations

import functools
import random
import re
import types
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from oracles import pinocchio_models
from support import targets
from support.modelfile_text import LOOP, SMALL, ZOO

import codegen
from linegraph import LinegraphError, ModelError, derive, report
from linegraph.drawing.files import picture
from linegraph.emission.emit import CONVENTIONS
from linegraph.ir.program import Routine
from linegraph.numeric.assembly import consistent
from linegraph.programs.frame_names import named_frames
from linegraph.programs.register import OF_FRAMES, PROGRAMS, module_of
from linegraph.programs.request import Request
from linegraph.programs.tree_costs import trees
from linegraph.readers import modelfile, urdf
from linegraph.readers.modelfile.starter import starter
from linegraph.verification import checking

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from linegraph import Model
    from linegraph.derivation import Derivation
    from linegraph.ir.program import Module, Program, Quantity
    from linegraph.model.bounds import Interval

    Maker = Callable[[], Model]

ROOT = Path(__file__).parents[2]
DOCUMENTS = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
COORDINATES = ("joint", "absolute", "absolute-angle")
STATES = 3


def documented() -> dict[str, Maker]:
    """The models that documents show as blocks of TOML: those that are whole by themselves."""
    found = {}
    for path in DOCUMENTS:
        blocks = re.findall(r"^```toml\n(.*?)^```", path.read_text("utf-8"), re.M | re.S)
        for k, block in enumerate(blocks):
            try:
                modelfile.parse(block.encode(), "block.toml")
            except LinegraphError:
                continue  # a piece that shows one table
            found[f"{path.stem}_{k}"] = _text(block)
    return found


def _text(text: str) -> Maker:
    return lambda: modelfile.parse(text.encode(), "model.toml")


def _floating(path: Path) -> dict[str, Maker]:
    """A URDF with its root link welded, and floating."""
    name = f"{path.parent.name}_{path.stem}"
    return {
        name: lambda: urdf.read(path),
        f"{name}_floating": lambda: urdf.read(path, base="floating"),
    }


def robots() -> dict[str, Maker]:
    """Every robot of the example-robot-data wheel; none where it is not installed."""
    found: dict[str, Maker] = {}
    for path in pinocchio_models.urdf_files():
        found |= _floating(path)
    return found


def every_model() -> dict[str, Maker]:
    """Every model of examples, documents and tests."""
    own = {
        "small": _text(SMALL),
        "zoo": _text(ZOO),
        "loop": _text(LOOP),
        "new": _text(starter("new")),
    }
    whole = targets.everything()
    return {k: v for k, v in whole.items() if not k.endswith(targets.MORE)} | documented() | own


def derived(make: Maker, coordinates: str) -> Derivation:
    """A model in some coordinates; `joint` leaves the choice of the model as it is."""
    model = make()
    if coordinates != COORDINATES[0]:
        model.formulation(independent=None, coordinates=coordinates)
    return derive(model)


# ---- what is asked


def reported(derivation: Derivation, format: str) -> None:
    """`derive` in one format; closed forms as they are derived where they are long."""
    level = "fast" if len(derivation.structure.velocities) < 6 else "none"
    text = report.report(derivation, format, level=level)
    assert text.strip()
    infinite = "nan|inf" if derivation.system.name == "zoo" else "nan|inf|zoo"
    found = re.search(rf"(?<![\w.])({infinite})(?![\w.])", text)
    assert not found, f"{found} is no number"


def drawn(derivation: Derivation) -> None:
    """`graph` as SVG and as DOT, the mechanism too."""
    text = picture(derivation, "x.dot")
    assert isinstance(text, str)
    assert text.startswith(("graph", "digraph"))
    for what in ("graph", "both"):
        svg = picture(derivation, "x.svg", what=what)
        assert isinstance(svg, str)
        attributes = re.sub(r">[^<]*<", "><", svg)
        assert not re.search(r'"[^"]*\b(nan|inf)\b[^"]*"', attributes)


def shown(derivation: Derivation) -> None:
    """`show`."""
    assert report.show(derivation).startswith("model ")


def planted(derivation: Derivation) -> None:
    """`trees`."""
    assert str(trees(derivation.system))


def checked(derivation: Derivation) -> None:
    """`check`: differences are rounding."""
    findings = checking.check(derivation)
    assert findings.good, findings


def functions_of(derivation: Derivation) -> Module:
    """The program with every function that the model has."""
    frames = named_frames(derivation.system, list(derivation.system.bodies)[-1:])
    able = []
    for key in PROGRAMS:
        own = frames if key in (*OF_FRAMES, "kinematics") else ()
        if key in OF_FRAMES and not own:
            continue
        try:
            module_of(derivation, "m", Request(only=(key,), frames=own))
        except ModelError:
            continue  # the model has none of the kind, M is singular, or a frame cannot move so
        able.append(key)
    assert able
    return module_of(derivation, "m", Request(only=able, frames=frames), CONVENTIONS)


def emitted(derivation: Derivation) -> None:
    """`emit` with every function, in every language, and what the emitted Python returns."""
    module = functions_of(derivation)
    files = {}
    for language in codegen.LANGUAGES:
        files = codegen.render(module, language)
        for text in files.values():
            found = re.search(r"(?<![\w.\"])-?(nan|inf|zoo|NAN|INFINITY)(?![\w.(\"])", _code(text))
            assert not found, f"{found} is no number"
        if language == "python":
            evaluated(derivation, module, _loaded(files["m.py"]))


def _loaded(source: str) -> Any:
    """Emitted Python as a module, without a file."""
    module = types.ModuleType("m")
    exec(compile(source, "m.py", "exec"), module.__dict__)
    return module


def _code(text: str) -> str:
    """Emitted text less its comments and docstrings."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    return re.sub(r'""".*?"""', "", text, flags=re.S)


def evaluated(derivation: Derivation, module: Module, found: Any) -> None:
    """Every function at a few states: finite numbers, or an exception that its documentation names."""
    answered = set()
    for seed in range(STATES):
        for program, values in _calls(derivation, module, found, seed):
            try:
                with np.errstate(all="ignore"):
                    got = getattr(found, program.name)(*values)
            except (ArithmeticError, np.linalg.LinAlgError):
                continue
            results = got if isinstance(got, tuple) else (got,)
            for result, value in zip(program.results, results, strict=True):
                assert np.isfinite(value).all(), f"{program.name}: {result.name} = {value}"
            answered.add(program.name)
    silent = {p.name for p in module.programs} - answered
    # a rolling wheel's centre, say, has no freedom along its axis: with loops no state tells otherwise
    silent = {name for name in silent if "_operational_" not in name}
    assert not silent, f"nowhere a number: {sorted(silent)}"


def _calls(
    derivation: Derivation, module: Module, found: Any, seed: int
) -> Iterator[tuple[Program | Routine, list[Any]]]:
    """Every function with arguments at a drawn state, which satisfies the constraints."""
    draw = random.Random(seed)
    bounds = derivation.system.bounds
    time = draw.uniform(*(bounds.t or (0, 1)))
    reach = 0.5 if derivation.structure.network is None else 0.1

    def some(quantities: Iterable[Quantity], within: Mapping[str, Interval], most: float) -> Any:
        return [draw.uniform(*within.get(x.name, (-most, most))) for x in quantities]

    inputs = some(module.inputs, bounds.inputs, reach)
    numeric = derivation.numeric(t=time, u=inputs)
    tree = numeric.tree
    if tree.closed:
        q, v = consistent(derivation, derivation.assembled.q, numeric, draw)
    else:
        q = some(tree.positions, bounds.coordinates, 0.7)
        tree.normalise(q)
        v = some(tree.velocities, bounds.velocities, reach)
    values = {"t": time, "q": q, "v": v, "u": inputs, "x": [*q, *v]}
    values["p"] = getattr(found, "DEFAULT_PARAMETERS", None)
    if hasattr(found, "prepare"):
        values["c"] = found.prepare(values["p"])
    for program in module.programs:
        if isinstance(program, Routine):
            at = dict(program.details)
            values["s"] = [q[k] for k in at.get("s_at", ())]
            values["w"] = [v[k] for k in at.get("w_at", ())]
        for argument in program.arguments:
            if argument.name not in values:
                size = argument.size or 0
                values[argument.name] = [draw.uniform(-reach, reach) for _ in range(size)]
        yield program, [values[argument.name] for argument in program.arguments]


QUESTIONS: dict[str, Callable[[Derivation], None]] = {
    "show": shown,
    "graph": drawn,
    "trees": planted,
    "check": checked,
    "emit": emitted,
    **{f"derive {name}": functools.partial(reported, format=name) for name in report.FORMATS},
}
"""What each command does with a model."""
