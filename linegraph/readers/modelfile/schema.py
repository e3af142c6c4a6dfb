"""JSON Schema of model files, for completion and checks in editors.

It is generated from the tables that the reader uses. ``linegraph schema`` prints it; the copy shipped with
the package is next to this file.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from linegraph.readers.modelfile.expressions import Scope
from linegraph.readers.modelfile.kinds import Real
from linegraph.readers.modelfile.tables import FLAT, HEAD, INPUT, OUTPUT, PARAMETER, TYPES

PATH = Path(__file__).with_name("schema.json")
DRAFT = "http://json-schema.org/draft-07/schema#"
"""The newest draft that TOML editors understand."""


def schema() -> dict[str, Any]:
    """The JSON Schema of a model file."""
    properties: dict[str, Any] = {
        key: {"description": entry.about, **entry.kind.schema()} for key, entry in HEAD.items()
    }
    parameter = {"anyOf": [*Real().schema()["anyOf"], PARAMETER.schema()]}
    properties["parameters"] = _named(parameter, "numbers that stay symbols")
    output = {"anyOf": [*Real(Scope.OUTPUT).schema()["anyOf"], OUTPUT.schema()]}
    properties["outputs"] = _named(output, "what the emitted code returns by name")
    properties["inputs"] = _named(INPUT.schema(), "numbers known at run time")
    properties |= {key: table.schema() for key, table in FLAT.items() if table is not None}
    properties |= {key: _named(table.schema(), table.about) for key, table in TYPES.items()}
    return {
        "$schema": DRAFT,
        "title": "linegraph model",
        "type": "object",
        "properties": properties,
        "additionalProperties": False,
    }


def _named(inner: dict[str, Any], about: str) -> dict[str, Any]:
    table = {"type": "object", "additionalProperties": inner}
    return {"description": about, **table} if about else table


def text() -> str:
    """The schema as text, as shipped."""
    return json.dumps(schema(), indent=1) + "\n"
