"""The components of 1-D rotation: X is an angular velocity (rad/s), Y a torque (N m)."""

from linegraph.components.domains import ROTATION_1D
from linegraph.components.scalar.mechanical import Damper1D, Friction1D, Inertia1D
from linegraph.components.scalar.stores import Spring1D
from linegraph.components.scalar.twins import Twins

_types = Twins(ROTATION_1D, __name__)

Inertia = _types.of(
    Inertia1D,
    "inertia",
    "An inertia that turns: ``Y = d/dt (inertia X)``. One of its ends is ground, against which it turns.",
    inertia="kg m^2.",
)
RotationalSpring = _types.of(
    Spring1D,
    "rotational_spring",
    "A spring in 1-D rotation: ``dY/dt = stiffness X``, Y the torque that it is pressed together with.",
)
RotationalDamper = _types.of(
    Damper1D,
    "rotational_damper",
    "A viscous damper in 1-D rotation: ``Y = damping X``.",
    damping="N m s/rad.",
)
RotationalFriction = _types.of(
    Friction1D,
    "rotational_friction",
    "Friction in 1-D rotation: ``Y = viscous X + coulomb tanh(X / width)``.",
    viscous="N m s/rad.",
    coulomb="what dry friction takes in motion (N m).",
    width="the rate at which dry friction has risen to 76 % (rad/s).",
)
TorqueSource = _types.through_source("torque_source", "torque")
AngularVelocitySource = _types.across_source("angular_velocity_source", "velocity")
