"""The register of names: every symbol that a model can bring into equations, and its owner.

The register depends on the model alone, never on the formulation, so that a model without a clash in one kind
of coordinates has none in another. The names that a user declares have precedence; those that a derivation
adds (`symbol_names`) avoid them:

    parameters   inputs   coordinates   velocities that are no rates   rates X_dot   states of networks
    accelerations a_X   efforts u_X   multipliers X_f1, X_t1, X_drive   coordinates of bodies as a whole
"""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.components.joints.base import BY_INPUT
from linegraph.components.parameters import names_in
from linegraph.components.validation import RESERVED
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from linegraph.components.constraints import Constraint
    from linegraph.components.forces import Element
    from linegraph.components.joints import Joint
    from linegraph.model.system import System

OWN = {"x": "displacement", "v": "rate"}
"""The names of an element's own across variables in its laws, with their meaning."""


class Claim(NamedTuple):
    """A name and its owner.

    Attributes:
        name: the symbol.
        thing: the owner as errors name it: ``joint "hinge"``.
        own: the role of the name for its owner: ``its coordinate``; empty for the owner's own name.
        what: the role for others: ``a coordinate of joint "hinge"``.
    """

    name: str
    thing: str
    own: str
    what: str


def declared(model: System) -> list[Claim]:
    """All names that a model declares, except those of network states, which have to be derived."""
    found = [*map(parameter_claim, model.parameters)]
    found += [input_claim(given.name) for given in model.inputs]
    for joint in model.joints:
        found += claims_of(joint)
    for constraint in model.constraints:
        found += claims_of_constraint(constraint)
    return [*found, *(output_claim(output.name) for output in model.outputs)]


def claims_of(joint: Joint) -> list[Claim]:
    """The names of a joint: its coordinates, their rates, velocities that are no rates, and its inputs."""
    thing = f'joint "{joint.name}"'
    positions = [quantity.name for quantity in joint.positions()]
    found = [Claim(x, thing, "its coordinate", f"a coordinate of {thing}") for x in positions]
    for velocity in joint.velocities():
        if velocity.name in positions:
            rate = f"{velocity.name}_dot"
            found.append(Claim(rate, thing, "its rate", f"a rate of {thing}"))
        else:
            found.append(Claim(velocity.name, thing, "its velocity", f"a velocity of {thing}"))
    many = isinstance(joint.drive, (tuple, list))
    given = joint.drive if many else (joint.drive,) * len(positions)
    for name, drive in zip(positions, given, strict=False):
        found += _prescribing(name, thing, drive)[1:]
    return found


def claims_of_constraint(constraint: Constraint) -> list[Claim]:
    """The inputs that prescribe a constraint's motion."""
    thing = f'{constraint.kind} "{constraint.name}"'
    given = constraint.prescribed()
    return [c for value, quantity in given for c in _prescribing(quantity.name, thing, value)]


def _prescribing(name: str, thing: str, drive: Any) -> list[Claim]:
    """The inputs of a motion that is prescribed by inputs: a value and its first two derivatives."""
    if not isinstance(drive, str) or drive != BY_INPUT:
        return []
    names = (name, f"{name}_rate", f"{name}_acceleration")
    return [Claim(x, thing, "its input", f"an input of {thing}") for x in names]


def parameter_claim(name: str) -> Claim:
    """The name that a parameter claims."""
    return Claim(name, f'parameter "{name}"', "", "a parameter")


def input_claim(name: str) -> Claim:
    """The name that an input claims."""
    return Claim(name, f'input "{name}"', "", "an input")


def output_claim(name: str) -> Claim:
    """The name that an output claims."""
    return Claim(name, f'output "{name}"', "", "an output")


def clash(first: Claim, second: Claim, places: Mapping[str, int]) -> str:
    """The message for the second of two claims to one name.

    Args:
        first: the claim of the earlier owner.
        second: that of the later one, which gets the error.
        places: lines in the model file by owner.
    """
    line = _line(first, places)
    if second.own:
        return f'{second.own} "{second.name}" has the name of {first.what}{line}; rename one'
    return f"{first.what} has this name too{line}; rename one"


def located(claim: Claim, places: Mapping[str, int]) -> str:
    """The role of a name, with the line of its owner if that is in a file.

    Args:
        claim: the name and its owner.
        places: lines in the model file by owner.
    """
    return claim.what + _line(claim, places)


def _line(claim: Claim, places: Mapping[str, int]) -> str:
    return f" (line {places[claim.thing]})" if claim.thing in places else ""


def require_distinct(claims: Iterable[Claim], places: Mapping[str, int]) -> dict[str, Claim]:
    """The owner of each name, if no name has two.

    Args:
        claims: in the order in which things are declared.
        places: lines in the model file by owner.

    Raises:
        ModelError: a name has two owners; the error is that of the later one and names both.
    """
    owners: dict[str, Claim] = {}
    for claim in claims:
        first = owners.setdefault(claim.name, claim)
        if first is not claim:
            raise ModelError(claim.thing, clash(first, claim, places))
    return owners


def require_own(model: System, owners: Mapping[str, Claim], places: Mapping[str, int]) -> None:
    """Refuse laws of elements whose x or v could also mean something that the model declares.

    Args:
        model: the system.
        owners: all declared names.
        places: lines in the model file by owner.

    Raises:
        ModelError: names the element, and the other owner of the name.
    """
    for element in model.force_elements:
        for field in getattr(element, "laws", ()):
            value = getattr(element, field)
            for name in sorted(
                () if value is None else names_in(value) & OWN.keys() & owners.keys()
            ):
                if not is_own(element, name):
                    problem = own_problem(name, located(owners[name], places))
                    raise ModelError(f'{element.kind} "{element.name}"', problem)


def is_own(element: Element | Any, name: str) -> bool:
    """Whether x in an element's law and the model's x are the same number, the coordinate of its joint.

    Args:
        element: the force element; a rest length makes its own x another number.
        name: that occurs in its law.
    """
    return name == "x" and element.joint == name and not getattr(element, "length", 0)


def own_problem(name: str, owner: str) -> str:
    """The message for an element's own x or v that has another owner, too.

    Args:
        name: x or v.
        owner: the other owner, with its place.
    """
    own = f'"{name}" is the element\'s own {OWN[name]} here'
    return f"{own}, but {owner} has this name too; rename that"


class FreeNames:
    """Gives names that are not taken.

    Args:
        taken: names that are taken already; reserved words are, too.
    """

    def __init__(self, taken: Collection[str]) -> None:
        """Start from the taken names and the reserved words."""
        self.taken = {*taken, *RESERVED}

    def take(self, *names: str) -> None:
        """Mark names as taken."""
        self.taken |= set(names)

    def name(self, *choices: str) -> str:
        """The first of the choices that is free, else the last one with a number; it is taken from now on."""
        found = next(x for x in numbered(*choices) if x not in self.taken)
        self.taken.add(found)
        return found


def numbered(*choices: str) -> Iterator[str]:
    """The choices, then without end the last one with numbers from 2."""
    yield from choices
    for number in count(2):
        yield f"{choices[-1]}_{number}"
