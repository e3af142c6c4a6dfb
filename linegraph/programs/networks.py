"""Emitted functions that networks add: algebraic loops, and the derivative of the whole state at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.dag import Node
from linegraph.ir.program import Argument, Check, Listing, Program, Quantity, Result, Routine
from linegraph.ir.statuses import NO_LOOP_SOLUTION, SINGULAR_NETWORK
from linegraph.programs.workspace import LOOP_FUNCTION

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.kinematics.links import KinematicTree
    from linegraph.programs.workspace import Workspace


def algebraic_loop(f: Workspace) -> tuple[Program | Routine, ...]:
    """The residual of the algebraic loop with its Jacobian, and the solver by Newton's method."""
    if f.networks is None or not f.networks.network.loop:
        return ()
    network = f.networks.network
    f.dag.label = "network, algebraic loop"
    residual = tuple(f.networks.still(r) for r in network.eased)
    slopes = tuple(f.networks.still(e) for row in network.eased_jacobian for e in row)
    terms = tuple(f.networks.still(e) for e in network.loop_sizes)
    size = len(residual)
    results = (
        Result("r", (size,), residual, "what is zero at the solution"),
        Result("K", (size, size), slopes, "its derivative by the unknowns"),
        Result("s", (size,), terms, "size of its terms, to judge what is rounding"),
    )
    equations = f.program(
        "loop_equations",
        "Equations of the network's algebraic loop, for given unknowns and with resistances at its laws.",
        (*f.loop_arguments, "ease"),
        results,
    )
    given = tuple(a for a in equations.arguments if a.name not in ("loop", "ease"))
    solver = Routine(
        LOOP_FUNCTION,
        "Solve the network's algebraic loop by Newton's method with halved steps; where that fails, with "
        "resistances at its laws that vanish step by step.",
        given,
        (Result("loop", (size,), (), "unknowns of the algebraic loop"),),
        "newton",
        (NO_LOOP_SOLUTION,),
        ("loop_equations",),
        (("size", size),),
    )
    return equations, solver


def checks(f: Workspace) -> tuple[Check, ...]:
    """Checks that no divisor in the network's static laws is zero."""
    if f.networks is None:
        return ()
    sizes = dict.fromkeys(
        f.dag.function("abs", f.networks.still(pivot)) for pivot in f.networks.network.pivots
    )
    return tuple(Check(size, 0, *SINGULAR_NETWORK) for size in sizes if isinstance(size, Node))


def remarks(f: Workspace, chosen: Sequence[str]) -> tuple[str, ...]:
    """Sign conventions and properties of networks, as remarks in the head of a file.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made; not used.
    """
    if f.tree.network is None:
        return ()
    text = (
        "Edges of networks: the across variable is the potential of the tail less that of the head, the "
        "through variable flows through the component from tail to head; their product is what it takes in. "
        "States of networks stand in v behind the velocities, and M and h are widened by their rows."
    )
    found = [f"{remark[0].upper()}{remark[1:]}." for remark in f.tree.network.remarks]
    return (text, *([" ".join(found)] if found else []))


def rhs(f: Workspace) -> tuple[Program | Routine, ...]:
    """Derivative ẋ of the whole state x = (q, v), for integrators."""
    n, m = len(f.q), len(f.v)
    arguments = (*f.head, "u")
    given = [Argument(a, f.sizes.get(a), f.texts[a]) for a in arguments]
    given.insert(len(f.head), Argument("x", n + m, "the whole state (q, v)"))
    return (
        Routine(
            "rhs",
            "Right-hand side of xdot = f(x, u, t), for integrators: coordinate rates, then forward dynamics.",
            tuple(given),
            (Result("xdot", (n + m,), (), "derivative of x"),),
            "rhs",
            (),
            ("coordinate_rates", "forward_dynamics"),
        ),
    )


def listings(f: Workspace, chosen: Sequence[str]) -> tuple[Listing, ...]:
    """The names of the entries of x, if `rhs` is made.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made.
    """
    return (state_listing(f.tree),) if "rhs" in chosen else ()


def state_listing(tree: KinematicTree) -> Listing:
    """The names of the entries of x: coordinates, then velocities, with _dot after a coordinate's name."""
    positions = [quantity.name for quantity in tree.positions]
    rates = tuple(
        Quantity(f"{q.name}_dot" if q.name in positions else q.name, q.unit, q.about)
        for q in tree.velocities
    )
    quantities = (*tree.positions, *rates)
    return Listing("state", "NS", "states, x = (q, v)", quantities, ("x", "xdot"), shown=False)
