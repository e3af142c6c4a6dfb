"""Docstrings have more than three words, and those of functions with two or more arguments list them.

The rule is about length and sections only; whether a docstring is good has to be judged by reading it.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from house.rooms import ROOT, files, parsed, room
from house.test_house import of_click, parameters

from linegraph.ir.reading import ALGORITHMS, WHERE, algorithm

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

FEWEST_WORDS = 4
FEWEST_ARGUMENTS = 2


class Public(NamedTuple):
    """A public class, function or method with a docstring.

    Attributes:
        name: dotted, with its module.
        within: the class that it is a method of; "" for others.
        node: its syntax tree.
    """

    name: str
    within: str
    node: ast.ClassDef | ast.FunctionDef

    @property
    def doc(self) -> str:
        return ast.get_docstring(self.node) or ""


def public(tree: ast.AST, prefix: str, within: str = "") -> Iterator[Public]:
    """All that is public below a node, in order."""
    for child in ast.iter_child_nodes(tree):
        if not isinstance(child, ast.ClassDef | ast.FunctionDef) or child.name.startswith("_"):
            continue
        if ast.get_docstring(child) is not None:
            yield Public(f"{prefix}.{child.name}", within, child)
        if isinstance(child, ast.ClassDef):
            yield from public(child, f"{prefix}.{child.name}", child.name)


@cache
def everything() -> tuple[Public, ...]:
    return tuple(found for name, path in files().items() for found in public(parsed(path), name))


def bases(trees: Iterable[ast.AST]) -> dict[str, list[str]]:
    """The names of the bases of every class. No two classes have one name."""
    return {
        node.name: [ast.unparse(base).partition("[")[0].split(".")[-1] for base in node.bases]
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
    }


def above(name: str, known: dict[str, list[str]]) -> Iterator[str]:
    """The classes from which a class inherits, directly or not."""
    for base in known.get(name, ()):
        yield base
        yield from above(base, known)


def terse(found: Iterable[Public]) -> list[str]:
    """Those whose docstring has three words or fewer."""
    return [x.name for x in found if len(x.doc.split()) < FEWEST_WORDS]


@cache
def emitted() -> frozenset[str]:
    """The functions of algorithms: their whole docstrings become comments of emitted code."""
    return frozenset(
        f"{WHERE}.{made.name}" for name in ALGORITHMS for made in algorithm(name).values()
    )


def is_emitted(x: Public) -> bool:
    """Whether a docstring becomes a comment of emitted code, which may lack some of the arguments."""
    module, _, name = x.name.rpartition(".")
    package, _, _ = module.rpartition(".")
    return not x.within and f"{package}.{name}" in emitted()


def without_args(found: Iterable[Public], known: dict[str, list[str]]) -> list[str]:
    """Functions of two or more arguments whose docstring has no `Args`.

    A method that overrides one with `Args` need not repeat them, and the options of a command have help
    texts. The docstrings of algorithms are printed in emitted code, so they are exempt.
    """
    everyone = list(found)
    described = {(x.within, x.node.name) for x in everyone if x.within and "Args:" in x.doc.split()}
    return [
        x.name
        for x in everyone
        if isinstance(x.node, ast.FunctionDef)
        and parameters(x.node) >= FEWEST_ARGUMENTS
        and "Args:" not in x.doc.split()
        and not of_click(x.node)
        and not is_emitted(x)
        and not any((base, x.node.name) in described for base in above(x.within, known))
    ]


def undescribed_constructors(found: Iterable[Public]) -> list[str]:
    """Classes whose constructor takes two or more arguments that neither docstring describes."""
    names = []
    for x in found:
        for made in x.node.body if isinstance(x.node, ast.ClassDef) else ():
            if isinstance(made, ast.FunctionDef) and made.name == "__init__":
                words = f"{x.doc} {ast.get_docstring(made)}".split()
                if parameters(made) >= FEWEST_ARGUMENTS and not {"Args:", "Attributes:"} & {*words}:
                    names.append(x.name)
    return names


def offenders() -> dict[str, list[str]]:
    """By package, the public names whose docstrings break a rule."""
    known = bases(parsed(path) for path in files().values())
    sorted_by_room: dict[str, list[str]] = {}
    found = everything()
    for name in (
        *terse(found),
        *without_args(found, known),
        *undescribed_constructors(found),
    ):
        module = next(m for m in sorted(files(), key=len, reverse=True) if name.startswith(f"{m}."))
        sorted_by_room.setdefault(room(module), []).append(name)
    return sorted_by_room


def test_docstrings_say_more_than_the_name_and_list_arguments() -> None:
    assert offenders() == {}


CITED = re.compile(r"\[([^\[\]]*\b(?:19|20)\d\d\b[^\[\]]*)\]")
LISTED = re.compile(r"^\*\*\[(.+)\]\*\*", re.MULTILINE)


def citations(text: str) -> Iterator[str]:
    """Authors and year of all that a docstring cites, as ``[Author 1990, sec. 2; Other 2000]``."""
    for cited in CITED.findall(" ".join(text.split())):
        yield from (work.partition(",")[0].strip() for work in cited.split(";"))


def docstrings() -> Iterator[tuple[str, str]]:
    """Every docstring with its module, those of private things, too."""
    documented = ast.Module | ast.ClassDef | ast.FunctionDef
    for name, path in files().items():
        for node in ast.walk(parsed(path)):
            if isinstance(node, documented):
                yield name, ast.get_docstring(node) or ""


def test_works_that_docstrings_cite_are_listed() -> None:
    listed = set(LISTED.findall((ROOT / "docs" / "references.md").read_text(encoding="utf-8")))
    cited = {(name, work) for name, text in docstrings() for work in citations(text)}
    assert {work for _, work in cited}
    assert {(name, work) for name, work in cited if work not in listed} == set()


def test_the_search_for_citations_finds_them() -> None:
    text = "As there [Featherstone 2008,\n sec. 7.3; Kruskal 1956]."
    assert list(citations(text)) == ["Featherstone 2008", "Kruskal 1956"]


SAMPLE = '''
class Base:
    """A base of other classes."""
    def carried(self, a, b):
        """Carried along by a.

        Args:
            a: one.
            b: another.
        """

class Derived(Base):
    """One derived from it."""
    def carried(self, a, b):
        """The same, but faster."""
    def bare(self, a, b):
        """It has no such section."""
    def single(self, a):
        """It takes one argument."""
    def _private(self, a, b):
        """Hidden."""

def short(a):
    """The sum."""

class Made:
    """Made of two arguments."""
    def __init__(self, a, b):
        """Keep them both here."""

class Described:
    """Made of two arguments.

    Attributes:
        a: one.
        b: another.
    """
    def __init__(self, a, b):
        """Keep them both here."""
'''


def test_the_search_for_terse_docstrings_and_missing_arguments_finds_them() -> None:
    tree = ast.parse(SAMPLE)
    found = list(public(tree, "m"))
    assert terse(found) == ["m.short"]
    assert without_args(found, bases([tree])) == ["m.Derived.bare"]
    assert undescribed_constructors(found) == ["m.Made"]


def test_only_docstrings_that_are_printed_in_emitted_code_are_exempt() -> None:
    exempt = {x.name for x in everything() if is_emitted(x)}
    assert f"{WHERE}.newton.newton" in exempt
    assert f"{WHERE}.sizes.largest_of" in exempt
    assert f"{WHERE}.language.ratio" not in exempt
    assert all(x.startswith(f"{WHERE}.") for x in exempt)
