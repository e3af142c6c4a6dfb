"""Functions that are compared beside the constraints: what vanishes on these is not seen on them.

In a parallelogram two angles are always equal, and where one is read in place of the other nothing changes.
Functions of bodies alone are right at any coordinates and velocities, and are asked there. What constraints
make of velocities and accelerations (J and γ) is right where these hold, and is asked there.
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
"""What knows of bodies, and of no constraint."""

OF_FRAMES = ("_pose", "_velocity", "_jacobian", "_jacobian_dot_v")
"""How the names of such functions of frames end."""


def beside(label: str, reference: Reference) -> Reference:
    """The same beside the constraints; what knows of constraints as it is."""
    if label not in ANYWHERE and not (label.startswith("frame_") and label.endswith(OF_FRAMES)):
        return reference
    given = {"q": "q_off", "v": "v_off"} | dict(reference.given)
    results = {name: _beside(made) for name, made in reference.results.items()}
    return reference._replace(
        given=given, results=results, route=f"{reference.route}; beside the constraints"
    )


def _beside(made: Callable[[Point], Valued]) -> Callable[[Point], Valued]:
    """What gives a result where loops are not closed."""

    def found(point: Point) -> Valued:
        return made(point.beside)

    found.__name__ = f"{made.__name__}_beside"
    return found
