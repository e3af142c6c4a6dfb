"""Which functions are compared at states that violate the constraints.

On the constraints an error can hide. In a parallelogram two angles are always equal, so reading one in
place of the other changes nothing there. Functions that involve bodies alone hold at any q and v, and are
therefore compared at states off the constraints. Functions that involve the constraints (J, γ and all that
is solved with them) hold on the constraints only and are compared there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.verification.golden.point import Point
    from linegraph.verification.golden.reference import Reference
    from linegraph.verification.golden.walk import Valued

ANYWHERE = (
    "mass_matrix",
    "bias",
    "equations",
    "inverse_dynamics",
    "coordinate_rates",
    "energy",
    "inverse_dynamics_derivatives",
    "inverse_dynamics_parameter_derivatives",
    "center_of_mass",
    "center_of_mass_velocity",
    "center_of_mass_jacobian",
    "momentum",
    "centroidal_momentum_matrix",
    "centroidal_momentum_bias",
    "kinematics",
    "regressor",
    "inertial_parameters",
)
"""Functions of the bodies alone; they hold at any coordinates and velocities."""

OF_FRAMES = ("_pose", "_velocity", "_jacobian", "_jacobian_dot_v")
"""Endings of the names of a frame's functions that hold at any coordinates and velocities."""


def beside(label: str, reference: Reference) -> Reference:
    """Move a function's comparison off the constraints, if its results hold there.

    Args:
        label: key of the reference in the register, mostly the function's name.
        reference: the reference at states on the constraints.

    Returns:
        A reference with arguments ``q_off``, ``v_off`` and results evaluated there; `reference` itself for
        functions that involve the constraints.
    """
    if label not in ANYWHERE and not (label.startswith("frame_") and label.endswith(OF_FRAMES)):
        return reference
    given = {"q": "q_off", "v": "v_off"} | dict(reference.given)
    results = {name: _beside(made) for name, made in reference.results.items()}
    return reference._replace(
        given=given, results=results, route=f"{reference.route}; beside the constraints"
    )


def _beside(made: Callable[[Point], Valued]) -> Callable[[Point], Valued]:
    """Evaluate a result at the point's coordinates and velocities off the constraints."""

    def found(point: Point) -> Valued:
        return made(point.beside)

    found.__name__ = f"{made.__name__}_beside"
    return found
