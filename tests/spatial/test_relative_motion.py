"""Relative motion crossed the other way, beside derivatives of the inverse pose."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from support.rigid_motion import STEP, TINY, axial, pose, rows, turned, undone

from linegraph.spatial.motion import Motion, reverse
from linegraph.spatial.rotation import Full, Rotation

if TYPE_CHECKING:
    from collections.abc import Callable

Q = np.array([0.4, -0.3])
V = np.array([0.7, 1.3])


def head_from_tail(q: Any) -> Any:
    """A joint of two coordinates that does everything at once: turns, slides, and curves."""
    rotation = turned((1, 2, -1), q[0] + 0.2) @ turned((0, 1, 3), q[1] * q[0] - q[1])
    place = np.array([q[0] ** 2, np.sin(q[1]) + q[0], 0.3 + q[0] * q[1]])
    return pose(rotation, place)


def differentiated(path: Callable[[Any], Any], q: Any, v: Any) -> Motion:
    """The motion of a pose: its derivatives in the axes of the head, by complex steps and differences."""

    def rates(at: Any, along: Any) -> tuple[Any, Any]:
        ahead = path(at + 1j * TINY * along)
        back = ahead[:3, :3].real.T
        return axial(back @ ahead[:3, :3].imag / TINY), back @ ahead[:3, 3].imag / TINY

    columns = [rates(q, e) for e in np.eye(len(q))]
    later, before = rates(q + STEP * v, v), rates(q - STEP * v, v)
    w, u = ((a - b) / (2 * STEP) for a, b in zip(later, before, strict=True))
    here = path(q)
    return Motion(
        Rotation((Full(rows(here[:3, :3])),)),
        tuple(float(x) for x in here[:3, 3]),  # type: ignore[arg-type]
        tuple(tuple(a.tolist()) for a, _ in columns),
        tuple(tuple(b.tolist()) for _, b in columns),
        tuple(w.tolist()),
        tuple(u.tolist()),
    )


def same(found: Motion, expected: Motion, of_biases: float) -> None:
    np.testing.assert_allclose(
        np.array(found.rotation.matrix()), np.array(expected.rotation.matrix()), atol=1e-15
    )
    for name, a in found._asdict().items():
        if name != "rotation":
            within = of_biases if name.endswith("bias") else 4e-15
            np.testing.assert_allclose(a, getattr(expected, name), atol=within, err_msg=name)


def test_a_reversed_motion_is_that_of_the_inverse_pose() -> None:
    forward = differentiated(head_from_tail, Q, V)
    backward = differentiated(lambda q: undone(head_from_tail(q)), Q, V)
    same(reverse(forward), backward, of_biases=1e-9)


def test_reversed_twice_a_motion_is_itself() -> None:
    forward = differentiated(head_from_tail, Q, V)
    same(reverse(reverse(forward)), forward, of_biases=4e-15)
