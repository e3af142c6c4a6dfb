"""The look of a model's names: Greek letters, subscripts, dots and words."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from linegraph.notation.tree import (
    COORDINATE,
    GRAVITY,
    INPUT,
    LENGTH,
    MASS,
    OTHER,
    RATE,
    Name,
)
from linegraph.notation.writing import SUBSCRIPTS

if TYPE_CHECKING:
    from linegraph.model.system import System
    from linegraph.numeric.derived import Derived

_LETTER_NAMES = (
    *("alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa"),
    *("lambda", "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi"),
    *("omega", "Gamma", "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma", "Upsilon", "Phi", "Psi"),
    "Omega",
)
GREEK = dict(zip(_LETTER_NAMES, "αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΥΦΨΩ", strict=True))
"""Greek letters by their names."""

LATEX_GREEK = {letter: f"\\{name}" for name, letter in GREEK.items()}

_NUMBERED = re.compile(r"([A-Za-z]|[a-zA-Z]+?)([0-9]+)")
_WORD = re.compile(r"[A-Za-z0-9]+")
_TWIST = re.compile(r"(.+)_([vw])([xyz])")
_RATE_OF = re.compile(r"der\((.+)\)")

LONGEST_DOTTED = 3
"""The most letters of a word that a dot is set over."""

SUFFIXES = {
    "angle": ("φ", ()),
    "angle1": ("φ", ("1",)),
    "angle2": ("φ", ("2",)),
    "angle3": ("φ", ("3",)),
    "displacement": ("s", ()),
    "x": ("x", ()),
    "y": ("y", ()),
    "z": ("z", ()),
    "qx": ("q", ("x",)),
    "qy": ("q", ("y",)),
    "qz": ("q", ("z",)),
    "qw": ("q", ("w",)),
    "vx": ("v", ("x",)),
    "vy": ("v", ("y",)),
    "vz": ("v", ("z",)),
    "wx": ("ω", ("x",)),
    "wy": ("ω", ("y",)),
    "wz": ("ω", ("z",)),
}
"""Endings of the coordinates of a joint with several of them: letter and subscripts."""


def shaped(text: str) -> Name:
    """The look of a name by its spelling alone.

    Example:
        >>> shaped("m1").subs, shaped("J_axial").subs, shaped("theta").letter, shaped("hinge").letter
        (('1',), ('axial',), 'θ', 'hinge')
    """
    head, *rest = text.split("_")
    if not all(_WORD.fullmatch(part) for part in (head, *rest)):
        return Name(text)
    subs = tuple(map(lower, rest))
    if head in GREEK:
        return Name(GREEK[head], subs)
    numbered = _NUMBERED.fullmatch(head)
    if numbered and (len(numbered[1]) == 1 or numbered[1] in GREEK):
        return Name(GREEK.get(numbered[1], numbered[1]), (numbered[2], *subs))
    return Name(head, subs)


def lower(text: str) -> str:
    """A word as a subscript: names of Greek letters as letters, a number after a letter as its own subscript.

    Example:
        >>> lower("theta"), lower("theta2"), lower("f1"), lower("link1"), lower("hinge")
        ('θ', 'θ₂', 'f₁', 'link1', 'hinge')
    """
    numbered = _NUMBERED.fullmatch(text)
    if numbered and (len(numbered[1]) == 1 or numbered[1] in GREEK):
        return GREEK.get(numbered[1], numbered[1]) + numbered[2].translate(SUBSCRIPTS)
    return GREEK.get(text, text)


def guessed(text: str) -> Name:
    """The look and the role of a name without a derivation, guessed by its ending and its letter."""
    rate = _RATE_OF.fullmatch(text)
    if rate:
        return guessed(rate[1]).rate()
    if text.endswith("_dot") and len(text) > 4:
        return replace(guessed(text[:-4]), role=COORDINATE).rate()
    twist = _TWIST.fullmatch(text)
    if twist:
        return Name("ω" if twist[2] == "w" else "v", (twist[1], twist[3]), role=RATE)
    name = shaped(text)
    roles = {"m": MASS, "M": MASS, "J": MASS, "I": MASS, "k": MASS, "d": MASS, "g": GRAVITY}
    return replace(name, role=roles.get(name.letter, LENGTH if len(name.letter) == 1 else OTHER))


def names_of(derivation: Derived) -> dict[str, Name]:
    """The look of every symbol of a derivation, by the symbol; some may still look alike."""
    found: dict[str, Name] = {}
    tree, model = derivation.structure, derivation.system
    for place, parameter in enumerate(model.parameters.values()):
        # the unit tells masses and stiffnesses from lengths, which come after them among factors
        unit = parameter.unit
        role = MASS if "kg" in unit or "N" in unit else LENGTH
        role = GRAVITY if unit in ("m/s^2", "m/s²") else role
        found[parameter.name] = replace(shaped(parameter.name), role=role, place=place)
    owners = {
        quantity.name: (joint.name, quantity.name.removeprefix(f"{joint.name}_"))
        for joint in model.joints
        for quantity in (*joint.positions(), *joint.velocities())
    }
    symbols = derivation.symbol_names
    for place, name in enumerate(symbols["q"]):
        found[name] = replace(_coordinate(name, owners), role=COORDINATE, place=place)
    for place, quantity in enumerate(tree.velocities):
        if quantity.name in symbols["q"]:
            rate = replace(found[quantity.name].rate(), place=place)
        else:
            rate = replace(_coordinate(quantity.name, owners), role=RATE, place=place)
        found[symbols["v"][place]] = rate
        found[symbols["a"][place]] = rate.rate()
    _dependent(model, owners, found)
    for place, (quantity, symbol) in enumerate(zip(tree.inputs, symbols["u"], strict=True)):
        name = quantity.name
        if symbol != name:  # an effort
            joint, suffix = owners.get(name, (name, name))
            subs = (lower(joint), *([suffix] if name != joint else []))
            found[symbol] = Name("u", subs, role=INPUT, place=place)
        else:
            found[name] = replace(shaped(name), role=INPUT, place=place)
    return _multipliers(derivation, found)


def _dependent(model: System, owners: dict[str, tuple[str, str]], found: dict[str, Name]) -> None:
    """Enter the coordinates of chords and of followers, which are no states but occur in reports."""
    for joint in model.joints:
        own = {quantity.name for quantity in joint.positions()}
        for quantity in joint.positions():
            name = replace(_coordinate(quantity.name, owners), role=COORDINATE, place=len(found))
            found.setdefault(quantity.name, name)
        for quantity in joint.velocities():
            if quantity.name in own:
                found.setdefault(f"{quantity.name}_dot", found[quantity.name].rate())
            else:
                rate = replace(_coordinate(quantity.name, owners), role=RATE, place=len(found))
                found.setdefault(quantity.name, rate)


def _coordinate(name: str, owners: dict[str, tuple[str, str]]) -> Name:
    """A letter if the name has one; a long word becomes an entry of q, since a dot over it is overlooked."""
    joint, suffix = owners.get(name, ("", ""))
    if suffix in SUFFIXES and name != joint:
        letter, subs = SUFFIXES[suffix]
        return Name(letter, (lower(joint), *subs))
    twist = _TWIST.fullmatch(name)
    if twist:
        return Name("ω" if twist[2] == "w" else "v", (lower(twist[1]), twist[3]))
    own = shaped(name)
    return own if len(own.letter) == 1 or len(name) <= LONGEST_DOTTED else Name("q", (name,))


def _multipliers(derivation: Derived, found: dict[str, Name]) -> dict[str, Name]:
    """Enter the multipliers: of a joint by its component and reaction, all others by their names."""
    tree: Any = derivation.structure
    names: list[tuple[str, tuple[str, ...]]] = []
    for closure in tree.closures:
        component = closure.component
        if hasattr(component, "equations"):
            names += [(q.name, (q.name,)) for q, _ in component.equations()]
            continue
        for letter in "ft":
            ways = (f"{letter}{k}" for k in range(1, 7))
            names += [(f"{component.name}_{way}", (component.name, way)) for way in ways]
        for v in component.velocities():
            own = v.name.removeprefix(f"{component.name}_")
            parts = (component.name, own) if own != v.name else (v.name,)
            names.append((f"{v.name}_drive", (*parts, "drive")))
    names += [(r.equation().name, (r.equation().name,)) for r in tree.relations]
    known = derivation.symbol_names["lam"]
    for place, (name, words) in enumerate(names):
        subs = tuple(map(lower, words))
        symbol = name if f"lam_{name}" not in known else f"lam_{name}"
        found.setdefault(symbol, Name("λ", subs, role=INPUT, place=1000 + place))
    return found
