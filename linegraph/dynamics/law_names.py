"""Names that a law may use: parameters, inputs, time, coordinates and their rates as ``der(x)``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Protocol

from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.components.parameters import names_in, resolver
from linegraph.errors import ModelError
from linegraph.kinematics.state_layout import coordinates
from linegraph.kinematics.tree_state import TreeState

if TYPE_CHECKING:
    import random
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.components.constraints.relation import Relation
    from linegraph.kinematics.links import Closure, KinematicTree
    from linegraph.model.system import System


class Measures(Protocol):
    """Measures the coordinates of joints that are chords."""

    def named(self, closure: Closure) -> dict[str, Scalar]:
        """Coordinates x and rates ``der(x)`` of a chord, by name."""


def scope(state: TreeState, chords: Measures | None = None) -> dict[str, Any]:
    """Everything a law may name, with its scalar at a state.

    Args:
        state: the tree at (q, v).
        chords: measures the coordinates of joints that are chords; None to leave these out.
    """
    tree, algebra = state.tree, state.algebra
    values: dict[str, Any] = {**tree.parameters, **tree.layout.named_inputs}
    if tree.system.depends_on_time:
        values["t"] = algebra.symbol("t")
    known = {c.component.name: c for c in tree.closures}
    for joint in tree.system.joints:
        found = joint_state(state, joint.name)
        if found is not None:
            at, rates = found
            derivatives = joint.rates(algebra, at, rates)
            drive = tree.layout.places[joint.name].drive
            if drive:
                derivatives = rates
            if drive and isinstance(algebra, Jets):
                # a prescribed motion has its own second derivative, whatever v̇ is
                at, derivatives = drive, tuple(Jet(x.dx, x.ddx, 0) for x in drive)
        else:
            if chords is not None and joint.name in known:
                values |= chords.named(known[joint.name])
            continue
        for quantity, x, dx in zip(joint.positions(), at, derivatives, strict=True):
            values[quantity.name] = x
            values[f"der({quantity.name})"] = dx
    return values


def joint_state(state: TreeState, joint: str) -> Any:
    """The coordinates and velocities of a joint; None if its coordinates are not part of the state.

    Args:
        state: the tree at (q, v).
        joint: name of the joint.
    """
    place = state.tree.layout.own(joint)
    return None if place is None else coordinates(place, state.q, state.v)


def relations(state: TreeState) -> list[tuple[list[Scalar], Scalar, Scalar]]:
    """For each relation ``a v = b`` the coefficients a, the right-hand side b and γ of ``a v̇ = γ``.

    γ is minus the time derivative of the residual at v̇ = 0, found by evaluating the relation with
    jets.

    Raises:
        ModelError: a relation names an input, or something without a value.
    """
    tree, algebra = state.tree, state.algebra
    found = []
    for relation in tree.relations:
        who = f'relation "{relation.name}"'
        _require_no_input(tree.system, relation)
        _require_branches(tree, relation)

        def evaluate(v: Sequence[Scalar], relation: Relation = relation) -> Scalar:
            values = scope(TreeState(tree, state.q, v))
            return resolver(algebra, values)(relation.rate)

        jets = Jets(algebra)
        lifted_parameters = {name: lifted(x) for name, x in tree.parameters.items()}
        moving = TreeState(
            replace(tree, algebra=jets, parameters=lifted_parameters),
            (Jet(x, dx, 0) for x, dx in zip(state.q, state.coordinate_rates, strict=True)),
            map(lifted, state.v),
        )
        try:
            row, right = relation.linear(algebra, evaluate, len(tree.velocities))
            values = scope(moving)
            change = lifted(resolver(jets, values)(relation.rate)).dx
        except ModelError as error:
            raise ModelError(who, error.problem) from None
        except ArithmeticError:
            raise ModelError(who, "has no finite value or derivative at some state") from None
        found.append((row, right, -change))
    return found


def require_linear(tree: KinematicTree, draw: random.Random) -> None:
    """Refuse relations that contain no rates or are not linear in them, judged over floats.

    A function r(v) is affine if r(a + b) + r(0) = r(a) + r(b); this is tested at random a and b.

    Args:
        tree: the links in numbers.
        draw: source of the random states.

    Raises:
        ModelError: names the relation.
    """
    size = len(tree.velocities)
    q = [draw.uniform(-1, 1) for _ in tree.positions]
    tree.normalise(q)
    a, b = ([draw.uniform(-1, 1) for _ in range(size)] for _ in range(2))
    both = [x + y for x, y in zip(a, b, strict=True)]
    for relation in tree.relations:
        who = f'relation "{relation.name}"'
        _require_no_input(tree.system, relation)
        _require_branches(tree, relation)
        found = []
        for v in ([0.0] * size, a, b, both):
            try:
                values = scope(TreeState(tree, q, v))
                found.append(float(resolver(tree.algebra, values)(relation.rate)))
            except ModelError as error:
                raise ModelError(who, error.problem) from None
            except ArithmeticError:
                raise ModelError(who, "has no finite value at a state like any other") from None
        rest, *shares, whole = found
        scale = sum(map(abs, found))
        if abs(whole + rest - sum(shares)) > 1e-9 * scale:
            raise ModelError(who, "is not linear in the rates der(...)")
        if max(abs(x - rest) for x in shares) <= 1e-12 * scale:
            problem = "constrains no velocity: it must have rates der(...) of coordinates"
            raise ModelError(who, problem)


def _require_no_input(system: System, relation: Relation) -> None:
    inputs = {declared.name for declared in system.inputs}
    for name in sorted(names_in(relation.rate) & inputs):
        problem = (
            f"names the input {name}, whose derivative is not known; prescribe a joint's motion"
        )
        raise ModelError(f'relation "{relation.name}"', problem)


def _require_branches(tree: KinematicTree, relation: Relation) -> None:
    names = names_in(relation.rate)
    for joint in tree.system.joints:
        own = {x for q in joint.positions() for x in (q.name, f"der({q.name})")}
        if names & own and tree.layout.own(joint.name) is None:
            problem = (
                f'names {min(names & own)}, but joint "{joint.name}" is no branch of the tree in '
                "these coordinates, which a relation needs; choose a tree that has it as a branch"
            )
            raise ModelError(f'relation "{relation.name}"', problem)
