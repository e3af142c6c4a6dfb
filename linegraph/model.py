"""The model: what the user said. The only mutable type; every door into linegraph builds one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar

from linegraph.body import GROUND, MASS_CENTER, Body, Placement, inertia_of, orientation, unit
from linegraph.checks import finite, nearest, plain, rotation_matrix, triple, vector
from linegraph.domains import ROTATION, TRANSLATION
from linegraph.errors import ModelError
from linegraph.graph import Edge, SystemGraph, unite
from linegraph.joints import Fixed, Free, Joint, Planar, Prismatic, Revolute
from linegraph.parameters import Parameter, is_number
from linegraph.rotation import IDENTITY_MATRIX, snapped
from linegraph.vector import ZERO, Vector

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

STANDARD_GRAVITY: Vector = (0, 0, -9.81)
SNAP = 1e-11

Ask = ParamSpec("Ask")
Kind = TypeVar("Kind", bound=Joint)


@dataclass(frozen=True)
class BodyHandle:
    """A body of a model under construction; stands for its own frame where a terminal is wanted."""

    model: Model
    name: str

    def frame(
        self,
        name: str,
        at: Sequence[Any] = ZERO,
        rpy: Sequence[float] | None = None,
        axis: Sequence[float] | None = None,
        angle: float = 0.0,
        rotation: Any = None,
    ) -> str:
        """Add a named frame and return its terminal.

        Args:
            name: unique on this body.
            at: origin in the body's frame (m).
            rpy: orientation by turns about the body's fixed x, y, z, in radians; or
            axis: by one turn about this direction,
            angle: by so many radians; or
            rotation: by the matrix whose columns are the frame's axes in body axes.

        Returns:
            ``"body.frame"``, to be used in `between`.
        """
        who = f'frame "{self.name}.{name}"'
        finite((angle,), who)
        if rotation is None:
            matrix = orientation(who, triple(rpy, who), triple(axis, who), angle)
        else:
            matrix = rotation_matrix(rotation, who)
        placement = Placement(vector(at, who), snapped(matrix, self.model.snap))
        return self.model.add_frame(self.name, name, placement)

    def __str__(self) -> str:
        """The body's own frame as a terminal."""
        return self.name


Terminal = str | BodyHandle


@dataclass(frozen=True)
class Coupling:
    """``q_joint = ratio q_master + offset`` between two joints of one freedom each."""

    joint: str
    master: str
    ratio: Any = 1
    offset: Any = 0


def _adds(kind: Callable[Concatenate[str, tuple[str, str], Ask], Kind]) -> Any:
    """A builder method that adds a joint of one kind: the line in the register of words."""

    def add(
        self: Model,
        name: str,
        between: tuple[Terminal, Terminal],
        *args: Ask.args,
        **kw: Ask.kwargs,
    ) -> Kind:
        tail, head = between
        return self.add_joint(kind(name, (str(tail), str(head)), *args, **kw))

    add.__doc__ = kind.__doc__
    add.__name__ = str(getattr(kind, "kind", add.__name__))
    return add


class Model:
    """A system of components, connected at terminals.

    Args:
        name: the prefix of everything emitted.
        gravity: acceleration of free fall in ground axes (m/s^2).
        about: one paragraph for the head of emitted files.
        snap: rotation entries closer than this to 0, 1, -1, 1/2 or -1/2 become these exactly.

    Example:
        >>> model = Model("pendulum")
        >>> bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
        >>> _ = model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
        >>> [joint.name for joint in model.joints]
        ['hinge']
    """

    def __init__(
        self,
        name: str,
        *,
        gravity: Sequence[Any] = STANDARD_GRAVITY,
        about: str = "",
        snap: float = SNAP,
    ) -> None:
        """Start with ground alone."""
        self.name = name
        self.about = about
        self.snap = snap
        self.gravity = gravity
        self.bodies: dict[str, Body] = {}
        self.ground = BodyHandle(self, GROUND)
        self.ground_frames: dict[str, Placement] = {}
        self.parameters: dict[str, Parameter] = {}
        self.warnings: list[str] = []
        # where a file said what, for errors found later: the file, and a line for each thing
        self.source: str | None = None
        self.places: dict[str, int] = {}
        self._joints: dict[str, Joint] = {}
        self._couplings: dict[str, Coupling] = {}

    revolute = _adds(Revolute)
    prismatic = _adds(Prismatic)
    planar = _adds(Planar)
    free = _adds(Free)
    fixed = _adds(Fixed)

    @property
    def gravity(self) -> Vector:
        """Acceleration of free fall in ground axes (m/s^2); may be set, also to parameters."""
        return self._gravity

    @gravity.setter
    def gravity(self, acceleration: Sequence[Any]) -> None:
        self._gravity = vector(acceleration, "gravity")

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints in declared order: the order of coordinates."""
        return tuple(self._joints.values())

    @property
    def couplings(self) -> tuple[Coupling, ...]:
        """The coupled joints in declared order."""
        return tuple(self._couplings.values())

    def parameter(
        self, name: str, value: float | None = None, unit: str = "", about: str = ""
    ) -> Parameter:
        """Declare a number that stays a symbol.

        Raises:
            ModelError: the name is taken.
        """
        if name in self.parameters:
            raise ModelError(f'parameter "{name}"', "is declared twice")
        if value is not None:
            finite((value,), f'parameter "{name}"')
        return self.parameters.setdefault(name, Parameter(name, value, unit, about))

    def body(
        self,
        name: str,
        *,
        mass: Any = 0,
        mass_center: Sequence[Any] | None = None,
        inertia: Any = (0, 0, 0),
        first_moment: Sequence[Any] | None = None,
    ) -> BodyHandle:
        """Add a rigid body.

        Args:
            name: unique among bodies.
            mass: kg.
            mass_center: in the body's frame (m); default its origin.
            inertia: (xx, yy, zz), a 3 x 3 matrix or named entries (kg m^2), in body axes, about the mass
                centre; about the body's origin where `first_moment` is given.
            first_moment: mass times mass centre (kg m), instead of `mass_center`.

        Raises:
            ModelError: the name is taken, a number is not finite, the mass is negative.
        """
        who = f'body "{name}"'
        if name in self.bodies or name == GROUND:
            raise ModelError(who, "the name is taken; names of bodies are unique")
        if mass_center is not None and first_moment is not None:
            raise ModelError(who, "give mass_center or first_moment, not both")
        mass = plain(mass)
        tensor = inertia_of(inertia, who)
        finite((mass, *tensor), who)
        if is_number(mass) and mass < 0:
            raise ModelError(who, f"the mass is negative ({mass}); it must be 0 or more")
        at = ZERO if mass_center is None else mass_center
        center = None if first_moment is not None else vector(at, who)
        first = vector(first_moment, who) if first_moment is not None else None
        self.bodies[name] = Body(name, mass, center, first, tensor, {})
        return BodyHandle(self, name)

    def add_frame(self, body: str, name: str, placement: Placement) -> str:
        """Add a frame to a body or to ground; `BodyHandle.frame` is the friendly way."""
        who = f'frame "{body}.{name}"'
        frames = self.ground_frames if body == GROUND else self.bodies[body].frames
        if name in frames or name == MASS_CENTER:
            raise ModelError(who, "the name is taken on this body")
        if body == GROUND:
            self.ground_frames[name] = placement
        else:
            self.bodies[body] = replace(self.bodies[body], frames={**frames, name: placement})
        return f"{body}.{name}"

    def add_joint(self, joint: Kind) -> Kind:
        """Add a joint made elsewhere; ``model.revolute(...)`` and its siblings are the friendly way.

        Raises:
            ModelError: the name is taken or the axis has no length.
        """
        who = f'joint "{joint.name}"'
        if joint.name in self._joints:
            raise ModelError(who, "the name is taken; names of joints are unique")
        joint = replace(joint, axis=unit(vector(joint.axis, who), who))
        self._joints[joint.name] = joint
        return joint

    def couple(self, joint: str | Joint, to: str | Joint, ratio: Any = 1, offset: Any = 0) -> None:
        """Let one joint follow another: ``q_joint = ratio q_to + offset``.

        The follower has no coordinate and no effort of its own.

        Raises:
            ModelError: the joint follows another already.
        """
        follower, master = (j.name if isinstance(j, Joint) else j for j in (joint, to))
        who = f'joint "{follower}"'
        if follower in self._couplings:
            raise ModelError(who, "is coupled twice")
        finite((ratio, offset), who)
        self._couplings[follower] = Coupling(follower, master, ratio, offset)

    def lock(self, joint: str, value: float = 0.0) -> None:
        """Weld a joint of one freedom at a value of its coordinate (rad or m).

        What follows the locked joint is locked with it.

        Raises:
            ModelError: no such joint, or it has no coordinate or more than one.
        """
        who = f'joint "{joint}"'
        if joint not in self._joints:
            raise ModelError(who, f"there is no such joint to lock; {nearest(joint, self._joints)}")
        found = self._joints[joint]
        if found.freedoms != 1:
            raise ModelError(who, f"is {found.kind}; only joints of one freedom can be locked")
        finite((value,), who)
        self._couplings.pop(joint, None)
        self._weld(found, value)
        for coupling in list(self.couplings):
            if coupling.master == joint:
                self.lock(coupling.joint, coupling.ratio * value + coupling.offset)

    def _weld(self, joint: Joint, value: float) -> None:
        """Replace a joint by a fixed one at its tail frame moved by `value`."""
        from linegraph.kinematics import moved

        tail, head = joint.between
        terminals = self.terminals()
        if tail not in terminals:
            who = f'joint "{joint.name}"'
            raise ModelError(who, f'there is no body or frame "{tail}"; {nearest(tail, terminals)}')
        body, placement = terminals[tail]
        frame = f"{joint.name}.locked"
        terminal = self.add_frame(body, frame, moved(placement, joint, value, self.snap))
        self._joints[joint.name] = Fixed(joint.name, (terminal, head))

    def terminals(self) -> dict[str, tuple[str, Placement]]:
        """Every terminal a joint may be connected to: its body and its placement there.

        Raises:
            ModelError: two terminals have the same name.
        """
        found = {GROUND: (GROUND, Placement(ZERO, IDENTITY_MATRIX))}

        def add(terminal: str, body: str, placement: Placement) -> None:
            if terminal in found:
                raise ModelError(f'terminal "{terminal}"', "two frames have this name; rename one")
            found[terminal] = (body, placement)

        for name, placement in self.ground_frames.items():
            add(f"{GROUND}.{name}", GROUND, placement)
        for body in self.bodies.values():
            add(body.name, body.name, Placement(ZERO, IDENTITY_MATRIX))
            for name, placement in body.frames.items():
                add(f"{body.name}.{name}", body.name, placement)
        for name in self.bodies:
            if f"{name}.{MASS_CENTER}" in found:
                problem = f'is the name of the mass centre of "{name}"; rename a body or frame'
                raise ModelError(f'terminal "{name}.{MASS_CENTER}"', problem)
        return found

    def graph(self) -> SystemGraph:
        """The system graph: the union of all terminal graphs.

        Raises:
            ModelError: a joint names a terminal that does not exist, or connects a body to itself.
        """
        terminals = self.terminals()
        for joint in self.joints:
            who = f'joint "{joint.name}"'
            for terminal in joint.between:
                if terminal not in terminals:
                    hint = nearest(terminal, terminals)
                    raise ModelError(who, f'there is no body or frame "{terminal}"; {hint}')
            if len({terminals[terminal][0] for terminal in joint.between}) == 1:
                raise ModelError(who, f'connects body "{terminals[joint.between[0]][0]}" to itself')
        return unite(
            [self._ground_edges(), *(b.edges() for b in self.bodies.values()), self._joint_edges()]
        )

    def _ground_edges(self) -> list[Edge]:
        return [
            Edge(f"{GROUND}/arm.{frame}", GROUND, domain, GROUND, f"{GROUND}.{frame}")
            for domain in (TRANSLATION.name, ROTATION.name)
            for frame in self.ground_frames
        ]

    def _joint_edges(self) -> list[Edge]:
        return [
            Edge(joint.name, joint.name, domain, *joint.between)
            for domain in (TRANSLATION.name, ROTATION.name)
            for joint in self.joints
        ]
