"""What a law may name: parameters, inputs, the time, coordinates and their rates as ``der(x)``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.components.parameters import names_in, resolver
from linegraph.errors import ModelError
from linegraph.kinematics.state_layout import coordinates

if TYPE_CHECKING:
    import random
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.constraints.relation import Relation
    from linegraph.dynamics.chords import Chords
    from linegraph.kinematics.links import KinematicTree
    from linegraph.model.system import System

State = tuple[tuple[Any, ...], tuple[Any, ...]]
"""q and v."""


def scope(
    model: System,
    tree: KinematicTree,
    algebra: Algebra,
    parameters: Mapping[str, Scalar],
    state: State,
    chords: Chords | None = None,
) -> dict[str, Any]:
    """Everything a law may name, with its scalar.

    Args:
        model: what was said.
        tree: what was chosen.
        algebra: where to calculate.
        parameters: their scalars.
        state: q and v.
        chords: where joints that are chords find their coordinates; None to leave these out.
    """
    values: dict[str, Any] = {**parameters, **tree.layout.named_inputs}
    if model.depends_on_time:
        values["t"] = algebra.symbol("t")
    known = {c.component.name: c for c in tree.closures}
    for joint in model.joints:
        found = joint_state(tree, joint.name, state)
        if found is not None:
            at, rates = found
            derivatives = joint.rates(algebra, at, rates)
            drive = tree.layout.places[joint.name].drive
            if drive:
                derivatives = rates
            if drive and isinstance(algebra, Jets):
                # a prescribed motion goes on by itself, whatever the accelerations
                at, derivatives = drive, tuple(Jet(x.dx, x.ddx, 0) for x in drive)
        else:
            if chords is not None and joint.name in known:
                values |= chords.named(known[joint.name])
            continue
        for quantity, x, dx in zip(joint.positions(), at, derivatives, strict=True):
            values[quantity.name] = x
            values[f"der({quantity.name})"] = dx
    return values


def joint_state(tree: KinematicTree, joint: str, state: State) -> Any:
    """The coordinates and velocities of a joint; None of one whose coordinates are none of the state."""
    place = tree.layout.own(joint)
    return None if place is None else coordinates(place, *state)


def relations(
    model: System,
    tree: KinematicTree,
    algebra: Algebra,
    parameters: Mapping[str, Scalar],
    state: State,
    rates: Sequence[Scalar],
) -> list[tuple[list[Scalar], Scalar, Scalar]]:
    """Of each relation ``a v = b`` the coefficients a, the right-hand side b and γ of ``a v̇ = γ``.

    Args:
        model: as of `scope`.
        tree: as of `scope`.
        algebra: as of `scope`.
        parameters: as of `scope`.
        state: as of `scope`.
        rates: q̇.

    Raises:
        ModelError: a relation names an input or what has no value.
    """
    found = []
    for relation in tree.relations:
        who = f'relation "{relation.name}"'
        _require_no_input(model, relation)
        _require_branches(model, tree, relation)

        def evaluate(v: Sequence[Scalar], relation: Relation = relation) -> Scalar:
            values = scope(model, tree, algebra, parameters, (state[0], tuple(v)))
            return resolver(algebra, values)(relation.rate)

        jets = Jets(algebra)
        moving = (
            tuple(Jet(x, dx, 0) for x, dx in zip(state[0], rates, strict=True)),
            tuple(lifted(x) for x in state[1]),
        )
        lifted_parameters = {name: lifted(x) for name, x in parameters.items()}
        try:
            row, right = relation.linear(algebra, evaluate, len(tree.velocities))
            values = scope(model, tree, jets, lifted_parameters, moving)
            change = lifted(resolver(jets, values)(relation.rate)).dx
        except ModelError as error:
            raise ModelError(who, error.problem) from None
        except ArithmeticError:
            raise ModelError(who, "has no finite value or derivative at some state") from None
        found.append((row, right, -change))
    return found


def require_linear(
    model: System,
    tree: KinematicTree,
    algebra: Algebra,
    parameters: Mapping[str, Scalar],
    draw: random.Random,
) -> None:
    """Refuse relations that are not linear in rates, or have none; judged at random states over floats.

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
        _require_no_input(model, relation)
        _require_branches(model, tree, relation)
        found = []
        for v in ([0.0] * size, a, b, both):
            try:
                values = scope(model, tree, algebra, parameters, (tuple(q), tuple(v)))
                found.append(float(resolver(algebra, values)(relation.rate)))
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


def _require_no_input(model: System, relation: Relation) -> None:
    inputs = {declared.name for declared in model.inputs}
    for name in sorted(names_in(relation.rate) & inputs):
        problem = (
            f"names the input {name}, whose derivative is not known; prescribe a joint's motion"
        )
        raise ModelError(f'relation "{relation.name}"', problem)


def _require_branches(model: System, tree: KinematicTree, relation: Relation) -> None:
    names = names_in(relation.rate)
    for joint in model.joints:
        own = {x for q in joint.positions() for x in (q.name, f"der({q.name})")}
        if names & own and tree.layout.own(joint.name) is None:
            problem = (
                f'names {min(names & own)}, but joint "{joint.name}" is no branch of the tree in '
                "these coordinates, which a relation needs; choose a tree that has it as a branch"
            )
            raise ModelError(f'relation "{relation.name}"', problem)
