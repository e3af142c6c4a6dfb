"""Emitted functions of the inverse scheme: every variable of every edge of the system graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.dynamics.edge_quantities import (
    across_groups,
    across_quantities,
    network_powers,
    network_quantities,
    powers,
    reaction_axes,
    reaction_groups,
    reaction_quantities,
)
from linegraph.ir.program import (
    Argument,
    Call,
    Guards,
    Listing,
    Program,
    Quantity,
    Result,
    Routine,
    reads,
)
from linegraph.kinematics.state_layout import EFFORT_UNITS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.programs.workspace import Workspace


def across(f: Workspace) -> tuple[Program | Routine, ...]:
    """Velocity and angular velocity across every joint, body, element and constraint, in ground axes."""
    entries = tuple(
        x
        for linear, angular in f.edges.across().values()
        for part in (linear, angular)
        for x in part
    )
    entries += tuple(x for x, _ in f.edges.network().values())
    about = (
        "Across variables: velocity and angular velocity of the head of every edge less its tail's"
        f"{', then those of networks, tail over head' * (f.networks is not None)}."
    )
    result = Result("X", (len(entries),), entries, "across variables, in ground axes")
    if reads("a", (result,)):
        return (_after_dynamics(f, "across", about, (result,)),)
    return (f.program("across", about, ("q", "v"), (result,)),)


_THROUGH = (
    " Then what flows through every edge of networks; what they exert on joints and points is in power, and "
    "in outputs where these ask for it."
)


def reactions(f: Workspace) -> tuple[Program | Routine, ...]:
    """The wrench of every joint and constraint on its head: for given accelerations, and for given inputs."""
    names = _joints(f)
    entries: list[Scalar] = []
    for name in names:
        force, torque = f.edges.reaction(name)
        entries += [*force, *torque]
    entries += [y for _, y in f.edges.network().values()]
    if not entries:
        return ()
    result = Result("R", (len(entries),), tuple(entries), "reactions")
    given = ("q", "v", "a", "lam") if f.tree.closed else ("q", "v", "a")
    about = (
        "Reactions: the force and the torque, about the origin of its head frame, that every joint exerts on "
        f"its head, efforts included, for given accelerations{' and multipliers' * f.tree.closed}."
        f"{_THROUGH * (f.networks is not None)}"
    )
    at = f.program("reactions_at", about, given, (result,))
    arguments = ("q", "v", "u")
    taken = tuple(Argument(x, f.sizes.get(x), f.texts[x]) for x in (*f.head, *arguments))
    under = Routine(
        "reactions",
        "Reactions under the inputs u: forward dynamics, then reactions_at.",
        taken,
        (Result("R", result.shape, (), result.about),),
        "after_dynamics",
        (),
        ("forward_dynamics", "reactions_at"),
        (("then", "reactions_at"),),
    )
    return at, under


def drives(f: Workspace) -> tuple[Program | Routine, ...]:
    """The driving forces and torques of joints with prescribed motion."""
    found = f.edges.drives()
    if not found:
        return ()
    result = Result("D", (len(found),), tuple(found.values()), "driving forces and torques")
    about = "Driving forces: the effort that each prescribed coordinate takes, under the inputs u."
    return (_after_dynamics(f, "drives", about, (result,)),)


def power(f: Workspace) -> tuple[Program | Routine, ...]:
    """Through times across of every edge (W), and its sums over each subspace, which are zero."""
    found, sums = powers(f.edges.edges())
    more, domains = network_powers(f.tree.network, f.edges.network())
    found |= more
    sums = (*sums, *domains.values())
    meaning = ", ".join(["translation", "rotation with levers", *domains])
    results = (
        Result("P", (len(found),), tuple(found.values()), "power that each edge delivers (W)"),
        Result("sums", (len(sums),), sums, f"sums over {meaning}: zero (W)"),
    )
    about = (
        "Power audit: through times across of every edge, and the sums that the principle of orthogonality "
        "makes zero, a check at run time."
    )
    return (_after_dynamics(f, "power", about, results),)


def outputs(f: Workspace) -> tuple[Program | Routine, ...]:
    """The named outputs of the model."""
    if not f.tree.system.outputs:
        return ()
    entries, dynamic = f.outputs
    result = Result("y", (len(entries),), tuple(entries), "outputs")
    dynamic = dynamic or reads("a", (result,))
    about = "Outputs: the quantities that the model asks for by name."
    if dynamic:
        return (_after_dynamics(f, "outputs", about, (result,)),)
    return (f.program("outputs", about, ("q", "v"), (result,)),)


def listings(f: Workspace, chosen: Sequence[str]) -> tuple[Listing, ...]:
    """The names of all results of these functions.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made.
    """
    return tuple(x for key, of in _LISTINGS.items() if key in chosen for x in of(f))


def _of_across(f: Workspace) -> tuple[Listing, ...]:
    names = list(f.edges.across())
    heading = "across variables: of each edge velocity and angular velocity x, y, z, in ground axes"
    more = network_quantities(f.tree.system, f.tree.network, 0)
    quantities = (*across_quantities(names), *more)
    groups = (*across_groups(names), *((quantity, 1) for quantity in more))
    heading += "; of edges of networks one" * bool(more)
    return (Listing("across", "NX", heading, quantities, ("X",), groups),)


def _of_reactions(f: Workspace) -> tuple[Listing, ...]:
    names, more = _joints(f), network_quantities(f.tree.system, f.tree.network, 1)
    if not (names or more):
        return ()
    quantities = (*reaction_quantities(f.tree.system, names), *more)
    groups = (*reaction_groups(names), *((quantity, 1) for quantity in more))
    axes = reaction_axes(f.tree.system)
    heading = f"reactions: of each joint force and torque x, y, z on its head, in {axes} axes"
    heading += "; of edges of networks what flows through" * bool(more)
    return (Listing("reaction", "NR", heading, quantities, ("R",), groups),)


def _of_drives(f: Workspace) -> tuple[Listing, ...]:
    driven = f.edges.drives()
    if not driven:
        return ()
    known = {q.name: q for joint in f.tree.system.joints for q in joint.velocities()}
    quantities = tuple(
        Quantity(name, EFFORT_UNITS[known[name].unit], f"drives {name}") for name in driven
    )
    return (Listing("drive", "ND", "driving forces", quantities, ("D",)),)


def _of_power(f: Workspace) -> tuple[Listing, ...]:
    names = list(powers(f.edges.edges())[0])
    names += list(network_powers(f.tree.network, f.edges.network())[0])
    quantities = tuple(Quantity(name, "W", f"power of {name}") for name in names)
    return (Listing("power", "NE", "powers", quantities, ("P",)),)


def _of_outputs(f: Workspace) -> tuple[Listing, ...]:
    asked = f.tree.system.outputs
    quantities = tuple(Quantity(o.name, o.unit, o.about or str(o.value)) for o in asked)
    return (Listing("output", "NY", "outputs", quantities, ("y",)),) if asked else ()


_LISTINGS = {
    "across": _of_across,
    "reactions": _of_reactions,
    "drives": _of_drives,
    "power": _of_power,
    "outputs": _of_outputs,
}
"""For each function, the names of its results."""


def _joints(f: Workspace) -> list[str]:
    """Joints and constraints, all of which have reactions."""
    return list(f.tree.ends)


def _after_dynamics(f: Workspace, name: str, about: str, results: tuple[Result, ...]) -> Program:
    """A function that first calls forward dynamics for v̇ and λ."""
    solved = [Argument("a", len(f.v), f.texts["a"])]
    if f.tree.closed:
        solved.append(Argument("lam", len(f.constraint_equations), f.texts["lam"]))
    call = Call("forward_dynamics", (*f.head, "q", "v", "u"), tuple(solved))
    return f.program(name, about, ("q", "v", "u"), results, Guards(calls=(call,), status=True))
