"""The layout of state and inputs: the source of every joint's coordinates.

Positions and velocities come in declared order: first those of joints that are branches, then those of
bodies whose inertia edge is one. Inputs are the efforts of all joints, branches or not, in their order,
then the named inputs, then motions prescribed by input, each with its first two derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.algebra.protocol import Floats, set_label
from linegraph.components.joints.base import BY_INPUT
from linegraph.components.parameters import Input, resolver
from linegraph.errors import ModelError
from linegraph.formulation.absolute import floating, stems_of, turning
from linegraph.ir.program import Quantity

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.constraints import Constraint
    from linegraph.components.joints import Joint
    from linegraph.formulation.formulate import Formulation
    from linegraph.formulation.planarity import Angle
    from linegraph.model.coupling import Coupling
    from linegraph.model.system import System
    from linegraph.networks import Network

NOT_SMOOTH = "has no finite value, rate and acceleration"
EFFORT_UNITS = {"rad/s": "N*m", "m/s": "N"}


@dataclass(frozen=True)
class Freedom:
    """One coordinate of a joint as a function of the state: ``ratio * (entry index) + offset``."""

    index: int
    ratio: Scalar = 1
    offset: Scalar = 0


@dataclass(frozen=True)
class Place:
    """The source of a joint's coordinates: entries of the state, or a prescribed motion.

    Attributes:
        positions, velocities: entries of the state; none if the motion is prescribed.
        drive: the prescribed coordinates with their first two time derivatives; none if they are free.
        less: for an angle measured from ground, the entries of q and v of the near body's angle, to be
            added: their sign is reversed.
        level: whether the velocities are measured from ground.
    """

    positions: tuple[Freedom, ...] = ()
    velocities: tuple[Freedom, ...] = ()
    drive: tuple[Jet, ...] = ()
    less: tuple[tuple[Freedom, ...], tuple[Freedom, ...]] = ((), ())
    level: bool = False

    @property
    def in_space(self) -> bool:
        """Whether the coordinates are an orientation relative to ground, not the joint's own."""
        return self.level and len(self.positions) > 1


@dataclass
class Layout:
    """All coordinates and inputs of a model, and which component reads which.

    Attributes:
        efforts: (velocity, input) of each effort that acts along one velocity alone.
        pushes: first input of each joint whose effort does not: chords, and joints measured from
            ground.
        places: by joint, and by stem for bodies on their inertia edge.
        stems: prefix of the coordinates of each free body: its name, unless one is taken.
        drives: prescribed motions by joint or constraint, chords included.
        input_rates: named inputs and the derivatives that networks need, by kind: u, du and ddu.
        slopes: for each input whose derivative is an input too, the place of that.
        mechanical: the number of velocities of mechanics; states of networks follow.
    """

    positions: list[Quantity] = field(default_factory=list)
    velocities: list[Quantity] = field(default_factory=list)
    inputs: list[Quantity] = field(default_factory=list)
    efforts: list[tuple[int, int]] = field(default_factory=list)
    pushes: dict[str, int] = field(default_factory=dict)
    places: dict[str, Place] = field(default_factory=dict)
    drives: dict[str, tuple[Jet | None, ...]] = field(default_factory=dict)
    named_inputs: dict[str, Scalar] = field(default_factory=dict)
    input_rates: dict[tuple[str, str], Scalar] = field(default_factory=dict)
    slopes: dict[int, int] = field(default_factory=dict)
    stems: dict[str, str] = field(default_factory=dict)
    mechanical: int = 0

    def own(self, joint: str) -> Place | None:
        """The source of a joint's own coordinates; None if they are not part of the state."""
        place = self.places.get(joint)
        return None if place is None or place.in_space else place


def layout_of(
    system: System, formulation: Formulation, algebra: Algebra, parameters: Mapping[str, Scalar]
) -> Layout:
    """Number the coordinates and inputs of a system.

    Args:
        system: joints, bodies, inputs.
        formulation: the chosen trees, which decide on the coordinates.
        algebra: makes the symbols of inputs.
        parameters: their scalars, by name.

    Raises:
        ModelError: a coupling or a prescribed motion is impossible.
    """
    layout = Layout(stems=stems_of(system, formulation))
    followers = {coupling.joint: coupling for coupling in system.couplings}
    for joint in system.joints:
        if joint.drive is None and joint.name not in followers:
            _add_effort(layout, joint, _add_coordinates(layout, joint, formulation))
    for body in formulation.absolute:
        stem = layout.stems[body]
        layout.places[stem] = _placed(layout, floating(body, stem))
    layout.mechanical = len(layout.velocities)
    if formulation.network is not None:
        _add_states(layout, formulation.network)
    for given in system.inputs:
        layout.named_inputs[given.name] = _input(layout, algebra, _quantity(given))
        _add_rates(layout, system, algebra, given, formulation)
    values = _time(system, algebra, parameters)
    for joint in system.joints:
        if joint.drive is not None:
            drive = _drive(layout, joint, algebra, values)
            layout.drives[joint.name] = drive
            layout.places[joint.name] = Place(drive=drive)
    for constraint in system.constraints:
        layout.drives[constraint.name] = _prescribed(layout, constraint, algebra, values)
    for coupling in system.couplings:
        _couple(layout, system, coupling.joint, followers, algebra, parameters)
    for name, angle in formulation.level.items():
        _measure_from_ground(layout, name, angle)
    return layout


def _add_states(layout: Layout, network: Network) -> None:
    """Append the states of networks to the velocities."""
    layout.velocities += [state.quantity for state in network.states]


def _add_rates(
    layout: Layout, system: System, algebra: Algebra, declared: Input, formulation: Formulation
) -> None:
    """Append inputs for the derivatives of a named one, up to the order that networks need."""
    name, unit = declared.name, declared.unit or "1"
    layout.input_rates[("u", name)] = layout.named_inputs[name]
    at = len(layout.inputs) - 1
    order = formulation.network.rates.get(name, 0) if formulation.network else 0
    rate = Quantity(f"{name}_rate", f"{unit}/s", f"first derivative of {name}")
    second = Quantity(f"{name}_acceleration", f"{unit}/s^2", f"second derivative of {name}")
    for kind, quantity in (("du", rate), ("ddu", second))[:order]:
        if any(other.name == quantity.name for other in system.inputs):
            problem = f"the derivative of {name} is needed under this name; rename the input"
            raise ModelError(f'input "{quantity.name}"', problem)
        layout.input_rates[(kind, name)] = _input(layout, algebra, quantity)
    if order:
        layout.slopes[at] = at + 1


def _add_coordinates(layout: Layout, joint: Joint, formulation: Formulation) -> bool:
    """Append the coordinates of a joint that is a branch; whether its efforts act along these alone."""
    if joint.name not in formulation.joints:
        return False
    angle = formulation.level.get(joint.name)
    if angle is None:
        layout.places[joint.name] = _placed(layout, joint)
        return True
    own = (
        joint
        if angle.less is not None
        else turning(joint.name, angle.body, layout.stems[angle.body])
    )
    layout.places[joint.name] = _placed(layout, own)
    if angle.less is not None:
        about = f"of {angle.body} against ground, about the axis of {joint.name}"
        layout.positions[-1] = replace(layout.positions[-1], about=f"angle {about}")
        layout.velocities[-1] = replace(layout.velocities[-1], about=f"rate {about}")
    return False


def _placed(layout: Layout, joint: Joint) -> Place:
    """Append new entries of the state for all coordinates of a joint."""
    q, v = joint.positions(), joint.velocities()
    first, start = len(layout.positions), len(layout.velocities)
    layout.positions += q
    layout.velocities += v
    return Place(
        tuple(Freedom(first + k) for k in range(len(q))),
        tuple(Freedom(start + k) for k in range(len(v))),
    )


def _add_effort(layout: Layout, joint: Joint, along: bool) -> None:
    """Append inputs for the efforts of a joint, whether its coordinates are part of the state or not."""
    if not joint.effort:
        return
    first = len(layout.inputs)
    for velocity in joint.velocities():
        unit = EFFORT_UNITS[velocity.unit]
        layout.inputs.append(Quantity(velocity.name, unit, f"effort along {velocity.name}"))
    if along:
        found = layout.places[joint.name].velocities
        layout.efforts += [(f.index, first + k) for k, f in enumerate(found)]
    elif joint.velocities():
        layout.pushes[joint.name] = first


def _measure_from_ground(layout: Layout, name: str, angle: Angle) -> None:
    """Note the angles to subtract from one measured from ground to get the joint's own."""
    place = layout.places[name]
    less: tuple[list[Freedom], list[Freedom]] = ([], [])
    for other, sign in angle.less or ():
        found = layout.places[other]
        for entries, (f,) in zip(less, (found.positions, found.velocities), strict=True):
            entries.append(Freedom(f.index, -sign * f.ratio, -sign * f.offset))
    layout.places[name] = replace(place, less=(tuple(less[0]), tuple(less[1])), level=True)


def _quantity(declared: Input) -> Quantity:
    return Quantity(declared.name, declared.unit, declared.about)


def _input(layout: Layout, algebra: Algebra, quantity: Quantity) -> Scalar:
    layout.inputs.append(quantity)
    return algebra.symbol("u", len(layout.inputs) - 1)


def _time(system: System, algebra: Algebra, parameters: Mapping[str, Scalar]) -> dict[str, Scalar]:
    """The quantities that a prescribed motion may depend on, as jets: constant parameters, and time."""
    values: dict[str, Scalar] = {name: lifted(value) for name, value in parameters.items()}
    if system.depends_on_time:
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
    if not has_plain_rates(joint):
        raise ModelError(
            who,
            "its motion cannot be prescribed: v is not the derivative of q; use a compound joint",
        )
    if joint.drive == BY_INPUT:
        return tuple(_from_inputs(layout, algebra, quantity) for quantity in q)
    given = joint.drive if isinstance(joint.drive, (tuple, list)) else (joint.drive,)
    if len(given) != len(q):
        raise ModelError(who, f"prescribes {len(given)} motions for {len(q)} coordinates")
    return tuple(
        _motion(layout, algebra, values, who, x, quantity)
        for x, quantity in zip(given, q, strict=True)
    )


def _prescribed(
    layout: Layout, constraint: Constraint, algebra: Algebra, values: Mapping[str, Scalar]
) -> tuple[Jet | None, ...]:
    """The values that a constraint prescribes as functions of time; None where it prescribes nothing."""
    who = f'{constraint.kind} "{constraint.name}"'
    return tuple(
        None if x is None else _motion(layout, algebra, values, who, x, quantity)
        for x, quantity in constraint.prescribed()
    )


def _motion(
    layout: Layout,
    algebra: Algebra,
    values: Mapping[str, Scalar],
    who: str,
    given: Any,
    quantity: Quantity,
) -> Jet:
    """A prescribed value with its first two time derivatives, from an expression of t or from inputs."""
    if given == BY_INPUT:
        return _from_inputs(layout, algebra, quantity)
    set_label(algebra, f"motion of {quantity.name}")
    try:
        return lifted(resolver(Jets(algebra), values)(given))
    except ModelError as error:
        raise ModelError(who, f"motion: {error.problem}") from None
    except ArithmeticError:
        raise ModelError(who, f"motion: {NOT_SMOOTH}") from None


def has_plain_rates(joint: Joint) -> bool:
    """Whether v is the derivative of q, tested at arbitrary values of q and v."""
    q, v = joint.positions(), joint.velocities()
    if len(q) != len(v):
        return False
    at = tuple(0.3 + 0.2 * k for k in range(len(q)))
    rates = tuple(1.0 + 0.1 * k for k in range(len(v)))
    return tuple(joint.rates(Floats(), at, rates)) == rates


def _from_inputs(layout: Layout, algebra: Algebra, quantity: Quantity) -> Jet:
    """Three inputs: a coordinate, its rate and its acceleration."""
    name, unit = quantity.name, quantity.unit
    layout.slopes[len(layout.inputs)] = len(layout.inputs) + 1
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
    system: System,
    name: str,
    followers: Mapping[str, Coupling],
    algebra: Algebra,
    parameters: Mapping[str, Scalar],
) -> None:
    """Follow the chain of masters to a joint that leads and compose the ratios."""
    who = f'joint "{name}"'
    resolve = resolver(algebra, parameters)
    joints = {joint.name: joint for joint in system.joints}
    ratio: Scalar = 1
    offset: Scalar = 0
    seen = {name}
    follower = name
    while follower in followers:
        coupling = followers[follower]
        for part in (follower, coupling.master):
            if part not in joints or joints[part].freedoms != 1:
                raise ModelError(who, f'cannot follow: "{part}" is not a joint of one freedom')
        # offset first: it is multiplied by the ratios of the couplings passed so far
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


def coordinates(
    place: Place, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
    """A joint's own q and v, from the state or as prescribed.

    Args:
        place: the source of the joint's coordinates.
        q: all coordinates.
        v: all velocities.
    """
    if place.drive:
        return tuple(x.x for x in place.drive), tuple(x.dx for x in place.drive)
    at = tuple(f.ratio * q[f.index] + f.offset for f in place.positions)
    rates = own_rates(place, v)
    for own, near in zip(place.less[0], place.less[1], strict=True):
        at = (at[0] + (own.ratio * q[own.index] + own.offset),)
        rates = (rates[0] + near.ratio * v[near.index],)
    return at, rates


def own_rates(place: Place, v: tuple[Scalar, ...]) -> tuple[Scalar, ...]:
    """The joint's entries of v with their ratios, also if they are measured from ground.

    Args:
        place: the source of the joint's coordinates.
        v: all velocities.
    """
    return tuple(f.ratio * v[f.index] for f in place.velocities)
