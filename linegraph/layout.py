"""The layout of a model's state and inputs: where every joint finds its coordinates.

Positions and velocities stand in declared order of the joints. Inputs are the joints' efforts in that
order, then the named inputs, then motions prescribed by input, each with its first two derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from linegraph.algebra import Floats
from linegraph.errors import ModelError
from linegraph.jets import Jet, Jets, lifted
from linegraph.joints.base import BY_INPUT
from linegraph.parameters import Input, resolver
from linegraph.program import Quantity

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.algebra import Algebra
    from linegraph.joints import Joint
    from linegraph.model import Coupling, Model
    from linegraph.vector import Scalar

EFFORT_UNITS = {"rad/s": "N*m", "m/s": "N"}


@dataclass(frozen=True)
class Freedom:
    """Where a joint's coordinate comes from: ``q_joint = ratio * (entry of the state) + offset``."""

    index: int
    ratio: Scalar = 1
    offset: Scalar = 0


@dataclass(frozen=True)
class Place:
    """Where a joint's coordinates come from.

    Attributes:
        positions, velocities: entries of the state; none where the motion is prescribed.
        drive: the prescribed coordinates with their first two derivatives; none where they are free.
    """

    positions: tuple[Freedom, ...] = ()
    velocities: tuple[Freedom, ...] = ()
    drive: tuple[Jet, ...] = ()


@dataclass
class Layout:
    """All coordinates and inputs of a model, and who reads them."""

    positions: list[Quantity] = field(default_factory=list)
    velocities: list[Quantity] = field(default_factory=list)
    inputs: list[Quantity] = field(default_factory=list)
    efforts: list[tuple[int, int]] = field(default_factory=list)
    places: dict[str, Place] = field(default_factory=dict)
    named_inputs: dict[str, Scalar] = field(default_factory=dict)


def layout_of(model: Model, algebra: Algebra, parameters: Mapping[str, Scalar]) -> Layout:
    """Number the coordinates and inputs of a model.

    Raises:
        ModelError: a coupling or a prescribed motion is impossible.
    """
    layout = Layout()
    followers = {coupling.joint: coupling for coupling in model.couplings}
    for joint in model.joints:
        if joint.drive is None and joint.name not in followers:
            _add_coordinates(layout, joint)
    for declared in model.inputs:
        layout.named_inputs[declared.name] = _input(layout, algebra, _quantity(declared))
    for quantities in (layout.positions, layout.velocities):
        _require_unique(quantities)
    values = _time(model, algebra, parameters)
    for joint in model.joints:
        if joint.drive is not None:
            layout.places[joint.name] = Place(drive=_drive(layout, joint, algebra, values))
    for coupling in model.couplings:
        _couple(layout, model, coupling.joint, followers, algebra, parameters)
    return layout


def _require_unique(quantities: list[Quantity]) -> None:
    """Refuse two coordinates of one name: readers and inputs could not tell them apart."""
    seen: set[str] = set()
    for quantity in quantities:
        if quantity.name in seen:
            problem = "two coordinates have this name; rename a joint"
            raise ModelError(f'coordinate "{quantity.name}"', problem)
        seen.add(quantity.name)


def _add_coordinates(layout: Layout, joint: Joint) -> None:
    q, v = joint.positions(), joint.velocities()
    first, start = len(layout.positions), len(layout.velocities)
    layout.places[joint.name] = Place(
        tuple(Freedom(first + k) for k in range(len(q))),
        tuple(Freedom(start + k) for k in range(len(v))),
    )
    layout.positions += q
    layout.velocities += v
    if joint.effort:
        for k, velocity in enumerate(v):
            layout.efforts.append((start + k, len(layout.inputs)))
            unit = EFFORT_UNITS[velocity.unit]
            layout.inputs.append(Quantity(velocity.name, unit, f"effort along {velocity.name}"))


def _quantity(declared: Input) -> Quantity:
    return Quantity(declared.name, declared.unit, declared.about)


def _input(layout: Layout, algebra: Algebra, quantity: Quantity) -> Scalar:
    layout.inputs.append(quantity)
    return algebra.symbol("u", len(layout.inputs) - 1)


def _time(model: Model, algebra: Algebra, parameters: Mapping[str, Scalar]) -> dict[str, Scalar]:
    """What a prescribed motion may depend on, as jets: parameters, which are constant, and the time."""
    values: dict[str, Scalar] = {name: lifted(value) for name, value in parameters.items()}
    if model.depends_on_time:
        values["t"] = Jet(algebra.symbol("t"), 1, 0)
    return values


def _drive(
    layout: Layout, joint: Joint, algebra: Algebra, values: Mapping[str, Scalar]
) -> tuple[Jet, ...]:
    """The prescribed coordinates of a joint.

    Raises:
        ModelError: another number of motions than coordinates, or v is not the derivative of q.
    """
    who = f'joint "{joint.name}"'
    q = joint.positions()
    if not _has_plain_rates(joint):
        raise ModelError(
            who,
            "its motion cannot be prescribed: v is not the derivative of q; use a compound joint",
        )
    if joint.drive == BY_INPUT:
        return tuple(_from_inputs(layout, algebra, quantity) for quantity in q)
    given = joint.drive if isinstance(joint.drive, (tuple, list)) else (joint.drive,)
    if len(given) != len(q):
        raise ModelError(who, f"prescribes {len(given)} motions for {len(q)} coordinates")
    resolve = resolver(Jets(algebra), values)
    try:
        return tuple(
            _from_inputs(layout, algebra, quantity) if x == BY_INPUT else lifted(resolve(x))
            for x, quantity in zip(given, q, strict=True)
        )
    except ModelError as error:
        raise ModelError(who, f"motion: {error.problem}") from None


def _has_plain_rates(joint: Joint) -> bool:
    """Whether v is the derivative of q, judged at a state like any other."""
    q, v = joint.positions(), joint.velocities()
    if len(q) != len(v):
        return False
    at = tuple(0.3 + 0.2 * k for k in range(len(q)))
    rates = tuple(1.0 + 0.1 * k for k in range(len(v)))
    return tuple(joint.rates(Floats(), at, rates)) == rates


def _from_inputs(layout: Layout, algebra: Algebra, quantity: Quantity) -> Jet:
    """Three inputs: a coordinate, its rate and its acceleration."""
    name, unit = quantity.name, quantity.unit
    return Jet(
        _input(layout, algebra, Quantity(name, unit, f"prescribed: {quantity.about}")),
        _input(
            layout, algebra, Quantity(f"{name}_rate", f"{unit}/s", f"first derivative of {name}")
        ),
        _input(
            layout,
            algebra,
            Quantity(f"{name}_acceleration", f"{unit}/s^2", f"second derivative of {name}"),
        ),
    )


def _couple(
    layout: Layout,
    model: Model,
    name: str,
    followers: Mapping[str, Coupling],
    algebra: Algebra,
    parameters: Mapping[str, Scalar],
) -> None:
    """Follow the chain of masters to a joint that leads and compose the ratios."""
    who = f'joint "{name}"'
    resolve = resolver(algebra, parameters)
    joints = {joint.name: joint for joint in model.joints}
    ratio: Scalar = 1
    offset: Scalar = 0
    seen = {name}
    follower = name
    while follower in followers:
        coupling = followers[follower]
        for part in (follower, coupling.master):
            if part not in joints or joints[part].freedoms != 1:
                raise ModelError(who, f'cannot follow: "{part}" is not a joint of one freedom')
        # offset first: it is seen through the ratios gathered so far
        offset = offset + ratio * resolve(coupling.offset)
        ratio = ratio * resolve(coupling.ratio)
        follower = coupling.master
        if follower in seen:
            raise ModelError(who, "follows itself through a circle of couplings")
        seen.add(follower)
    layout.places[name] = _followed(layout.places[follower], ratio, offset)


def _followed(master: Place, ratio: Scalar, offset: Scalar) -> Place:
    """The place of a joint that follows another."""
    if master.drive:
        (x,) = master.drive
        return Place(drive=(Jet(ratio * x.x + offset, ratio * x.dx, ratio * x.ddx),))
    (q,), (v,) = master.positions, master.velocities
    return Place((Freedom(q.index, ratio, offset),), (Freedom(v.index, ratio),))


def scope(
    model: Model,
    layout: Layout,
    algebra: Algebra,
    parameters: Mapping[str, Scalar],
    q: tuple[Scalar, ...],
    v: tuple[Scalar, ...],
) -> dict[str, Any]:
    """Everything a law may name: parameters, inputs, t, coordinates and their rates as ``der(x)``."""
    values: dict[str, Any] = {**parameters, **layout.named_inputs}
    if model.depends_on_time:
        values["t"] = algebra.symbol("t")
    for joint in model.joints:
        place = layout.places[joint.name]
        at, rates = coordinates(place, q, v)
        derivatives = rates if place.drive else joint.rates(algebra, at, rates)
        for quantity, x, dx in zip(joint.positions(), at, derivatives, strict=True):
            values[quantity.name] = x
            values[f"der({quantity.name})"] = dx
    return values


def coordinates(
    place: Place, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
    """A joint's own q and v, from the state or as prescribed."""
    if place.drive:
        return tuple(x.x for x in place.drive), tuple(x.dx for x in place.drive)
    at = tuple(f.ratio * q[f.index] + f.offset for f in place.positions)
    return at, tuple(f.ratio * v[f.index] for f in place.velocities)
