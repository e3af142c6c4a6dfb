"""SymPy's mechanics on short planar chains: what deriving the same M and h costs there."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING

from calls import Call, compile_seconds, compiled, folder, spent
from environment import HERE

if TYPE_CHECKING:
    from linegraph_peer import Emitted

METHODS = ("kane", "lagrange")


def calls(emitted: Emitted, n: int, runs: int) -> list[Call]:
    """Kane's and Lagrange's method for a planar chain, what they cost among the figures."""
    found = []
    for method in METHODS:
        source = folder("sympy", f"{method}{n}") / "equations.c"
        script = [sys.executable, str(HERE / "sympy_derivation.py"), method, str(n), str(source)]
        cpu, memory, printed = spent(script)
        report = json.loads(printed)
        library, counted = compiled("equations", [source], source.parent)
        call = Call(f"SymPy, {method.title()}", "equations", library, counted, emitted.layout)
        call.figures |= {
            "operations": report["operations"],
            "bytes": source.stat().st_size,
            "compile_seconds": compile_seconds(source, runs),
            "generation_process": cpu,
            "generation_inside": report["seconds"],
            "generation_MiB": memory,
        }
        found.append(call)
    return found
