"""C: ``NAME.h`` and ``NAME.c``."""

from __future__ import annotations

from codegen import options
from codegen.c import golden, source
from codegen.language import Language

LANGUAGE = Language(source.render, golden.render, options.NAMES)
