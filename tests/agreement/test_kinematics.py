"""Emitted kinematics of random systems against the oracles: every kind of joint, motion and coordinate.

The oracles give every body's motion; what is expected of frames, of the centre of mass and of momentum is
summed here from those, body by body. Where coordinates are measured from ground, what is emitted is held
against differences along a motion. More systems with ``--all-forms``.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from agreement.test_closed_loops import model_of as closed_model
from oracles import closed_systems as closed
from oracles import newton_euler as oracle
from support.dag_values import values
from support.emitted import load
from support.spec_models import model_of as tree_model
from systems import random_mixed as mixed
from systems import random_systems as systems
from systems import random_trees as trees

from linegraph import ModelError, derive
from linegraph.emission.emit import render
from linegraph.kinematics.frame_trees import NamedFrame
from linegraph.programs.kinematics import OF_FRAMES, RESULTS, both
from linegraph.programs.workspace import Workspace
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from linegraph import Model

STEWART = "examples/stewart_platform/stewart_platform.toml"
EXACT = 1e-12  # relative to 1 + the largest expected entry; measured 9e-15
SOLVED = 1e-10  # of Lambda, mu and Jbar, times the condition of J M^-1 J^T beyond 100
DIFFERENCES = 1e-8  # measured 3e-11
WHOLE = (
    "center_of_mass",
    "center_of_mass_velocity",
    "center_of_mass_jacobian",
    "momentum",
    "centroidal_momentum_matrix",
    "centroidal_momentum_bias",
)
OF_FRAME = [result for results in OF_FRAMES.values() for result in results]
FOURTH = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}
"""Weights of a difference of the fourth order."""


def error(found: Any, expected: Any) -> float:
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    assert found.shape == expected.shape
    return float(np.max(np.abs(found - expected)) / (1 + np.max(np.abs(expected))))


# ---- what is expected, from motions of bodies


@dataclass(frozen=True)
class Moving:
    """A frame's motion: Jacobians of the free velocities, velocities and accelerations at v' = 0."""

    rotation: np.ndarray
    origin: np.ndarray
    jacobian: np.ndarray
    velocity: np.ndarray
    bias: np.ndarray

    @property
    def expected(self) -> dict[str, np.ndarray]:
        """By the names that `kinematics` gives them."""
        return {
            "position": self.origin,
            "rotation": self.rotation,
            "velocity": self.velocity,
            "jacobian": self.jacobian,
            "jacobian_dot_v": self.bias,
        }


Mass = tuple[float, np.ndarray, Moving]
"""A body's mass, its inertia about its mass centre and in its axes, and how its mass centre moves."""


def whole(bodies: Iterable[Mass]) -> dict[str, np.ndarray]:
    """Centre of mass and momentum of some bodies: sums of m r, m v, and moments of these."""
    bodies = list(bodies)
    mass = sum(m for m, _, _ in bodies)
    com = sum(m * b.origin for m, _, b in bodies) / mass
    parts = []
    for m, inertia, b in bodies:
        tensor = b.rotation @ inertia @ b.rotation.T
        lever = oracle.skew(b.origin - com)
        spin = b.velocity[3:]
        gyroscopic = np.cross(spin, tensor @ spin)

        def moment(
            x: np.ndarray, m: float = m, tensor: np.ndarray = tensor, lever: np.ndarray = lever
        ) -> np.ndarray:
            """Momentum of a body that moves with x, about the centre of mass."""
            return np.concatenate((m * x[:3], tensor @ x[3:] + lever @ (m * x[:3])))

        bias = moment(b.bias) + np.concatenate((np.zeros(3), gyroscopic))
        parts.append((moment(b.velocity), moment(b.jacobian), bias))
    hg, Ag, Agdot_v = (sum(part) for part in zip(*parts, strict=True))
    return {
        "com": com,
        "com_velocity": hg[:3] / mass,
        "Jcom": Ag[:3] / mass,
        "hg": hg,
        "Ag": Ag,
        "Agdot_v": Agdot_v,
    }


def of_oracle(motion: oracle.Motion, v: np.ndarray, a: np.ndarray, own: np.ndarray) -> Moving:
    """A motion of the Newton-Euler oracle; in `a` only what is prescribed accelerates."""
    jacobian = np.concatenate((motion.linear, motion.angular))
    bias = np.concatenate((motion.linear_bias, motion.angular_bias))
    return Moving(
        motion.rotation, motion.origin, jacobian[:, own], jacobian @ v, bias + jacobian @ a
    )


# ---- emitted code


def emitted(
    model: Model, folder: Path, frames: list[str], more: tuple[str, ...] = (), **options: Any
) -> Any:
    only = ("coordinate_rates", "equations", "frames", *WHOLE, "kinematics", *more)
    files = render(model, name="model", languages=["python"], only=only, frames=frames, **options)
    return load(files, "model", folder)


def call(module: Any, name: str, given: Mapping[str, Any]) -> Any:
    """A function with those arguments that it takes."""
    function = getattr(module, name)
    return function(*(given[key] for key in inspect.signature(function).parameters))


def separately(module: Any, frames: Iterable[str], given: Mapping[str, Any]) -> list[np.ndarray]:
    """All results, each of its own function, in the order of `kinematics`."""
    found = []
    for frame in frames:
        found += call(module, f"frame_{frame}_pose", given)
        found += [
            call(module, f"frame_{frame}_{function}", given)
            for function in ("velocity", "jacobian", "jacobian_dot_v")
        ]
    return found + [call(module, function, given) for function in WHOLE]


def compare(
    module: Any,
    frames: Mapping[str, Moving],
    bodies: Iterable[Mass],
    given: Mapping[str, Any],
    what: Any,
) -> None:
    """Every function against what is expected, and `kinematics` too."""
    expected = [x for moving in frames.values() for x in moving.expected.values()]
    expected += whole(bodies).values()
    for found in (separately(module, frames, given), call(module, "kinematics", given)):
        for result, truth in zip(found, expected, strict=True):
            assert error(result, truth) < EXACT, what


def operational(
    J: np.ndarray, bias: np.ndarray, M: np.ndarray, h: np.ndarray
) -> tuple[tuple[np.ndarray, ...], float]:
    """Lambda, mu and Jbar, and the condition of what Lambda is the inverse of."""
    solved = np.linalg.solve(M, J.T)
    inverse = J @ solved
    found = np.linalg.inv(inverse)
    return (found, found @ (solved.T @ h - bias), solved @ found), float(np.linalg.cond(inverse))


# ---- trees of every kind of joint, couplings, prescribed motion


def frames_of(system: systems.System, draw: np.random.Generator) -> dict[str, str]:
    """By their names in emitted code: a body, a frame of one, and a mass centre."""
    bodies = [body.name for body in system.model.bodies.values()]
    body = str(draw.choice(bodies))
    frames = [name for name in system.model.terminals() if name.startswith("body") and "." in name]
    found = [body, f"{body}.mass_center"]
    found += [str(draw.choice(frames))] if frames else []
    return {name.replace(".", "_"): name for name in found}


@pytest.mark.seeds(range(0, 48, 8), range(100))
def test_random_systems_agree_with_newton_euler(seed: int, tmp_path: Path) -> None:
    system = systems.random_system(seed)
    model = system.model
    draw = np.random.default_rng([seed, 5])
    names = frames_of(system, draw)
    module = emitted(model, tmp_path, list(names.values()))
    _, own = system.places()
    count = len(system.effort_places)
    for _ in range(3):
        state = systems.draw_state(draw, system)
        _, v, a = state.whole
        named = [state.u[name] for name in module.U_NAMES[count:]]
        given = {
            "p": getattr(module, "DEFAULT_PARAMETERS", None),
            "t": state.t,
            "q": state.q,
            "v": state.v,
            "u": np.concatenate((np.zeros(count), named)),
        }
        moving = {}
        for called, name in names.items():
            if name.endswith(".mass_center"):
                body = model.bodies[name.removesuffix(".mass_center")]
                at, axes = np.array(body.center, dtype=float), np.eye(3)
            else:
                _, placement = model.terminals()[name]
                at, axes = (np.array(x, dtype=float) for x in placement)
            motion = state.rigid.motions[model.terminals()[name.removesuffix(".mass_center")][0]]
            frame = oracle.carried(motion, v, at, axes)
            moving[called] = of_oracle(frame, v, a, own)
        masses = []
        for body in system.tree.bodies:
            center = oracle.carried(state.rigid.motions[body.name], v, body.mass_center, np.eye(3))
            if center.linear.any() or center.angular.any():
                masses.append((body.mass, body.inertia, of_oracle(center, v, a, own)))
        compare(module, moving, masses, given, seed)


@pytest.mark.seeds((2, 18), range(60))
def test_operational_space_of_random_trees(seed: int, tmp_path: Path) -> None:
    """Six rows where a frame can move in all directions, three where it has three at least."""
    draw = np.random.default_rng(seed)
    tree = trees.random_tree(draw, bodies=5 + seed % 5, kinds=("revolute", "revolute", "free"))
    last = tree.bodies[-1].name
    q, v = trees.random_state(draw, tree)
    reach = oracle.body_motions(tree, q, v)[last]
    full = np.linalg.matrix_rank(np.concatenate((reach.linear, reach.angular))) == 6
    functions = (("operational_position", 3), *((("operational_space", 6),) * bool(full)))
    if np.linalg.matrix_rank(reach.linear) < 3:
        with pytest.raises(ModelError, match="cannot move along"):
            emitted(tree_model(tree), tmp_path, [last], ("operational_position",))
        return
    module = emitted(tree_model(tree), tmp_path, [last], tuple(name for name, _ in functions))
    for _ in range(4):
        q, v = trees.random_state(draw, tree)
        motion = oracle.body_motions(tree, q, v)[last]
        J = np.concatenate((motion.linear, motion.angular))
        bias = np.concatenate((motion.linear_bias, motion.angular_bias))
        M, h = oracle.mass_matrix(tree, q, v), oracle.bias(tree, q, v)
        for name, rows in functions:
            expected, condition = operational(J[:rows], bias[:rows], M, h)
            if condition > 1e6:
                continue
            found = getattr(module, f"frame_{last}_{name}")(q, v)
            limit = SOLVED * max(1.0, condition / 100)
            for result, truth in zip(found, expected, strict=True):
                assert error(result, truth) < limit
            Lambda, _, Jbar = found
            one = Lambda @ J[:rows] @ np.linalg.solve(M, J[:rows].T)
            assert error(one, np.eye(rows)) < limit
            assert error(J[:rows] @ Jbar, np.eye(rows)) < limit


# ---- closed loops: J is that of the tree's own v


@pytest.mark.seeds((1, 21), range(60))
def test_closed_systems_agree_with_the_motions_of_their_trees(seed: int, tmp_path: Path) -> None:
    system = closed.random_system(seed)
    name = system.bodies[-1].name
    module = emitted(closed_model(system, "model"), tmp_path, [name])
    chart = closed.chart(system, module.Q_NAMES, module.V_NAMES)
    draw = np.random.default_rng(seed)
    units, none = np.eye(chart.nv), np.zeros(chart.nv)
    for _ in range(2):
        q, v = chart.normalised(draw.normal(size=module.NQ)), draw.normal(size=chart.nv)
        columns = [chart.motions(q, unit, none) for unit in units]

        def seen(
            of: Callable[[dict[str, closed.Motion]], closed.Motion],
            columns: list[dict[str, closed.Motion]] = columns,
            now: dict[str, closed.Motion] = chart.motions(q, v, none),  # noqa: B008
        ) -> Moving:
            """One frame's motion, its Jacobian from that at unit velocities."""
            motion = of(now)
            parts = [of(column) for column in columns]
            jacobian = np.array([[*part.velocity, *part.spin] for part in parts]).T
            velocity = np.concatenate((motion.velocity, motion.spin))
            bias = np.concatenate((motion.acceleration, motion.spin_rate))
            return Moving(motion.rotation, motion.origin, jacobian, velocity, bias)

        masses = []
        for k, body in enumerate(system.bodies):
            center = seen(lambda motions, k=k: closed.centers(system, motions)[k])
            if center.jacobian.any():
                masses.append((body.mass, body.inertia, center))
        given = {"q": q, "v": v}
        compare(module, {name: seen(lambda motions: motions[name])}, masses, given, seed)


def spatial(seed: int) -> Model:
    """A random closed system."""
    return closed_model(closed.random_system(seed), "model")


CLOSED = {
    "stewart_platform": (lambda: modelfile.read(STEWART), "platform", 6),
    "spatial loop": (lambda: spatial(27), "b3", 3),
    "two spatial loops": (lambda: spatial(32), "b5", 3),
}


@pytest.mark.parametrize("case", CLOSED)
def test_operational_space_with_loops(case: str, tmp_path: Path) -> None:
    """Against forces on the frame put into the equations with multipliers, solved as they stand."""
    make, frame, rows = CLOSED[case]
    model = make()
    function = {6: "operational_space", 3: "operational_position"}[rows]
    more = ("constraints", "project", function)
    module = emitted(model, tmp_path, [frame], more)
    assembly, draw = derive(model).assembled, np.random.default_rng(1)
    given: dict[str, Any] = {"p": getattr(module, "DEFAULT_PARAMETERS", None), "t": 0.0}
    for _ in range(3):
        given["q"] = np.array(assembly.q) + 0.02 * draw.normal(size=module.NQ)
        given["v"] = draw.normal(size=module.NV)
        given["u"] = np.zeros(module.NU)
        given["q"], given["v"] = call(module, "project", given)
        M, h = call(module, "equations", given)
        Jc, gam = call(module, "constraint_jacobian", given), call(module, "constraint_bias", given)
        J = call(module, f"frame_{frame}_jacobian", given)[:rows]
        rate = call(module, f"frame_{frame}_jacobian_dot_v", given)[:rows]
        whole_matrix = np.block([[M, -Jc.T], [Jc, np.zeros((len(Jc), len(Jc)))]])

        def moves(
            force: np.ndarray,
            whole_matrix: np.ndarray = whole_matrix,
            h: np.ndarray = h,
            gam: np.ndarray = gam,
            J: np.ndarray = J,
            rate: np.ndarray = rate,
        ) -> np.ndarray:
            """The frame's acceleration under a force on it."""
            right = np.concatenate((J.T @ force - h, gam))
            solved = np.linalg.lstsq(whole_matrix, right, rcond=1e-12)[0]
            return np.asarray(J @ solved[: len(h)] + rate)

        Lambda, mu, Jbar = call(module, f"frame_{frame}_{function}", given)
        for force in (np.zeros(rows), *draw.normal(size=(3, rows))):
            assert error(Lambda @ moves(force) + mu, force) < 1e-9
        assert error(J @ Jbar, np.eye(rows)) < 1e-9
        assert np.max(np.abs(Jc @ Jbar)) < 1e-9 * (1 + np.max(np.abs(Jbar)))


# ---- networks beside mechanics: their states add columns of zeros


@pytest.mark.seeds((0, 14), range(40))
def test_states_of_networks_move_no_frame(seed: int, tmp_path: Path) -> None:
    system = mixed.random_system(seed)
    model = mixed.model_of(system)
    name = system.tree.bodies[-1].name
    module = emitted(model, tmp_path, [name])
    draw = np.random.default_rng(seed)
    states = mixed.draw_states(draw, system, 2)
    own = system.places()
    for k, (q, v, a) in enumerate(states.whole):
        z = draw.normal(size=module.NV - len(own))
        u = [states.u[name][k] if name in states.u else 0.0 for name in module.U_NAMES]
        given = {
            "p": getattr(module, "DEFAULT_PARAMETERS", None),
            "t": float(states.t[k]),
            "q": states.q[k],
            "v": np.concatenate((states.v[k], z)),
            "u": np.array(u),
        }
        motions = oracle.body_motions(system.tree, q, v)

        def widened(
            motion: oracle.Motion,
            v: np.ndarray = v,
            a: np.ndarray = a,
            z: np.ndarray = z,
        ) -> Moving:
            found = of_oracle(motion, v, a, own)
            jacobian = np.hstack((found.jacobian, np.zeros((6, len(z)))))
            return Moving(found.rotation, found.origin, jacobian, found.velocity, found.bias)

        masses = []
        for body in system.tree.bodies:
            center = oracle.carried(motions[body.name], v, body.mass_center, np.eye(3))
            if center.linear.any() or center.angular.any():
                masses.append((body.mass, body.inertia, widened(center)))
        compare(module, {name: widened(motions[name])}, masses, given, seed)


# ---- coordinates measured from ground: differences along a motion


def moved(module: Any, given: dict[str, Any], a: np.ndarray, time: float) -> dict[str, Any]:
    """The state after a short time at constant a, by one step of Runge and Kutta."""

    def rates(q: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.asarray(call(module, "coordinate_rates", {**given, "q": q, "v": v}))

    q, v = given["q"], given["v"]
    middle, last = v + time / 2 * a, v + time * a
    k1 = rates(q, v)
    k2 = rates(q + time / 2 * k1, middle)
    k3 = rates(q + time / 2 * k2, middle)
    k4 = rates(q + time * k3, last)
    return {**given, "q": q + time / 6 * (k1 + 2 * k2 + 2 * k3 + k4), "v": last}


@pytest.mark.parametrize("coordinates", ["joint", "absolute", "absolute-angle"])
@pytest.mark.seeds((2, 18), range(40))
def test_results_are_derivatives_of_each_other(seed: int, coordinates: str, tmp_path: Path) -> None:
    """Of closed systems too: the tree's own motion is asked for, whatever the loops allow."""
    system = closed.random_system(seed)
    model = closed_model(system, "model")
    model.formulation(coordinates=coordinates)
    name = system.bodies[-1].name
    try:
        derivation = derive(model)
    except ModelError:
        pytest.skip("no such coordinates here")
    module = emitted(model, tmp_path, [name])
    draw, step = np.random.default_rng(seed), 1e-3
    q, v, a = draw.normal(size=module.NQ), *draw.normal(size=(2, module.NV))
    q = list(q)
    derivation.structure.normalise(q)
    given = {"q": np.array(q), "v": v}

    def at(time: float) -> dict[str, np.ndarray]:
        there = moved(module, given, a, time)
        values = separately(module, [name], there)
        keys = ("position", "rotation", "velocity", "J", "Jdot_v", "com", "vcom", "Jcom")
        return dict(zip((*keys, "hg", "Ag", "Agdot_v"), values, strict=True))

    here, around = at(0.0), {k: at(k * step) for k in FOURTH}
    rate = {
        key: sum(weight / step * around[k][key] for k, weight in FOURTH.items()) for key in here
    }
    spin = oracle.skew(here["velocity"][3:]) @ here["rotation"]
    assert error(rate["position"], here["velocity"][:3]) < DIFFERENCES
    assert error(rate["rotation"], spin) < DIFFERENCES
    assert error(rate["velocity"], here["J"] @ a + here["Jdot_v"]) < DIFFERENCES
    assert error(rate["com"], here["vcom"]) < DIFFERENCES
    assert error(rate["hg"], here["Ag"] @ a + here["Agdot_v"]) < DIFFERENCES
    assert error(here["J"] @ v, here["velocity"]) < EXACT
    assert error(here["Jcom"] @ v, here["vcom"]) < EXACT
    assert error(here["Ag"] @ v, here["hg"]) < EXACT
    together = call(module, "kinematics", given)
    for found, alone in zip(together, here.values(), strict=True):
        assert error(found, alone) < EXACT


# ---- the ways among which the shortest is chosen


@pytest.mark.parametrize("coordinates", ["joint", "absolute", "absolute-angle"])
@pytest.mark.parametrize("seed", [1, 6, 12])
def test_all_ways_lead_to_the_same(seed: int, coordinates: str) -> None:
    """Whichever is emitted: by columns, in ground axes, in the links' own, with and without the axes."""
    model = closed_model(closed.random_system(seed), "model")
    model.formulation(coordinates=coordinates)
    frame = NamedFrame("last", next(reversed(model.bodies)))
    f = Workspace(derive(model), True, (frame,))
    sources = [*both(f, (frame,)), *both(f, (frame,), whole=True)]
    draw = np.random.default_rng(seed)
    q, v = draw.normal(size=len(f.q)).tolist(), draw.normal(size=len(f.v)).tolist()
    f.tree.normalise(q)
    for result in RESULTS:
        key = (result, "last" if result in OF_FRAME else "")
        ways = [way for source in sources if source.has(*key) for way in source.ways(*key)]
        found = [values(way, {"q": q, "v": v}) for way in ways]
        assert len(found) >= 2
        assert max(error(other, found[0]) for other in found[1:]) < EXACT, result
