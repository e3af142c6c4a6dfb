"""Mutants of emitted C: one sign, constant, index or operand of one statement is wrong.

All mutants of a file are compiled at once: each statement chosen becomes ``mutant == K ? wrong : right``, and
the environment says which one is meant. So a thousand mutants cost one compilation for each model.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import random
    from collections.abc import Iterator, Sequence
    from pathlib import Path

KINDS = ("sign", "constant", "index", "operand")

_STATEMENT = re.compile(
    r"^( +(?:const )?(?:double |real |float )?[A-Za-z_][\w\[\]>. *+()-]*? [-+*/]?= )(.+);$"
)
_NOT = re.compile(
    r"\bint\b|\benum\b|\{|\}|\bfor\b|\bswitch\b|\?|==|\bstatus\b|\bstruct\b|SOLVED|_OK\b|not_finite\(|\""
)
_WHOLE = re.compile(r"^(?:-?0(?:\.0)?|[i-n]|&.*)$")
"""What is assigned that is no number: nothing, indices and pointers."""

_OPENED = re.compile(r"^(?:static |[A-Z_0-9]+ )*(?:void|int|double|float)\b.*?\b(\w+)\(")

SIGN = re.compile(r"(?<= )[-+](?= )")
CONSTANT = re.compile(r"(?<![\w.\[])\d+\.\d*(?:e[-+]?\d+)?(?![\w.\]])")
INDEX = re.compile(r"(?<=\[)\d+(?=\])")
OPERAND = re.compile(r"\bt\d+\b")

HEAD = "int lg_mutant;\n"
TAIL = """
#include <stdlib.h>
#undef main
int golden_main(void);
int main(void)
{
    const char *text = getenv("MUTANT");
    lg_mutant = text ? atoi(text) : 0;
    return golden_main();
}
"""
"""The program of golden vectors, its ``main`` renamed, with the mutant that the environment names."""

COMPILER = ("tcc", "-w") if shutil.which("tcc") else ("gcc", "-std=gnu99", "-O0", "-w")
"""The fastest that there is: each program is run but once for each mutant."""


@dataclass(frozen=True)
class Mutant:
    """One wrong statement.

    Attributes:
        line: which line of the file.
        function: in which function.
        kind: one of `KINDS`.
        right, wrong: the expression assigned.
    """

    line: int
    function: str
    kind: str
    right: str
    wrong: str


def mutants(text: str, draw: random.Random, count: int) -> list[Mutant]:
    """Some mutants of a file: function after function in some order, of all kinds in turn."""
    by_function: dict[str, list[tuple[int, str, str, list[str]]]] = {}
    for found in _statements(text):
        by_function.setdefault(found[1], []).append(found)
    functions = list(by_function)
    draw.shuffle(functions)
    for statements in by_function.values():
        draw.shuffle(statements)
    chosen: list[Mutant] = []
    used: set[tuple[int, str]] = set()
    turn = draw.randrange(len(KINDS))
    while functions and len(chosen) < count:
        for function in tuple(functions):
            made = _next(by_function[function], turn, used, draw)
            if made is None:
                functions.remove(function)
                continue
            chosen.append(made)
            turn += 1
            if len(chosen) == count:
                break
    return chosen


def _next(
    statements: Sequence[tuple[int, str, str, list[str]]],
    turn: int,
    used: set[tuple[int, str]],
    draw: random.Random,
) -> Mutant | None:
    """A mutant of some statements, of the kind whose turn it is if there is one; None if all are used."""
    for k in range(len(KINDS)):
        kind = KINDS[(turn + k) % len(KINDS)]
        for line, function, right, names in statements:
            if (line, kind) in used:
                continue
            used.add((line, kind))
            wrong = _wrong(kind, right, names, draw)
            if wrong is not None and wrong != right:
                return Mutant(line, function, kind, right, wrong)
    return None


def _statements(text: str) -> Iterator[tuple[int, str, str, list[str]]]:
    """Assignments to numbers: line, function, what is assigned, and the names that are known before."""
    function, names = "", []
    for number, line in enumerate(text.split("\n")):
        if line.startswith("}"):
            function, names = "", []
        opened = _OPENED.match(line)
        if opened:
            function, names = opened[1], []
        found = _STATEMENT.match(line)
        if found is None or not function or _NOT.search(line) or _WHOLE.match(found[2]):
            continue
        yield number, function, found[2], list(names)
        made = re.match(r" +const double (t\d+) = ", line)
        if made:
            names.append(made[1])


def _wrong(kind: str, right: str, names: Sequence[str], draw: random.Random) -> str | None:
    """An expression with one thing wrong; None where it has nothing of the kind."""
    plain = _masked(right)
    if kind == "sign":
        places = list(SIGN.finditer(plain))
        if not places:
            return f"-({right})"
        place = draw.choice(places)
        return right[: place.start()] + "-+"[place[0] == "-"] + right[place.end() :]
    if kind == "constant":
        places = list(CONSTANT.finditer(plain))
        if not places:
            return None
        place = draw.choice(places)
        return f"{right[: place.start()]}(1.00001 * {place[0]}){right[place.end() :]}"
    if kind == "index":
        places = [x for x in INDEX.finditer(right) if int(x[0]) > 0]
        if not places:
            return None
        place = draw.choice(places)
        return f"{right[: place.start()]}{int(place[0]) - 1}{right[place.end() :]}"
    places = list(OPERAND.finditer(plain))
    others = [name for name in names if name not in {x[0] for x in places}]
    if not places or not others:
        return None
    place = draw.choice(places)
    return right[: place.start()] + draw.choice(others) + right[place.end() :]


def _masked(text: str) -> str:
    """An expression with the insides of all brackets blotted out."""
    depth, found = 0, []
    for letter in text:
        depth -= letter == "]"
        found.append("_" if depth else letter)
        depth += letter == "["
    return "".join(found)


def callers(text: str, function: str) -> set[str]:
    """A function of a file and all that call it, by way of others too."""
    bodies: dict[str, str] = {}
    name = ""
    for line in text.split("\n"):
        opened = _OPENED.match(line)
        if opened and not line.endswith(";"):
            name = opened[1]
        bodies[name] = bodies.get(name, "") + line + "\n"
    found, new = {function}, {function}
    while new:
        pattern = re.compile(r"\b(?:" + "|".join(sorted(new)) + r")\(")
        new = {name for name, body in bodies.items() if pattern.search(body)} - found
        found |= new
    return found


def schemata(text: str, chosen: Sequence[Mutant]) -> str:
    """The file with all mutants in it; none of them is on unless the environment says so."""
    lines = text.split("\n")
    for number, mutant in enumerate(chosen, 1):
        head, _, _ = lines[mutant.line].partition("= ")
        known = lines[mutant.line][len(head) + 2 : -1]
        lines[mutant.line] = f"{head}= (lg_mutant == {number}) ? ({mutant.wrong}) : ({known});"
    return HEAD + "\n".join(lines)


def build(files: dict[str, str], name: str, chosen: Sequence[Mutant], folder: Path) -> Path:
    """Compile golden vectors with all mutants."""
    folder.mkdir(parents=True, exist_ok=True)
    for file, text in files.items():
        (folder / file).write_text(text, encoding="ascii", newline="\n")
    mutated = schemata(files[f"{name}.c"], chosen) + TAIL
    (folder / f"{name}.c").write_text(mutated, encoding="ascii")
    program = folder / "check"
    command = [
        *COMPILER,
        "-Dmain=golden_main",
        f"{name}_test.c",
        f"{name}.c",
        "-lm",
        "-o",
        str(program),
    ]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[:2000]
    return program


def run(program: Path, number: int) -> tuple[bool, str]:
    """Whether golden vectors hold with a mutant, 0 for none, and what they print."""
    environment = {**os.environ, "MUTANT": str(number)}
    try:
        done = subprocess.run(
            [str(program)], env=environment, capture_output=True, text=True, check=False, timeout=60
        )
    except subprocess.TimeoutExpired:
        return False, "does not end"
    return done.returncode == 0, done.stdout
