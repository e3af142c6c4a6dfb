"""Entry points: a model file or its text becomes a `Model`."""

from __future__ import annotations

import hashlib
import os
from pathlib import PurePath

from linegraph.algebra.protocol import Floats
from linegraph.components.body import about_one_axis, impossible
from linegraph.components.body_mass import central_inertia
from linegraph.components.parameters import resolver, sample_values
from linegraph.components.scalar.branches import dangling, edges_of, projections
from linegraph.errors import ModelError
from linegraph.model.builder import SNAP, Model
from linegraph.readers.modelfile.building import build
from linegraph.readers.modelfile.document import parse_document, read_bytes
from linegraph.readers.modelfile.names import name_problem
from linegraph.readers.modelfile.report import ModelReport
from linegraph.readers.modelfile.tables import FLAT


def read(path: str | os.PathLike[str], *, snap: float = SNAP) -> Model:
    """Read a model file: TOML, or JSON if the name ends in ``.json``.

    Args:
        path: the file.
        snap: entries of rotation matrices this close to 0, 1 or 1/2 become these exactly.

    Returns:
        The model; warnings about impossible inertias and loose ends are in its `warnings`.

    Raises:
        SourceError: the file cannot be read, or is neither TOML nor JSON.
        SourceErrors: the content is wrong; contains all errors, each with its line.
    """
    return parse(read_bytes(path), os.fsdecode(path), snap=snap)


def parse(text: bytes, source: str, *, snap: float = SNAP) -> Model:
    """Read the text of a model file.

    Args:
        text: TOML or JSON, in UTF-8.
        source: name of the file, for messages; its stem names a model without name.
        snap: entries of rotation matrices this close to 0, 1 or 1/2 become these exactly.

    Returns:
        The model; warnings are in its `warnings`.

    Raises:
        SourceError: the text is neither TOML nor JSON.
        SourceErrors: the content is wrong; contains all errors, each with its line.

    Example:
        >>> model = parse(b'''
        ... [body.bob]
        ... mass = 2
        ... mass_center = [0, 0, -0.5]
        ... [revolute.hinge]
        ... between = ["ground", "bob"]
        ... axis = [0, 1, 0]
        ... ''', "pendulum.toml")
        >>> model.name, [joint.name for joint in model.joints]
        ('pendulum', ['hinge'])
    """
    document = parse_document(text, source)
    report = ModelReport(source, document.lines, FLAT)
    stem = PurePath(source).stem
    model = build(document, stem if not name_problem(stem, dots=True) else "model", report, snap)
    report.conclude()
    model.source = report.source
    model.warnings += [*_impossible(model), *_loose_ends(model)]
    told = f"Derived from a model file with SHA-256 {hashlib.sha256(text).hexdigest()}."
    about = model.about.rstrip()
    model.about = f"{about}{'' if about[-1] in '.!?' else '.'} {told}" if about else told
    return model


def _impossible(model: Model) -> list[str]:
    """Warnings about inertias that no mass distribution has, at the parameters' own values.

    Inertia about one axis alone is accepted: rotors and planar models need no more.
    """
    if any(p.value is None for p in model.parameters.values()):
        return []
    algebra = Floats()
    found = []
    try:
        resolve = resolver(algebra, sample_values(model.parameters.values(), algebra))
        for body in model.bodies.values():
            tensor = central_inertia(body, resolve)
            problem = "" if about_one_axis(tensor) else impossible(tensor)
            if problem:
                place = _place(model, f'body "{body.name}"')
                found.append(f'{place}: body "{body.name}": no body has this inertia: {problem}')
    except (ModelError, ArithmeticError):
        return []  # reported with its place when the model is derived
    return found


def _place(model: Model, thing: str) -> str:
    line = model.places.get(thing)
    return f"{model.source}{f':{line}' * (line is not None)}"


def _loose_ends(model: Model) -> list[str]:
    """Warnings about vertices with a single edge: mostly a misspelt name."""
    try:
        branches = edges_of(model.components)
        graphs = projections(branches)
    except ModelError:
        return []  # reported with its place when the model is derived
    owners = {branch.name: branch.component for branch in branches}
    found = []
    for graph in graphs:
        for vertex, edge in dangling(graph):
            component = owners[edge]
            place = _place(model, f'{component.kind} "{component.name}"')
            found.append(
                f'{place}: {component.kind} "{component.name}": nothing else is connected to its '
                f'{graph.domain} vertex "{vertex}", so nothing flows through it'
            )
    return found
