"""Emitted functions for identification: the regressor, and the model's own standard parameters.

τ = Y(q, v, a) π with π the standard parameters of all links and joints [Atkeson et al. 1986].
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.algebra.protocol import set_label
from linegraph.algebra.residues import CONSTANT
from linegraph.components.parameters import resolver
from linegraph.components.scalar.forces import forces_of
from linegraph.dynamics.applied_forces import depends_on_inputs, exerted
from linegraph.dynamics.network_state import RESTING
from linegraph.identification.regressor import Columns, Station, by_motions, by_wrenches
from linegraph.identification.standard_parameters import (
    axes,
    friction_values,
    homes,
    led_by,
    link_values,
    quantities,
)
from linegraph.identification.tied_columns import tied, ties
from linegraph.ir.program import (
    Argument,
    Listing,
    Program,
    Result,
    Routine,
    assemble,
    operations_of,
)
from linegraph.kinematics.working_frames import DUST
from linegraph.spatial.placement import compose, inverse

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.identification.standard_parameters import Axis, Bearings
    from linegraph.programs.workspace import Workspace

REGRESSOR, VALUES = "regressor", "inertial_parameters"
COUNT = "NPI"


def regressor_program(f: Workspace) -> tuple[Program | Routine, ...]:
    """The regressor Y of ``τ = Y π``, and the rest of τ that no parameter of π causes, if there is any."""
    if not f.tree.links:
        return ()
    split = _Split(f)
    rows = split.rows()
    entries = tuple(entry for row in rows for entry in row)
    shape = (len(rows), len(rows[0]))
    results = [Result("Y", shape, entries, "regressor: tau by each parameter of pi")]
    rest = split.rest()
    about = (
        "Regressor Y(q, v, a) of inverse dynamics, tau = Y pi: pi are the standard parameters as "
        f"{VALUES} lists them."
    )
    if any(x != 0 for x in rest):
        text = "what of tau no parameter of pi makes"
        results.append(Result("rest", (len(rest),), tuple(rest), text))
        about = about.replace("tau = Y pi:", "tau = Y pi + rest:")
    return (f.program(REGRESSOR, about, ("q", "v", "a"), tuple(results)),)


def values_program(f: Workspace) -> tuple[Program | Routine, ...]:
    """The standard parameters π of the model itself."""
    if not f.tree.links:
        return ()
    values = tuple(_Split(f).values())
    about = (
        "Standard parameters pi of the model's own numbers: of each link mass, first moment of mass and "
        "inertia about the origin of its body, then damping, friction and rotor inertia of joints."
    )
    result = Result("pi", (len(values),), values, "standard parameters")
    given = tuple(Argument("p", None, f.texts["p"]) for name in f.head if name == "p")
    return (assemble(VALUES, about, given, (result,)),)


def listings(f: Workspace, chosen: Sequence[str]) -> tuple[Listing, ...]:
    """The names and units of the entries of π.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made.
    """
    if not f.tree.links or not {REGRESSOR, VALUES} & {*chosen}:
        return ()
    named = quantities(f.tree)
    heading = "standard parameters of links and joints"
    return (Listing("pi", COUNT, heading, named, ("pi",)),)


class _Split:
    """Inverse dynamics split into a part linear in π, and the rest."""

    def __init__(self, f: Workspace) -> None:
        self._f = f
        self._axes = axes(f.tree)
        self._a = f.symbols("a")

    def rows(self) -> list[list[Scalar]]:
        """Y, one row per velocity."""
        f = self._f
        count = 10 * len(f.tree.links)
        rows: list[list[Scalar]] = [[0] * (count + 3 * len(self._axes)) for _ in range(len(f.v))]
        for i, columns in enumerate(self._columns()):
            for k, entries in columns.items():
                rows[k][10 * i : 10 * i + 10] = entries
        for n, axis in enumerate(self._axes):
            set_label(f.dag, f"parameters of joint {axis.joint}")
            rate = axis.rate(f.v)
            width = resolver(f.dag, f.tree.parameters)(axis.width)
            units = (rate, f.dag.function("tanh", rate / width), axis.rate(self._a))
            for freedom in axis.row:
                for place, unit in enumerate(units, count + 3 * n):
                    rows[freedom.index][place] = freedom.ratio * unit
        return rows

    def _columns(self) -> list[Columns]:
        """Y by the cheapest of all combinations of route, working frames and shared sums."""
        f = self._f
        own = [home.pose for home in homes(f.tree)]
        walk = [Station(i, pose) for i, pose in enumerate(own)]
        short = f.shortened
        there = [
            Station(place, compose(inverse(moved), pose, DUST))
            for pose, place, moved in zip(own, short.places, short.poses, strict=True)
        ]
        every = ties(f.derivation, f.tree, folded="p" not in f.head)
        cheap = [tie for tie in every if tie.cheap]
        found = []
        for state, stations in ((f.state, walk), (f.working, there)):
            for route in (by_motions, by_wrenches):
                columns = route(state, stations, self._a)
                found += [columns, tied(columns, cheap), tied(columns, every)]
        return min(found, key=_cost)

    # -- values

    @cached_property
    def _bearings(self) -> Bearings:
        """Friction of joints, apart from springs, loads and other elements."""
        f = self._f
        system = f.tree.system
        passive = [e for e in system.force_elements if not depends_on_inputs(system, e.values())]
        return friction_values(f.tree, passive)

    @cached_property
    def _stored(self) -> tuple[dict[str, Scalar], list[tuple[int, int, Scalar]]]:
        """Entries of networks in the mass matrix: rotor inertias of joints by name, then all others."""
        f = self._f
        known = {axis.joint: axis for axis in self._axes}
        armature: dict[str, Scalar] = dict.fromkeys(known, 0)
        rest: list[tuple[int, int, Scalar]] = []
        if f.networks is None:
            return armature, rest
        network = f.networks.network
        first = len(network.states)
        joints = {e.name: e.joint for e in forces_of(f.tree.system.components)}
        set_label(f.dag, "network, what it stores")
        for (i, j), entry in network.mass.items():
            value = f.networks.still(entry)
            kinds = {symbol[0] for symbol in network.laws.calculus.support(entry)}
            if i == j >= first and kinds <= {"p", CONSTANT}:
                seat = _seat(f, known, joints[network.ports[i - first].name])
                if seat is not None:
                    axis, ratio = seat
                    armature[axis.joint] = armature[axis.joint] + ratio * ratio * value
                    continue
            for row, left in f.networks.projected(i):
                for column, right in f.networks.projected(j):
                    rest.append((row, column, left * right * value))
        return armature, rest

    def values(self) -> list[Scalar]:
        """The values of π."""
        f = self._f
        values = link_values(f.tree)
        for axis in self._axes:
            found = (self._bearings.damping, self._bearings.friction, self._stored[0])
            values += [part[axis.joint] for part in found]
        return values

    # -- the remainder

    def rest(self) -> list[Scalar]:
        """The part of τ from springs, loads, networks and other elements."""
        f = self._f
        total: list[Scalar] = [0] * len(f.v)
        others = [*self._bearings.others]
        if others or f.tree.network is not None:
            acting = [*others, *forces_of(f.tree.system.components)]
            total = [-x for x in f.along(exerted(f.chords, acting, RESTING))]
        for row, column, entry in self._stored[1]:
            total[row] = total[row] + entry * self._a[column]
        return total


def _seat(f: Workspace, known: dict[str, Axis], joint: str | None) -> tuple[Axis, Scalar] | None:
    if joint is None:
        return None
    return (known[joint], 1) if joint in known else led_by(f.tree, known, joint)


def _cost(columns: list[Columns]) -> int:
    entries = tuple(x for found in columns for row in found.values() for x in row)
    return operations_of((Result("Y", (len(entries),), entries, ""),))
