"""The builder of models: the only mutable type, which readers, macros and users fill."""

from __future__ import annotations

from collections import ChainMap
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from linegraph.components.body import GROUND, MASS_CENTER, Body, inertia_of, unit
from linegraph.components.constraints import Blade, Constraint, Driver, Rod, Rolling, aligned
from linegraph.components.constraints.relation import Relation
from linegraph.components.forces import Damper, Drag, Element, Friction, Law, Load, Spring, Stop
from linegraph.components.forces.load import BODY, WORLD
from linegraph.components.joints import (
    Compound,
    Cylindrical,
    Fixed,
    Free,
    Helical,
    Joint,
    Planar,
    Prismatic,
    Revolute,
    Spherical,
    Universal,
)
from linegraph.components.parameters import Input, Parameter, is_number, names_in
from linegraph.components.scalar import Words
from linegraph.components.validation import finite, plain, require_new, require_symbols, vector
from linegraph.errors import ModelError
from linegraph.model.body_handle import BodyHandle, Force, Kind, Limit
from linegraph.model.bounds import Bounded
from linegraph.model.builder_words import Shown, Terminal, adds, applies, constrains, pushes
from linegraph.model.choices import Choices, chosen
from linegraph.model.coupling import Coupling
from linegraph.model.macros import Macros, followers_at, locked
from linegraph.model.outputs import Output
from linegraph.model.snapshot import Snapshots
from linegraph.spatial.vector import ZERO, Vector

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.components.forces import PointForce
    from linegraph.spatial.placement import Placement

STANDARD_GRAVITY: Vector = (0, 0, -9.81)
SNAP = 1e-11


class Model(Shown, Words, Macros, Bounded, Snapshots):
    """A system of components, connected at terminals, under construction.

    Args:
        name: the prefix of everything emitted.
        gravity: acceleration of free fall in ground axes (m/s²).
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
        """Start with ground and no other component."""
        self.name, self.about, self.snap = name, about, snap
        self.gravity = gravity
        self.bodies: dict[str, Body] = {}
        self.ground = BodyHandle(self, GROUND)
        self.ground_frames: dict[str, Placement] = {}
        self.parameters: dict[str, Parameter] = {}
        self._inputs: dict[str, Input] = {}
        self._elements: dict[str, Element | PointForce] = {}
        self._constraints: dict[str, Constraint | Relation] = {}
        self.choices = Choices()
        self.outputs: list[Output] = []
        self.warnings: list[str] = []
        self.source: str | None = None  # the file, and its lines by thing, for errors found later
        self.places: dict[str, int] = {}
        self._joints: dict[str, Joint] = {}
        self._couplings: dict[str, Coupling] = {}
        self._components = {}
        self.domains = {}

    spring = applies(Spring)
    damper = applies(Damper)
    friction = applies(Friction)
    stop = applies(Stop)
    law = applies(Law)
    drag = pushes(Drag)

    rod = constrains(Rod)
    driver = constrains(Driver)
    rolling = constrains(Rolling)
    blade = constrains(Blade)

    revolute = adds(Revolute)
    prismatic = adds(Prismatic)
    helical = adds(Helical)
    cylindrical = adds(Cylindrical)
    universal = adds(Universal)
    planar = adds(Planar)
    spherical = adds(Spherical)
    free = adds(Free)
    compound = adds(Compound)
    fixed = adds(Fixed)

    @property
    def gravity(self) -> Vector:
        """Acceleration of free fall in ground axes (m/s²); may be set, also to parameters."""
        return self._gravity

    @gravity.setter
    def gravity(self, acceleration: Sequence[Any]) -> None:
        self._gravity = vector(acceleration, "gravity")

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints in declared order, which is the order of coordinates."""
        return tuple(self._joints.values())

    @property
    def couplings(self) -> tuple[Coupling, ...]:
        """The coupled joints in declared order."""
        return tuple(self._couplings.values())

    def parameter(self, name: str, value: Any = None, unit: str = "", about: str = "") -> Parameter:
        """Declare a number that stays a symbol, or one that is computed from earlier ones.

        Args:
            name: unique among parameters, and not a reserved word such as t or pi.
            value: the default; or an expression of earlier parameters, as text or SymPy's, which is
                computed wherever the name is used.
            unit: its unit, for readers.
            about: its meaning, for readers.

        Raises:
            ModelError: the name is taken or reserved, or the expression names something else.
        """
        require_new(name, self.parameters, who := f'parameter "{name}"')
        require_symbols((name,), who)
        if value is not None:
            finite((value,), who)
            for used in sorted(names_in(value) - self.parameters.keys()):
                raise ModelError(who, f"depends on {used}, which is no earlier parameter")
        return self.parameters.setdefault(name, Parameter(name, value, unit, about))

    def input(self, name: str, unit: str = "", about: str = "") -> Input:
        """Declare an input u for use in laws of forces and components.

        Args:
            name: unique among inputs, and not a reserved word.
            unit: its unit, for readers.
            about: its meaning, for readers.

        Raises:
            ModelError: the name is taken or reserved.
        """
        require_new(name, self._inputs, who := f'input "{name}"')
        require_symbols((name,), who)
        return self._inputs.setdefault(name, Input(name, None, unit, about))

    @property
    def inputs(self) -> tuple[Input, ...]:
        """The declared inputs, in order."""
        return tuple(self._inputs.values())

    @property
    def force_elements(self) -> tuple[Element | PointForce, ...]:
        """The force elements and loads in declared order."""
        return tuple(self._elements.values())

    @property
    def constraints(self) -> tuple[Constraint, ...]:
        """The constraints with edges in declared order."""
        return tuple(c for c in self._constraints.values() if isinstance(c, Constraint))

    @property
    def relations(self) -> tuple[Relation, ...]:
        """The constraints between velocities in declared order."""
        return tuple(c for c in self._constraints.values() if isinstance(c, Relation))

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
            mass: in kg.
            mass_center: in the body's frame (m); by default its origin.
            inertia: (xx, yy, zz), a 3 x 3 matrix or named entries (kg m²), in body axes, about the mass
                centre; about the body's origin where `first_moment` is given.
            first_moment: mass times mass centre (kg m), instead of `mass_center`.

        Raises:
            ModelError: the name is taken, a number is not finite, or the mass is negative.
        """
        who = f'body "{name}"'
        taken = "the name is taken; names of bodies are unique"
        require_new(name, ChainMap[str, Any](self.bodies, {GROUND: self.ground}), who, taken)
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
        """Add a frame to a body or to ground, as `BodyHandle.frame` does more conveniently.

        Args:
            body: name of the body, or "ground".
            name: unique on it.
            placement: the frame in the body's frame.

        Returns:
            The terminal, ``"body.frame"``.

        Raises:
            ModelError: the name is taken on this body.
        """
        who = f'frame "{body}.{name}"'
        frames = self.ground_frames if body == GROUND else self.bodies[body].frames
        require_new(name, (*frames, MASS_CENTER), who, "the name is taken on this body")
        if body == GROUND:
            self.ground_frames[name] = placement
        else:
            self.bodies[body] = replace(self.bodies[body], frames={**frames, name: placement})
        return f"{body}.{name}"

    def add_joint(self, joint: Kind) -> Kind:
        """Add a joint that has been constructed elsewhere; ``model.revolute(...)`` is more convenient.

        Raises:
            ModelError: the name is taken or the axis has no length.
        """
        who = f'joint "{joint.name}"'
        require_new(joint.name, self._edges, who, "the name is taken; names of joints are unique")
        require_symbols((quantity.name for quantity in joint.positions()), who)
        joint = replace(joint, axis=unit(vector(joint.axis, who), who))
        joint.require_start()
        self._joints[joint.name] = joint
        return joint

    def load(
        self,
        name: str,
        at: Terminal,
        force: Sequence[Any] = ZERO,
        torque: Sequence[Any] = ZERO,
        axes: str = WORLD,
    ) -> Load:
        """Apply a force and a torque to a body, from ground; see `Load`.

        Args:
            name: unique among joints and elements.
            at: the terminal; the force acts at its origin.
            force: three expressions (N).
            torque: three expressions (N m).
            axes: in which both are resolved, those of ground ("world") or of the terminal ("body").
        """
        who = f'load "{name}"'
        if axes not in (WORLD, BODY):
            raise ModelError(who, f'axes are "{WORLD}" or "{BODY}", not "{axes}"')
        load = Load(name, str(at), vector(force, who), vector(torque, who), axes)
        return self.add_element(load)

    def add_element(self, element: Force) -> Force:
        """Add a force element that has been constructed elsewhere; ``model.spring(...)`` is more convenient.

        Raises:
            ModelError: the name is taken, or the element has neither ends nor a joint, or both.
        """
        who = f'{element.kind} "{element.name}"'
        taken = "the name is taken; names of joints and elements are unique"
        require_new(element.name, self._edges, who, taken)
        if isinstance(element, Element) and (element.between is None) == (element.joint is None):
            raise ModelError(who, "give either between=(tail, head) or joint=...")
        finite(element.values(), who)
        self._elements[element.name] = element
        return element

    @property
    def _edges(self) -> ChainMap[str, Any]:
        return ChainMap[str, Any](self._elements, self._joints, self._constraints, self._components)

    def relation(self, name: str, rate: Any) -> Relation:
        """Constrain velocities by an expression that is zero and linear in rates; see `Relation`.

        Args:
            name: unique among joints, elements and constraints; its multiplier has it.
            rate: ``a(q) v - b(q, t)`` with rates written as ``der(x)``.
        """
        return self.add_constraint(Relation(name, rate))

    def add_constraint(self, limit: Limit) -> Limit:
        """Add a constraint that has been constructed elsewhere; ``model.rod(...)`` is more convenient.

        Raises:
            ModelError: the name is taken.
        """
        who = f'{limit.kind} "{limit.name}"'
        taken = "the name is taken; joints, elements and constraints share names"
        require_new(limit.name, self._edges, who, taken)
        finite(limit.values(), who)
        found: Limit = aligned(limit, who)
        self._constraints[limit.name] = found
        return found

    def output(self, name: str, value: Any, unit: str = "", about: str = "") -> Output:
        """Let emitted code return a quantity by name.

        Args:
            name: unique among outputs.
            value: an expression; `dynamics.outputs` lists the variables that it may name.
            unit: its unit, for readers.
            about: its meaning, for readers.

        Raises:
            ModelError: the name is taken or reserved.
        """
        require_new(name, [known.name for known in self.outputs], f'output "{name}"')
        require_symbols((name,), f'output "{name}"')
        self.outputs.append(Output(name, value, unit, about))
        return self.outputs[-1]

    def formulation(self, **choices: Any) -> Choices:
        """Choose the tree, the coordinates and the axes of results; see `Choices`.

        Raises:
            ModelError: there is no such kind of coordinates or of axes.
        """
        self.choices = chosen(self.choices, **choices)
        return self.choices

    def couple(self, joint: str | Joint, to: str | Joint, ratio: Any = 1, offset: Any = 0) -> None:
        """Let one joint follow another: ``q_joint = ratio q_to + offset``.

        The follower has neither a coordinate nor an effort of its own.

        Args:
            joint: the follower, of one freedom.
            to: the joint that it follows, of one freedom.
            ratio: dimensionless between joints of the same kind, else rad/m or m/rad.
            offset: in the unit of the follower's coordinate (rad or m).

        Raises:
            ModelError: the joint already follows another.
        """
        follower, master = (j.name if isinstance(j, Joint) else j for j in (joint, to))
        who = f'joint "{follower}"'
        if follower in self._couplings:
            raise ModelError(who, "is coupled twice")
        finite((ratio, offset), who)
        self._couplings[follower] = Coupling(follower, master, ratio, offset)

    def lock(self, joint: str, value: float = 0.0) -> None:
        """Weld a joint of one freedom at a value of its coordinate, and with it all that follow it.

        Args:
            joint: name of the joint.
            value: of its coordinate (rad or m).

        Raises:
            ModelError: no such joint, or it has no coordinate or more than one.
        """
        self._couplings.pop(joint, None)
        self._joints[joint] = locked(self, joint, value)
        for follower, at in followers_at(self, joint, value):
            self.lock(follower, at)
