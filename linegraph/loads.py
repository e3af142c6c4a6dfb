"""Forces that elements and loads exert on links and along joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph import vector
from linegraph.elements import Element, Load
from linegraph.elements.load import BODY
from linegraph.errors import ModelError
from linegraph.layout import coordinates, scope
from linegraph.parameters import names_in, resolver
from linegraph.rotation import IDENTITY_MATRIX, Full, product
from linegraph.vector import ZERO, Matrix, Scalar, Vector, add, cross, dot, subtract

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra import Algebra
    from linegraph.body import Placement
    from linegraph.kinematics import KinematicTree
    from linegraph.model import Model
    from linegraph.orthogonality import Arm


@dataclass(frozen=True)
class Applied:
    """What acts on a tree besides gravity and joint efforts.

    Attributes:
        wrenches: for each link (force, torque about its origin), in its working axes.
        efforts: along each velocity.
        potential: energy stored in springs.
    """

    wrenches: list[tuple[Vector, Vector]]
    efforts: list[Scalar]
    potential: Scalar = 0


class _Point(NamedTuple):
    """A terminal in motion: its link, its place there, and position and velocity in ground axes."""

    link: int
    at: Vector
    rotation: Matrix
    position: Vector
    velocity: Vector


def depends_on_inputs(model: Model, values: Sequence[Any]) -> bool:
    """Whether a law names an input: then it belongs to Q, otherwise to the bias."""
    inputs = {declared.name for declared in model.inputs}
    return any(names_in(value) & inputs for value in values)


def applied(
    model: Model,
    tree: KinematicTree,
    algebra: Algebra,
    parameters: Mapping[str, Scalar],
    crossed: Sequence[Arm],
    q: tuple[Scalar, ...],
    v: tuple[Scalar, ...],
    *,
    driven: bool,
) -> Applied:
    """Evaluate the elements and loads that depend on inputs (`driven`), or those that do not.

    Raises:
        ModelError: a law names something that does not exist.
    """
    found = [e for e in model.elements if depends_on_inputs(model, e.values()) == driven]
    if not found:
        return Applied([(ZERO, ZERO)] * len(tree.links), [0] * len(tree.velocities))
    values = scope(model, tree.layout, algebra, parameters, q, v)
    return _Evaluation(model, tree, algebra, values, crossed, q, v).of(found)


class _Evaluation:
    """Gathers forces over all elements."""

    def __init__(
        self,
        model: Model,
        tree: KinematicTree,
        algebra: Algebra,
        values: Mapping[str, Scalar],
        crossed: Sequence[Arm],
        q: tuple[Scalar, ...],
        v: tuple[Scalar, ...],
    ) -> None:
        self._tree = tree
        self._algebra = algebra
        self._values = values
        self._state = (q, v)
        self._terminals = model.terminals()
        self._frames = _frames_in_ground(tree, crossed)
        self._wrenches: list[tuple[Vector, Vector]] = [(ZERO, ZERO)] * len(tree.links)
        self._efforts: list[Scalar] = [0] * len(tree.velocities)
        self._potential: Scalar = 0

    def of(self, elements: Sequence[Element | Load]) -> Applied:
        """All of them."""
        for element in elements:
            if hasattr(self._algebra, "label"):
                self._algebra.label = f"{element.kind} {element.name}"
            try:
                self._take(element)
            except ModelError as error:
                raise ModelError(f'{element.kind} "{element.name}"', error.problem) from None
        return Applied(self._wrenches, self._efforts, self._potential)

    def _take(self, element: Element | Load) -> None:
        if isinstance(element, Load):
            self._load(element)
        elif element.joint is not None:
            self._in_joint(element, element.joint)
        elif element.between is not None:
            self._between(element, *element.between)

    def _resolve(self, value: Any, **names: Scalar) -> Scalar:
        return resolver(self._algebra, {**self._values, **names} if names else self._values)(value)

    def _in_joint(self, element: Element, joint: str) -> None:
        place = self._tree.layout.places[joint]
        (x,), (v,) = coordinates(place, *self._state)
        y = element.through(self._algebra, x, v, self._resolve)
        for freedom in place.velocities:
            self._efforts[freedom.index] = self._efforts[freedom.index] - freedom.ratio * y
        self._store(element, x)

    def _between(self, element: Element, tail: str, head: str) -> None:
        a, b = self._point(tail), self._point(head)
        line = subtract(b.position, a.position)
        x = self._algebra.sqrt(dot(line, line))
        direction = vector.scale(1 / x, line)
        v = dot(direction, subtract(b.velocity, a.velocity))
        y = element.through(self._algebra, x, v, self._resolve)
        pull = vector.scale(y, direction)
        self._push(a, pull)
        self._push(b, vector.negate(pull))
        self._store(element, x)

    def _load(self, load: Load) -> None:
        point = self._point(load.at)
        force, torque = (
            tuple(self._resolve(component) for component in given)
            for given in (load.force, load.torque)
        )
        if load.axes == BODY:
            out = Full(point.rotation).out
            force, torque = out(force), out(torque)
        self._push(point, force, torque)

    def _push(self, point: _Point, force: Vector, torque: Vector = ZERO) -> None:
        """Apply a force and a torque in ground axes to a point of a link."""
        if point.link < 0:
            return
        into = Full(self._frames[point.link].rotation).into
        force, torque = into(force), into(torque)
        torque = add(torque, cross(point.at, force))
        known = self._wrenches[point.link]
        self._wrenches[point.link] = (add(known[0], force), add(known[1], torque))

    def _store(self, element: Element, x: Scalar) -> None:
        self._potential = self._potential + element.potential(self._algebra, x, self._resolve)

    def _point(self, terminal: str) -> _Point:
        body, placement = self._terminals[terminal]
        link, pose = self._tree.bodies[body]
        constant = resolver(self._algebra, self._values)
        at = add(pose.at, Full(pose.rotation).out(_resolved(placement.at, constant)))
        axes = _axes(pose, placement, constant)
        if link < 0:
            return _Point(link, at, axes, at, ZERO)
        frame = self._frames[link]
        out = Full(frame.rotation).out
        velocity = out(add(frame.linear, cross(frame.angular, at)))
        x, y, z = (out(column) for column in vector.transpose(axes))
        turned = vector.transpose((x, y, z))
        return _Point(link, at, turned, add(frame.origin, out(at)), velocity)


class _Frame(NamedTuple):
    """A link in ground: its axes and origin there, its velocities in its own axes."""

    rotation: Matrix
    origin: Vector
    angular: Vector
    linear: Vector


def _frames_in_ground(tree: KinematicTree, crossed: Sequence[Arm]) -> list[_Frame]:
    """Position circuit equations from ground outward."""
    frames: list[_Frame] = []
    ground = _Frame(IDENTITY_MATRIX, ZERO, ZERO, ZERO)
    for link, arm in zip(tree.links, crossed, strict=True):
        near = frames[link.parent] if link.parent >= 0 else ground
        into = arm.rotation.into
        x, y, z = (into(row) for row in near.rotation)
        origin = add(near.origin, Full(near.rotation).out(arm.at))
        angular = add(into(near.angular), vector.combine(arm.rates, arm.motion.angular))
        linear = into(add(near.linear, cross(near.angular, arm.at)))
        linear = add(linear, vector.combine(arm.rates, arm.motion.linear))
        frames.append(_Frame((x, y, z), origin, angular, linear))
    return frames


def _axes(pose: Placement, placement: Placement, resolve: Any) -> Matrix:
    """A terminal's axes in its link's working frame."""
    x, y, z = (_resolved(row, resolve) for row in placement.rotation)
    return product(pose.rotation, (x, y, z))


def _resolved(a: Vector, resolve: Any) -> Vector:
    return (resolve(a[0]), resolve(a[1]), resolve(a[2]))
