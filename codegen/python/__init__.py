"""Python: ``NAME.py``."""

from __future__ import annotations

from codegen.language import Language
from codegen.python import golden, module

LANGUAGE = Language(module.render, golden.render)
