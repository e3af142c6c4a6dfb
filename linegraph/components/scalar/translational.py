"""The components of 1-D translation: X is a velocity (m/s), Y a force (N)."""

from linegraph.components.domains import TRANSLATION_1D
from linegraph.components.scalar.mechanical import Damper1D, Friction1D, Inertia1D
from linegraph.components.scalar.stores import Spring1D
from linegraph.components.scalar.twins import Twins

_types = Twins(TRANSLATION_1D, __name__)

Mass = _types.of(
    Inertia1D,
    "mass",
    "A mass that slides: ``Y = d/dt (mass X)``. One of its ends is ground, against which it moves.",
    mass="kg.",
)
TranslationalSpring = _types.of(
    Spring1D,
    "translational_spring",
    "A spring in 1-D translation: ``dY/dt = stiffness X``, Y the force that it is pressed together with.",
)
TranslationalDamper = _types.of(
    Damper1D,
    "translational_damper",
    "A viscous damper in 1-D translation: ``Y = damping X``.",
    damping="N s/m.",
)
TranslationalFriction = _types.of(
    Friction1D,
    "translational_friction",
    "Friction in 1-D translation: ``Y = viscous X + coulomb tanh(X / width)``.",
    viscous="N s/m.",
    coulomb="what dry friction takes in motion (N).",
    width="the rate at which dry friction has risen to 76 % (m/s).",
)
ForceSource = _types.through_source("force_source", "force")
VelocitySource = _types.across_source("velocity_source", "velocity")
