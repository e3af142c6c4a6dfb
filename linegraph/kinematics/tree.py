"""The walk from ground outward along the chosen tree, which folds everything constant into links."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from linegraph.algebra.protocol import set_label
from linegraph.components.body import GROUND
from linegraph.components.body_mass import body_moments, mass_center, resolved
from linegraph.components.joints.base import TORQUES, Restriction
from linegraph.components.parameters import resolver
from linegraph.errors import ModelError
from linegraph.formulation.absolute import floating, turning
from linegraph.kinematics.links import Closure, KinematicTree, Link, Seat
from linegraph.kinematics.state_layout import Layout, layout_of
from linegraph.model.terminal_graphs import terminals_of
from linegraph.spatial.inertia import NO_MOMENTS, joined
from linegraph.spatial.placement import Placement, compose, inverse
from linegraph.spatial.rotation import IDENTITY_MATRIX, Rotation, rotation_of
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.joints import Joint
    from linegraph.formulation.formulate import Formulation
    from linegraph.graph.forest import Step
    from linegraph.model.system import System

_ALIGNED = Placement(ZERO, IDENTITY_MATRIX)


def kinematic_tree(
    system: System, formulation: Formulation, algebra: Algebra, parameters: Mapping[str, Scalar]
) -> KinematicTree:
    """Reduce a system to links: walk its tree from ground outward.

    Args:
        system: bodies, joints, constraints.
        formulation: the chosen trees.
        algebra: where the scalars live.
        parameters: their scalars in it, by name.

    Raises:
        ModelError: a coupling or a prescribed motion is impossible, or an axis is no direction.
    """
    layout = layout_of(system, formulation, algebra, parameters)
    return _Walk(system, formulation, layout, algebra, parameters).along()


def under_inputs(tree: KinematicTree, formulation: Formulation, algebra: Algebra) -> KinematicTree:
    """The same tree at another time and for other inputs: only prescribed motions change, not the links.

    Args:
        tree: the links, over an algebra of the same kind.
        formulation: the chosen trees.
        algebra: has the new time and inputs.

    Raises:
        ModelError: a prescribed motion has no value or no derivative there.
    """
    layout = layout_of(tree.system, formulation, algebra, tree.parameters)
    # a link's joint may be called otherwise than the joint that it is made of
    names = {id(place): name for name, place in tree.layout.places.items()}
    ends = {
        name: replace(end, drive=layout.drives.get(name, ())) for name, end in tree.ends.items()
    }
    return replace(
        tree,
        algebra=algebra,
        layout=layout,
        links=tuple(replace(x, place=layout.places[names[id(x.place)]]) for x in tree.links),
        ends=ends,
        closures=tuple(ends[closure.component.name] for closure in tree.closures),
    )


class _Walk:
    """Collects links on a walk from ground outward."""

    def __init__(
        self,
        system: System,
        formulation: Formulation,
        layout: Layout,
        algebra: Algebra,
        parameters: Mapping[str, Scalar],
    ) -> None:
        self._model = system
        self._formulation = formulation
        self._layout = layout
        self._algebra = algebra
        self._parameters = parameters
        self._resolve = resolver(algebra, parameters)
        self._joints = {joint.name: joint for joint in system.joints}
        self._terminals = terminals_of(system)
        self._links: list[Link] = []
        self._where = {GROUND: (-1, Placement(ZERO, IDENTITY_MATRIX))}

    def along(self) -> KinematicTree:
        """Cross every joint branch in turn; arms lie within a body and are constant."""
        for step in self._formulation.translation.walk:
            joint = self._joints.get(step.edge.name)
            if joint is not None and step.edge.component == joint.name:
                self._cross(joint, step)
            elif step.edge.component in self._formulation.absolute and step.near == GROUND:
                self._float(step.edge.component)
        set_label(self._algebra, "gravity")
        gravity = resolved(self._model.gravity, self._resolve)
        ends = {end.component.name: end for end in self._ends()}
        set_label(self._algebra, "")
        return KinematicTree(
            self._model,
            self._algebra,
            self._parameters,
            tuple(self._links),
            gravity,
            self._layout,
            self._where,
            tuple(end for end in ends.values() if self._left_out(end.component.name)),
            self._model.relations,
            ends,
            self._formulation.network,
            tuple(self._formulation.translation.walk),
        )

    def _left_out(self, name: str) -> bool:
        """Whether the tree leaves the relative motion of the ends of a joint or constraint open: a chord."""
        angle = self._formulation.level.get(name)
        in_space = angle is not None and angle.less is None
        return in_space or name not in self._formulation.joints

    def _cross(self, joint: Joint, step: Step) -> None:
        set_label(self._algebra, f"constants, joint {joint.name}")
        joint = joint.resolved(self._resolve)
        body, placement = self._terminals[step.near]
        parent, pose = self._where[body]
        near = self._compose(pose, self._constant(placement))
        body, placement = self._terminals[step.far]
        far = self._constant(placement)
        if joint.freedoms == 0:
            self._enter(body, parent, self._compose(near, inverse(far)))
            return
        place = self._layout.places[joint.name]
        forward = step.forward
        if place.in_space:
            # an orientation measured from ground: the link has the body's own axes, not the joint's
            joint, forward = turning(joint.name, body, self._layout.stems[body]), True
            far = Placement(far.at, IDENTITY_MATRIX)
        else:
            alignment = self._alignment(joint)
            near, far = self._compose(near, alignment), self._compose(far, alignment)
        rotation = rotation_of(near.rotation)
        self._links.append(Link("", parent, joint, forward, rotation, near.at, place, NO_MOMENTS))
        self._enter(body, len(self._links) - 1, inverse(far))

    def _float(self, body: str) -> None:
        """A body on its inertia edge: a link of its own, its origin at the mass centre."""
        joint = floating(body, self._layout.stems[body])
        place = self._layout.places[joint.name]
        self._links.append(Link("", -1, joint, True, Rotation(), ZERO, place, NO_MOMENTS))
        center = Placement(mass_center(self._model.bodies[body], self._resolve), IDENTITY_MATRIX)
        self._enter(body, len(self._links) - 1, inverse(center))

    def _ends(self) -> Iterator[Closure]:
        """Every joint and constraint as the chord that it is or would be."""
        drives = self._layout.drives
        for given in self._model.joints:
            set_label(self._algebra, f"constants, joint {given.name}")
            joint = given.resolved(self._resolve)
            tail, head = (self._seat(end, self._alignment(joint)) for end in joint.between)
            held: tuple[Restriction, ...] = ()
            if self._left_out(joint.name):
                level = joint.name in self._formulation.level
                found = joint.restricted(self._algebra)
                held = tuple(r for r in found if isinstance(r, TORQUES) or not level)
            yield Closure(joint, tail, head, drives.get(joint.name, ()), held)
        for constraint in self._model.constraints:
            set_label(self._algebra, f"constants, constraint {constraint.name}")
            tail, head = (self._seat(end, _ALIGNED) for end in constraint.ends)
            yield Closure(constraint, tail, head, drives[constraint.name])

    def _seat(self, terminal: str, alignment: Placement) -> Seat:
        """A terminal's aligned axes as a place on its link."""
        body, placement = self._terminals[terminal]
        link, pose = self._where[body]
        whole = self._compose(self._compose(pose, self._constant(placement)), alignment)
        return Seat(link, whole.at, whole.rotation)

    def _enter(self, body: str, index: int, pose: Placement) -> None:
        """Record the pose of a body on its link, and add its mass distribution to the link's."""
        self._where[body] = (index, pose)
        if index < 0:
            return
        link = self._links[index]
        set_label(self._algebra, f"constants, body {body}")
        own = body_moments(self._model.bodies[body], self._resolve, pose)
        moments = joined(link.moments, own)
        name = f"{link.name}, {body}" if link.name else body
        self._links[index] = replace(link, name=name, moments=moments)

    def _alignment(self, joint: Joint) -> Placement:
        try:
            return self._constant(Placement(ZERO, joint.alignment()))
        except ModelError as error:
            if error.thing:
                raise
            problem = f"its axis cannot be a direction: {error.problem}"
            raise ModelError(f'joint "{joint.name}"', problem) from None

    def _constant(self, placement: Placement) -> Placement:
        rows = (resolved(row, self._resolve) for row in placement.rotation)
        return Placement(resolved(placement.at, self._resolve), tuple(rows))  # type: ignore[arg-type]

    def _compose(self, outer: Placement, inner: Placement) -> Placement:
        return compose(outer, inner, self._model.snap)
