"""Identify the base parameters of an arm of three joints from a simulated experiment.

    python examples/identification/identify.py [--plot identification.png]

An exciting motion is chosen, a controller makes the arm follow it (simulated, with friction and the rotors of
geared motors), positions and torques are measured with noise, and weighted least squares give the base
parameters with intervals of confidence. Another motion shows how well torques are predicted.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from linegraph import Model, derive

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from linegraph import BaseParameters, Derivation

Array = Any

PERIOD = 5.0  # s, of the motions
HARMONICS = 5
LIMIT = np.array([1.2, 0.8, 1.0])  # rad, how far each joint may go from the middle
MIDDLE = np.array([0.0, 0.4, -0.8])  # rad
FASTEST = 2.5  # rad/s
STEP = 0.002  # s, of the simulation and of the measurement
SETTLED = 1.0  # s, after which the arm moves periodically
PERIODS = 2  # that are measured
STIFFNESS = np.array([4000.0, 4000.0, 1500.0])  # N m/rad, of the controller
DAMPING = np.array([200.0, 200.0, 75.0])  # N m s/rad
NOISE_Q = 1e-6  # rad, of encoders
NOISE_TAU = np.array([0.5, 0.8, 0.3])  # N m, of torques from motor currents
BAND = 40.0  # Hz, of what is believed of the motion
SIGMAS = 3.5  # half the width of an interval of confidence: 99.95 %


def arm() -> Model:
    """Waist, shoulder and elbow, with bodies that are not symmetric, friction, and rotors behind gears."""
    model = Model("arm")
    column = model.body("column", mass=8.0, mass_center=(0.02, 0.01, 0.2), inertia=(0.2, 0.2, 0.1))
    upper = model.body(
        "upper",
        mass=6.0,
        mass_center=(0.18, 0.01, 0.03),
        inertia=((0.03, 0.004, -0.006), (0.004, 0.17, 0.002), (-0.006, 0.002, 0.18)),
    )
    lower = model.body(
        "lower",
        mass=3.5,
        mass_center=(0.15, -0.02, 0.01),
        inertia=((0.012, 0.003, 0.001), (0.003, 0.07, -0.002), (0.001, -0.002, 0.075)),
    )
    model.revolute("waist", ("ground", column), axis=(0, 0, 1))
    model.revolute("shoulder", (column.frame("top", (0.05, 0.1, 0.4)), upper), axis=(0, 1, 0))
    model.revolute("elbow", (upper.frame("end", (0.4, -0.05, 0)), lower), axis=(0, 1, 0))
    drives = (
        ("waist", 2e-4, 80, 3.0, 4.0),
        ("shoulder", 2e-4, 100, 4.0, 5.0),
        ("elbow", 8e-5, 80, 1.5, 2.0),
    )
    for joint, inertia, ratio, viscous, coulomb in drives:
        # a rotor on a shaft, a gear, and the shaft that turns as the joint does
        fast, slow = f"{joint}_fast", f"{joint}_slow"
        model.inertia(f"{joint}_rotor", (fast, "ground"), inertia=inertia)
        model.gear(f"{joint}_gear", (fast, "ground"), (slow, "ground"), ratio=ratio)
        model.rotational_interface(f"{joint}_shaft", (slow, "ground"), joint=joint)
        model.friction(
            f"{joint}_friction", joint=joint, viscous=viscous, coulomb=coulomb, width=0.1
        )
    return model


@dataclass(frozen=True)
class Motion:
    """A Fourier series for each joint: ``q = middle + sum_k a_k sin(k w t) + b_k cos(k w t)``.

    Attributes:
        sines, cosines: harmonics x joints, in rad.
    """

    sines: Array
    cosines: Array

    def at(self, t: Array) -> tuple[Array, Array, Array]:
        """q, v and a, times x joints."""
        w = 2 * np.pi / PERIOD * np.arange(1, HARMONICS + 1)
        angle = np.multiply.outer(t, w)
        s, c = np.sin(angle), np.cos(angle)
        q = MIDDLE + s @ self.sines + c @ self.cosines
        v = (c * w) @ self.sines - (s * w) @ self.cosines
        a = -(s * w**2) @ self.sines - (c * w**2) @ self.cosines
        return q, v, a

    def scaled(self) -> Motion:
        """The same as large as limits of position and speed allow."""
        q, v, _ = self.at(np.linspace(0, PERIOD, 200))
        share = np.maximum(np.abs(q - MIDDLE).max(0) / LIMIT, np.abs(v).max(0) / FASTEST)
        return Motion(self.sines / share, self.cosines / share)


class Arm:
    """The equations of a model, and its base parameters."""

    def __init__(self, model: Model) -> None:
        """Derive and load what is needed."""
        self.derivation: Derivation = derive(model)
        self.base: BaseParameters = self.derivation.base_parameters()
        self.regressor = self.derivation.function("regressor")
        self.forward = self.derivation.function("forward_dynamics").module.forward_dynamics

    @cached_property
    def true(self) -> Array:
        """The base parameters of the model's own numbers: what is to be found."""
        return self.base.values()

    def rows(self, motion: tuple[Array, Array, Array]) -> Array:
        """The regressor of base parameters at many states, each joint's rows over its noise."""
        Y = self.regressor(*motion)[..., self.base.independent]
        return Y / NOISE_TAU[:, None]

    def condition(self, motion: Motion) -> float:
        """Of the equations that a motion gives, unknowns scaled to be alike."""
        rows = self.rows(motion.at(np.linspace(0, PERIOD, 60, endpoint=False)))
        rows = rows.reshape(-1, self.base.count)
        return float(np.linalg.cond(rows / np.linalg.norm(rows, axis=0)))


def exciting(arm: Arm, rng: np.random.Generator, tries: int) -> tuple[Motion, float, float]:
    """The best of random motions, then of random steps from there; its condition, and the first one's."""

    def random_motion() -> Motion:
        return Motion(*rng.normal(size=(2, HARMONICS, 3))).scaled()

    best = random_motion()
    first = least = arm.condition(best)
    for k in range(tries):
        if k < tries // 3:
            trial = random_motion()
        else:
            step = 0.2 * rng.normal(size=(2, HARMONICS, 3))
            trial = Motion(best.sines + step[0], best.cosines + step[1]).scaled()
        condition = arm.condition(trial)
        if condition < least:
            best, least = trial, condition
    return best, least, first


def simulated(arm: Arm, motion: Motion) -> tuple[Array, Array]:
    """Positions and torques of the arm under a controller, by Runge and Kutta's method."""
    count = round((SETTLED + PERIODS * PERIOD) / STEP)
    q, v, _ = motion.at(np.array(0.0))
    wanted = motion.at(np.arange(2 * count + 1) * (STEP / 2))

    def torque(k: int, q: Array, v: Array) -> Array:
        return STIFFNESS * (wanted[0][k] - q) + DAMPING * (wanted[1][k] - v)

    def slope(k: int, x: Array) -> Array:
        q, v = x
        return np.array([v, arm.forward(q, v, torque(k, q, v))])

    x, h = np.array([q, v]), STEP
    states = np.empty((count, 2, 3))
    torques = np.empty((count, 3))
    for n in range(count):
        states[n], torques[n] = x, torque(2 * n, *x)
        k1 = slope(2 * n, x)
        k2 = slope(2 * n + 1, x + h / 2 * k1)
        k3 = slope(2 * n + 1, x + h / 2 * k2)
        k4 = slope(2 * n + 2, x + h * k3)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    first = round(SETTLED / STEP)
    return states[first:, 0], torques[first:]


def measured(arm: Arm, motion: Motion, rng: np.random.Generator) -> tuple[Array, Array]:
    """What encoders and current sensors say, averaged over the periods."""
    q, tau = simulated(arm, motion)
    q = q + NOISE_Q * rng.normal(size=q.shape)
    tau = tau + NOISE_TAU * rng.normal(size=tau.shape)
    return tuple(x.reshape(PERIODS, -1, 3).mean(0) for x in (q, tau))  # type: ignore[return-value]


def differentiated(q: Array) -> tuple[Array, Array, Array]:
    """q, v and a of a periodic motion, from its Fourier coefficients below the band's edge."""
    spectrum = np.fft.rfft(q, axis=0)
    f = np.fft.rfftfreq(len(q), STEP)[:, None]
    spectrum[f[:, 0] > BAND] = 0
    w = 2j * np.pi * f
    q, v, a = (np.fft.irfft(x, len(q), axis=0) for x in (spectrum, w * spectrum, w * w * spectrum))
    return q, v, a


@dataclass(frozen=True)
class Estimate:
    """What least squares found.

    Attributes:
        names: of the base parameters.
        true, found, deviation: their values, and the standard deviation of what was found.
        conditions: of the random motion that was first and of the chosen one.
        noise: standard deviation of the residual of each joint's torque, and of another motion's (N m).
        torques: time, measured and predicted torques of that other motion.
    """

    names: tuple[str, ...]
    true: Array
    found: Array
    deviation: Array
    conditions: tuple[float, float]
    noise: tuple[Array, Array]
    torques: tuple[Array, Array, Array]

    @property
    def errors(self) -> Array:
        """Errors in standard deviations."""
        return (self.found - self.true) / self.deviation


def least_squares(rows: Array, tau: Array) -> tuple[Array, Array, Array]:
    """Weighted least squares: unknowns, their standard deviations, and the joints' own residuals.

    Rows come over the joints' assumed noise; the residuals of a first fit correct these weights.
    """
    count = rows.shape[-1]
    weights = np.ones(tau.shape[-1])
    for _ in range(2):
        A = (rows * weights[:, None]).reshape(-1, count)
        b = (tau * weights).reshape(-1)
        scale = np.linalg.norm(A, axis=0)
        found = np.linalg.lstsq(A / scale, b, rcond=None)[0] / scale
        residual = tau - rows @ found
        weights = 1 / np.sqrt((residual**2).sum(0) / (len(tau) - count / tau.shape[-1]))
    A = (rows * weights[:, None]).reshape(-1, count) / scale
    deviation = np.sqrt(np.diag(np.linalg.inv(A.T @ A))) / scale
    return found, deviation, residual.std(0)


def identify(model: Model, seed: int = 1, tries: int = 300) -> Estimate:
    """The whole experiment."""
    rng = np.random.default_rng(seed)
    system = Arm(model)
    motion, condition, first = exciting(system, rng, tries)
    q, tau = measured(system, motion, rng)
    found, deviation, residual = least_squares(system.rows(differentiated(q)), tau / NOISE_TAU)
    other = Motion(*rng.normal(size=(2, HARMONICS, 3))).scaled()
    q, tau = measured(system, other, rng)
    predicted = system.rows(differentiated(q)) @ found * NOISE_TAU
    return Estimate(
        tuple(system.base.names[k] for k in system.base.independent),
        system.true,
        found,
        deviation,
        (first, condition),
        (residual * NOISE_TAU, (tau - predicted).std(0)),
        (np.arange(len(tau)) * STEP, tau, predicted),
    )


def report(estimate: Estimate) -> str:
    """A table of what was found."""
    first, chosen = estimate.conditions
    lines = [
        f"condition of the equations: {first:.1f} with a random motion, {chosen:.1f} with the chosen one",
        "",
        f"{'base parameter':20s} {'true':>10s} {'found':>10s}   {'+-':9s} {'error/sigma':>11s}",
    ]
    columns: Sequence[Any] = (estimate.names, estimate.true, estimate.found, estimate.deviation)
    for (name, true, found, deviation), error in zip(
        zip(*columns, strict=True), estimate.errors, strict=True
    ):
        half = SIGMAS * deviation
        lines.append(f"{name:20s} {true:10.5f} {found:10.5f}   {half:<9.2g} {error:11.2f}")
    expected = NOISE_TAU / np.sqrt(PERIODS)
    lines += ["", "residual torque (N m)     waist  shoulder     elbow"]
    for title, values in (
        ("noise of the sensors", expected),
        ("this motion", estimate.noise[0]),
        ("another motion", estimate.noise[1]),
    ):
        lines.append(f"{title:21s}" + "".join(f"{value:10.4f}" for value in values))
    return "\n".join(lines)


def plot(estimate: Estimate, path: str | Path) -> None:
    """Torques of the other motion, and errors of the parameters with their intervals."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 5), layout="constrained")
    t, tau, predicted = estimate.torques
    for joint, name in enumerate(("waist", "shoulder", "elbow")):
        left.plot(t, tau[:, joint], color=f"C{joint}", alpha=0.35)
        left.plot(t, predicted[:, joint], color=f"C{joint}", label=name, linewidth=1)
    left.set(
        xlabel="time (s)",
        ylabel="torque (N m)",
        title="another motion: measured, and predicted (thin)",
    )
    left.legend()
    places = np.arange(len(estimate.names))
    right.errorbar(estimate.errors, places, xerr=SIGMAS, fmt="o", markersize=3, capsize=2)
    right.axvline(0, color="black", linewidth=0.8)
    right.set_yticks(places, estimate.names, fontsize=7)
    right.invert_yaxis()
    right.set(
        xlabel="error over standard deviation",
        title=f"base parameters, intervals of {SIGMAS} sigma",
    )
    figure.savefig(path, dpi=80, metadata={"Software": None})
    pyplot.close(figure)


def main() -> None:
    """Run the experiment and print what it found."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plot", metavar="FILE", help="also draw torques and errors")
    parser.add_argument("--tries", type=int, default=300, help="motions that are tried")
    given = parser.parse_args()
    estimate = identify(arm(), tries=given.tries)
    print(report(estimate))
    if given.plot:
        plot(estimate, given.plot)


if __name__ == "__main__":
    main()
