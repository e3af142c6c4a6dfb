"""Register of references: by which independent route the results of each emitted function are computed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.golden_vectors import RETURNED
from linegraph.verification.golden.constraints import MISSES, Constraints
from linegraph.verification.golden.derivatives import Derivatives
from linegraph.verification.golden.operational import Operational
from linegraph.verification.golden.reference import After, Reference

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from linegraph.kinematics.frame_trees import NamedFrame
    from linegraph.verification.golden.point import Point
    from linegraph.verification.golden.walk import Valued

NEWTON_EULER = "Newton's and Euler's equations of every body, from derivatives of its position"
SOLVED = f"{NEWTON_EULER}; solved by NumPy with pivots"
ROWS = "the constraints, differentiated along the motion of the bodies"
BESIDE = f"{NEWTON_EULER}, calculated a complex step beside the state"
PLACES = "where the bodies are, differentiated along the motion"
CUT = "each joint cut, Newton's and Euler's equations of all bodies beyond"
MOMENTA = "the momentum of every body"


def _M(point: Point) -> Valued:
    return point.bodies.mass_matrix


def _h(point: Point) -> Valued:
    return point.bodies.bias


def _tau(point: Point) -> Valued:
    return point.inverse


def _a(point: Point) -> Valued:
    return point.motion[0]


def _lam(point: Point) -> Valued:
    return point.motion[1]


def _qdot(point: Point) -> Valued:
    return point.walk.rates


def _E(point: Point) -> Valued:
    return point.bodies.energy


def _xdot(point: Point) -> Valued:
    return point.whole


def _phi(point: Point) -> Valued:
    return Constraints(point.at(point.q_off, point.v)).position


def _J(point: Point) -> Valued:
    return point.closed.jacobian


def _rates(point: Point) -> Valued:
    return Constraints(point.at(point.q, point.v_off)).rates


def _gam(point: Point) -> Valued:
    return point.closed.bias


def _f(point: Point) -> Valued:
    return point.force


def _gam_stabilised(point: Point) -> Valued:
    return point.stabilised


def _T(point: Point) -> Valued:
    return point.reduction[0]


def _rest(point: Point) -> Valued:
    return point.reduction[1]


def _Mr(point: Point) -> Valued:
    return point.reduced[0]


def _hr(point: Point) -> Valued:
    return point.reduced[1]


def _q_on(point: Point) -> Valued:
    q = point.walk.np.array(point.q)
    return q, 1 + abs(q)


def _v_on(point: Point) -> Valued:
    np = point.walk.np
    (_, of_T), v = point.reduction[0], np.array(point.v)
    return v, np.abs(v) + of_T @ np.abs(point.w)


def _of_slopes(name: str, key: str) -> Callable[[Point], Valued]:
    """Return a function that reads one property of `Derivatives`; `name` becomes the key of its values."""

    def made(point: Point) -> Valued:
        return getattr(point.seen(Derivatives), key)  # type: ignore[no-any-return]

    made.__name__ = name
    return made


_A = _of_slopes("_A", "state_by_state")
_B = _of_slopes("_B", "state_by_inputs")
_dtau_dq = _of_slopes("_dtau_dq", "tau_by_changes")
_dtau_dv = _of_slopes("_dtau_dv", "tau_by_velocities")
_dtau_dp = _of_slopes("_dtau_dp", "tau_by_parameters")
_da_dq = _of_slopes("_da_dq", "motion_by_changes")
_da_dv = _of_slopes("_da_dv", "motion_by_velocities")
_da_du = _of_slopes("_da_du", "motion_by_inputs")
_da_dp = _of_slopes("_da_dp", "motion_by_parameters")


def _com(point: Point) -> Valued:
    return point.kinematics.com


def _com_velocity(point: Point) -> Valued:
    return point.kinematics.com_velocity


def _Jcom(point: Point) -> Valued:
    return point.kinematics.com_jacobian


def _hg(point: Point) -> Valued:
    return point.kinematics.momentum


def _Ag(point: Point) -> Valued:
    return point.kinematics.momentum_matrix


def _Agdot_v(point: Point) -> Valued:
    return point.kinematics.momentum_rate


def _Y(point: Point) -> Valued:
    return point.parameters.regressor


def _pi(point: Point) -> Valued:
    return point.parameters.values


def _rest_of_tau(point: Point) -> Valued:
    return point.parameters.rest


def _R(point: Point) -> Valued:
    return point.edges.reactions


def _R_at(point: Point) -> Valued:
    return point.edges_at.reactions


def _X(point: Point) -> Valued:
    dynamic = point.derivation.formulation.network is not None
    return (point.edges if dynamic else point.edges_at).across


def _D(point: Point) -> Valued:
    return point.edges.drives


def _P(point: Point) -> Valued:
    return point.edges.powers


def _sums(point: Point) -> Valued:
    return point.edges.sums


def _y(point: Point) -> Valued:
    return point.outputs


def _v_kept(point: Point) -> Valued:
    v = point.walk.np.array(point.v)
    return v, abs(v) + point.projected[1]


def _v_projected(point: Point) -> Valued:
    return point.projected


def _no_gap(point: Point) -> Valued:
    value, size = point.closed.position
    return 0 * value, size + MISSES * abs(value).max(initial=0.0)


def _no_slip(point: Point) -> Valued:
    value, size = point.closed.rates
    return 0 * value, size + MISSES * abs(value).max(initial=0.0)


REFERENCES: dict[str, Reference] = {
    "mass_matrix": Reference(NEWTON_EULER, {"M": _M}),
    "bias": Reference(NEWTON_EULER, {"h": _h}),
    "equations": Reference(NEWTON_EULER, {"M": _M, "h": _h}),
    "inverse_dynamics": Reference(f"{NEWTON_EULER}; M a + h", {"tau": _tau}),
    "constraints": Reference(
        "where the bodies are, off the constraints", {"phi": _phi}, {"q": "q_off"}
    ),
    "constraint_jacobian": Reference(ROWS, {"J": _J}),
    "constraint_rates": Reference(f"{ROWS}, for any v", {"rates": _rates}, {"v": "v_off"}),
    "constraint_bias": Reference(f"{ROWS}, twice", {"gam": _gam}),
    "constrained_equations": Reference(
        f"{NEWTON_EULER}; {ROWS}", {"M": _M, "f": _f, "J": _J, "gam": _gam_stabilised}
    ),
    "forward_dynamics": Reference(SOLVED, {"a": _a, "lam": _lam}),
    "coordinate_rates": Reference("the algebra of quaternions", {"qdot": _qdot}),
    "energy": Reference("masses, velocities and heights of the bodies", {"E": _E}),
    "rhs": Reference(SOLVED, {"xdot": _xdot}),
    "across": Reference(PLACES, {"X": _X}),
    "reactions_at": Reference(CUT, {"R": _R_at}),
    "reactions": Reference(f"{CUT}; accelerations {SOLVED}", {"R": _R}),
    "drives": Reference(f"{CUT}; accelerations {SOLVED}", {"D": _D}),
    "power": Reference(f"{CUT}; through times across; sums are zero", {"P": _P, "sums": _sums}),
    "outputs": Reference(f"{CUT}; {PLACES}; the model's own expressions", {"y": _y}),
    "project": Reference(
        "the state itself, which obeys the constraints", {"q_on": _q_on, "v_on": _v_kept}
    ),
    "project_velocities": Reference(
        f"{ROWS}; the change of least kinetic energy, solved by NumPy",
        {"q_on": _q_on, "v_on": _v_projected},
        {"v": "v_off"},
        "project",
    ),
    "project_beside": Reference(
        "no gap and no slip remains, by the functions that are compared themselves",
        {},
        {"q": "q_off", "v": "v_off"},
        "project",
        (
            After("constraints", {"phi": _no_gap}, {"q": f"{RETURNED}q_on"}),
            After(
                "constraint_rates",
                {"rates": _no_slip},
                {"q": f"{RETURNED}q_on", "v": f"{RETURNED}v_on"},
            ),
        ),
    ),
    "complete": Reference(
        "the state itself, from coordinates beside it and its own independent ones",
        {"q_on": _q_on, "v_on": _v_on},
        {"q": "q_near"},
    ),
    "reduction": Reference(f"{ROWS}; solved by NumPy", {"T": _T, "rest": _rest}),
    "reduced_equations": Reference(f"{SOLVED}, {ROWS}", {"Mr": _Mr, "hr": _hr}),
    "linearize": Reference(f"{BESIDE}; solved by NumPy", {"A": _A, "B": _B}),
    "inverse_dynamics_derivatives": Reference(
        BESIDE, {"dtau_dq": _dtau_dq, "dtau_dv": _dtau_dv, "dtau_da": _M}
    ),
    "forward_dynamics_derivatives": Reference(
        f"{BESIDE}; solved by NumPy", {"da_dq": _da_dq, "da_dv": _da_dv, "da_du": _da_du}
    ),
    "inverse_dynamics_parameter_derivatives": Reference(BESIDE, {"dtau_dp": _dtau_dp}),
    "forward_dynamics_parameter_derivatives": Reference(
        f"{BESIDE}; solved by NumPy", {"da_dp": _da_dp}
    ),
    "center_of_mass": Reference("masses and places of the bodies", {"com": _com}),
    "center_of_mass_velocity": Reference(MOMENTA, {"com_velocity": _com_velocity}),
    "center_of_mass_jacobian": Reference(MOMENTA, {"Jcom": _Jcom}),
    "momentum": Reference(MOMENTA, {"hg": _hg}),
    "centroidal_momentum_matrix": Reference(MOMENTA, {"Ag": _Ag}),
    "centroidal_momentum_bias": Reference(NEWTON_EULER, {"Agdot_v": _Agdot_v}),
    "regressor": Reference(
        "Newton's and Euler's equations of bodies with one moment of 1 and no other; what is left of M a + h",
        {"Y": _Y, "rest": _rest_of_tau},
    ),
    "inertial_parameters": Reference(
        "moments of the bodies as given, moved and summed; what dampers and frictions say",
        {"pi": _pi},
    ),
}
"""The functions that are compared; a new function is added by one entry here."""

WHOLE = ("com", "com_velocity", "Jcom", "hg", "Ag", "Agdot_v")
"""Results that `kinematics` returns for the whole system, also returned by functions of their own."""


def references(frames: Iterable[NamedFrame] = ()) -> dict[str, Reference]:
    """Return the register, extended by the functions of some frames.

    Args:
        frames: the frames whose functions are emitted.

    Returns:
        References by label; `kinematics` returns the results of all frames and of the whole system.
    """
    found = dict(REFERENCES)
    together = {
        name: made for reference in REFERENCES.values() for name, made in reference.results.items()
    }
    together = {name: together[name] for name in WHOLE}
    for frame in frames:
        found |= _of_frame(frame)
        for key in ("position", "rotation", "velocity", "jacobian", "jacobian_dot_v"):
            together[f"{frame.identifier}_{key}"] = _in_place(frame, key)
    found["kinematics"] = Reference(f"{PLACES}; {MOMENTA}", together)
    return found


def _of_frame(frame: NamedFrame) -> dict[str, Reference]:
    """References of the functions of one frame."""

    def place(key: str) -> Callable[[Point], Valued]:
        return _in_place(frame, key)

    def moved(rows: int) -> Reference:
        known = (("Lambda", "inertia"), ("mu", "bias"), ("Jbar", "inverse"))
        results = {name: _operational(frame, rows, key) for name, key in known}
        return Reference(f"{PLACES}; {SOLVED}", results)

    name = f"frame_{frame.identifier}"
    return {
        f"{name}_pose": Reference(
            "where the bodies are",
            {"position": place("position"), "rotation": place("rotation")},
        ),
        f"{name}_velocity": Reference(PLACES, {"velocity": place("velocity")}),
        f"{name}_jacobian": Reference(PLACES, {"J": place("jacobian")}),
        f"{name}_jacobian_dot_v": Reference(
            f"{PLACES}, twice", {"Jdot_v": place("jacobian_dot_v")}
        ),
        f"{name}_operational_space": moved(6),
        f"{name}_operational_position": moved(3),
    }


def _in_place(frame: NamedFrame, key: str) -> Callable[[Point], Valued]:
    """Return a function that reads one result of a frame: a method of `KinematicReference`."""

    def made(point: Point) -> Valued:
        return getattr(point.kinematics, key)(frame.name)  # type: ignore[no-any-return]

    made.__name__ = f"frame_{frame.identifier}_{key}"
    return made


def _operational(frame: NamedFrame, rows: int, key: str) -> Callable[[Point], Valued]:
    """Return a function that reads one result in operational space: a property of `Operational`."""

    def made(point: Point) -> Valued:
        return getattr(Operational(point, frame.name, rows), key)  # type: ignore[no-any-return]

    made.__name__ = f"frame_{frame.identifier}_{key}_{rows}"
    return made
