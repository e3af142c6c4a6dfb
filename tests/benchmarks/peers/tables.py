"""The figures as text: side by side for a terminal, and the table of the README."""

from __future__ import annotations

from typing import Any

Figures = dict[str, Any]

TITLES = {
    "equations": "M and h",
    "inverse_dynamics": "inverse dynamics",
    "forward_dynamics": "forward dynamics",
    "equations of many states": "M and h of 1024 states, for each",
}
COLUMNS = (
    # heading, key, format, scale
    ("ns", "ns", "{:.0f}", 1),
    ("lower", "ns_low", "{:.0f}", 1),
    ("upper", "ns_high", "{:.0f}", 1),
    ("ratio", "ratio", "{:.2f}", 1),
    ("million/s", "million", "{:.2f}", 1),
    ("instructions", "instructions", "{:.0f}", 1),
    ("operations", "operations", "{:.0f}", 1),
    ("C, KiB", "bytes", "{:.1f}", 1 / 1024),
    ("gcc, s", "compile_seconds", "{:.2f}", 1),
    ("differs", "difference", "{:.0e}", 1),
)
GENERATION = (
    ("process, s", "process", "{:.3f}", 1),
    ("inside, s", "inside", "{:.3f}", 1),
    ("MiB", "MiB", "{:.0f}", 1),
    ("C, KiB", "bytes", "{:.1f}", 1 / 1024),
    ("gcc, s", "compile_seconds", "{:.2f}", 1),
)
SHORT = (
    *COLUMNS,
    ("process, s", "generation_process", "{:.2f}", 1),
    ("inside, s", "generation_inside", "{:.2f}", 1),
    ("MiB", "generation_MiB", "{:.0f}", 1),
)
NOTES = """
ns: median CPU nanoseconds of a call over random states, all peers taken in turn, with its quartiles; ratio:
CasADi's (or the first row's) = 1. instructions: what valgrind sees executed in a call, without AVX-512.
operations: + - * / sin cos sqrt, signs free; what is not generated has none. C and gcc: the function alone,
CPU time of {flags}. differs: largest relative difference from linegraph, over random states.
CasADi: Pinocchio's algorithms over its symbols, in the convention (frames in the axes of the joints
or of the world) that takes fewer operations, `cse` on; M packed as its upper triangle, or dense.
linegraph writes M dense. MuJoCo: kinematics, comPos, comVel and makeM, rne, factorM, solveM as needed.
generation: from the URDF to C. Process: all of it; inside: without the start of interpreter and libraries.
The five functions are M, h, both, inverse and forward dynamics; everything has energies, reactions, ... too.
"""


def report(found: Figures) -> str:
    """Everything."""
    machine = found["machine"]
    lines = [f"{key}: {value}" for key, value in {"date": found["date"], **machine}.items()]
    for name, figures in found["robots"].items():
        for function, rows in figures["functions"].items():
            title = f"{name}, {figures['nv']} velocities, {figures['base']}: {TITLES[function]}"
            lines += ["", *table(title, with_ratios(rows), COLUMNS)]
        if "generation" in figures:
            lines += ["", *table(f"{name}: generation", figures["generation"], GENERATION)]
    for name, rows in found["short"].items():
        lines += ["", *table(f"{name}: M and h", with_ratios(rows), SHORT)]
    if counts := counted(found):
        lines += ["", *counts]
    return "\n".join((*lines, NOTES.format(flags=machine["flags"])))


def with_ratios(rows: dict[str, Figures]) -> dict[str, Figures]:
    """The rows with their times relative to CasADi, or to the first row; of batches, states a second."""
    unit = rows.get("CasADi", next(iter(rows.values())))["ns"]
    found = {peer: row | {"ratio": row["ns"] / unit} for peer, row in rows.items()}
    for row in found.values():
        if "states" in row:
            row["million"] = 1e3 / row["ns"]
    return found


def table(title: str, rows: dict[str, Figures], columns: tuple[Any, ...]) -> list[str]:
    """A title, a line of headings, and a line for each row; columns that nobody fills are left out."""
    used = [column for column in columns if any(column[1] in row for row in rows.values())]
    width = max(len(peer) for peer in (title, *rows))
    lines = [f"{title:{width}s}" + "".join(f"{heading:>13s}" for heading, *_ in used)]
    for peer, row in rows.items():
        cells = [
            form.format(scale * row[key]) if key in row else "-" for _, key, form, scale in used
        ]
        lines.append(f"{peer:{width}s}" + "".join(f"{cell:>13s}" for cell in cells))
    return lines


def counted(found: Figures) -> list[str]:
    """CasADi's operations in both conventions."""
    robots = {name: row["counts"] for name, row in found["robots"].items() if "counts" in row}
    if not robots:
        return []
    functions = list(next(iter(robots.values())))
    lines = [f"{'CasADi, operations':20s}" + "".join(f"{name:>18s}" for name in functions)]
    for name, counts in robots.items():
        for convention in ("local", "world"):
            cells = "".join(f"{counts[function][convention]:18d}" for function in functions)
            lines.append(f"{f'{name}, {convention}':20s}{cells}")
    return lines


def markdown(found: Figures) -> str:
    """The table of the README: M and h in one call, by robot."""
    peers = ("linegraph", "linegraph, --trig inline", "CasADi", "Pinocchio C++", "MuJoCo")
    titles = ("linegraph", "`--trig inline`", "CasADi", "Pinocchio C++", "MuJoCo")
    head = ["M and h, ns", *titles, "operations", "generating, s", "batch, ns"]
    lines = [_row(head), _row(["---"] * len(head))]
    for name, figures in found["robots"].items():
        rows = figures["functions"].get("equations", {})
        times = [_cell(rows, peer, "ns", "{:.0f}") for peer in peers]
        pair = ("linegraph", "CasADi")
        operations = " / ".join(_cell(rows, peer, "operations", "{:.0f}") for peer in pair)
        generation = figures.get("generation", {})
        seconds = " / ".join(
            _cell(generation, f"{peer}, M and h", "process", "{:.2f}") for peer in pair
        )
        many = figures["functions"].get("equations of many states", {})
        batch = _cell(many, "linegraph, in a batch", "ns", "{:.0f}")
        lines.append(_row([f"{name} ({figures['nv']})", *times, operations, seconds, batch]))
    return "\n".join(lines)


def _cell(rows: dict[str, Figures], peer: str, key: str, form: str) -> str:
    return form.format(rows[peer][key]) if key in rows.get(peer, {}) else "-"


def _row(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"
