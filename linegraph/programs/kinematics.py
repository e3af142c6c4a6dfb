"""Emitted functions of kinematics: named frames, centre of mass, momentum, and all of them at once."""

from __future__ import annotations

from collections import Counter
from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.algebra.protocol import set_label
from linegraph.dynamics.momentum import (
    center,
    center_columns,
    center_velocity,
    momenta,
    momentum_columns,
    momentum_rate,
    scaled,
    shared,
)
from linegraph.errors import ModelError
from linegraph.ir.program import Program, Result, Routine, needed_for
from linegraph.kinematics.frame_trees import NamedFrame, Tipped, seat_of, tipped
from linegraph.kinematics.tree_state import TreeState
from linegraph.kinematics.twists import (
    Column,
    Outlook,
    accelerations,
    columns,
    matrix,
    position,
    total,
    velocities,
)
from linegraph.spatial.vector import Vector, scale

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.links import KinematicTree
    from linegraph.programs.workspace import Workspace

CENTER = "center_of_mass"
WHOLE = (
    CENTER,
    "center_of_mass_velocity",
    "center_of_mass_jacobian",
    "momentum",
    "centroidal_momentum_matrix",
    "centroidal_momentum_bias",
)
"""The functions of the system as a whole."""

ABOUT = {
    "pose": "Pose of the frame {}: where its origin is, and how it is turned.",
    "velocity": "Velocity of the frame {}: of its origin, and angular; in ground axes.",
    "jacobian": "Jacobian J(q) of the frame {}: its velocity is J v{}.",
    "jacobian_dot_v": "Rate of the velocity of the frame {} at vdot = 0: its acceleration is J a + Jdot_v.",
    CENTER: "Centre of mass of all that moves.",
    "center_of_mass_velocity": "Velocity of the centre of mass.",
    "center_of_mass_jacobian": "Jacobian Jcom(q) of the centre of mass: its velocity is Jcom v{}.",
    "momentum": "Momentum of all that moves: linear, and angular about the centre of mass; in ground axes.",
    "centroidal_momentum_matrix": "Centroidal momentum matrix Ag(q): the momentum is Ag v{}.",
    "centroidal_momentum_bias": "Rate of the momentum at vdot = 0: its derivative is Ag a + Agdot_v.",
}
PRESCRIBED = ", and what prescribed motion adds"

RESULTS = {
    "position": ((3,), "origin of {}, in ground axes (m)"),
    "rotation": ((3, 3), "rotation matrix; its columns are the axes of {} in ground axes"),
    "velocity": ((6,), "velocity of {}: linear (m/s), angular (rad/s)"),
    "jacobian": ((6, -1), "Jacobian of {}: three linear rows, three angular ones"),
    "jacobian_dot_v": ((6,), "acceleration of {} at vdot = 0: linear (m/s^2), angular (rad/s^2)"),
    "com": ((3,), "centre of mass, in ground axes (m)"),
    "com_velocity": ((3,), "velocity of the centre of mass (m/s)"),
    "Jcom": ((3, -1), "Jacobian of the centre of mass"),
    "hg": ((6,), "momentum: linear (N*s), angular about the centre of mass (N*m*s)"),
    "Ag": ((6, -1), "centroidal momentum matrix: three linear rows, three angular ones"),
    "Agdot_v": ((6,), "rate of the momentum at vdot = 0 (N, N*m)"),
}

OF_FRAMES = {
    "pose": ("position", "rotation"),
    "velocity": ("velocity",),
    "jacobian": ("jacobian",),
    "jacobian_dot_v": ("jacobian_dot_v",),
}
OF_WHOLE = dict(zip(WHOLE, ("com", "com_velocity", "Jcom", "hg", "Ag", "Agdot_v"), strict=True))
FIRST = ("position", "rotation", "jacobian", "com", "Ag", "Jcom")
"""Results that others may be computed from; they are chosen first."""

SWEEPS = 4
"""Rounds of choosing a formula for each result: every choice changes the cost of the others."""

RENAMED = {"jacobian": "J", "jacobian_dot_v": "Jdot_v"}
"""Names of a frame's results in functions of one frame."""


class Kinematics:
    """The kinematics of some frames, and of the system as a whole if masses are included.

    Args:
        f: the shared equations.
        frames: the frames.
        whole: whether masses matter.
        turning: whether the frames' axes matter.
    """

    def __init__(
        self,
        f: Workspace,
        frames: Sequence[NamedFrame],
        *,
        whole: bool = False,
        turning: bool = True,
    ) -> None:
        """Build the tree that ends in the frames; results are derived when they are needed."""
        self._f = f
        seats = [seat_of(f.tree, frame.name) for frame in frames]
        self._tipped: Tipped = tipped(f.tree, seats, masses=whole, turning=turning)
        self._whole = whole
        self._turning = turning
        self._tips = dict(zip((x.identifier for x in frames), self._tipped.tips, strict=True))
        self.view = self._seen(self._tipped.tree)

    def _seen(self, tree: KinematicTree) -> Outlook:
        return Outlook(TreeState(tree, self._f.q, self._f.v))

    def has(self, result: str, frame: str) -> bool:
        """Whether a result is available here.

        Args:
            result: a key of `RESULTS`.
            frame: identifier of a frame; "" for the system as a whole.
        """
        if not frame:
            return self._whole
        return frame in self._tips and (self._turning or result != "rotation")

    def ways(self, result: str, frame: str = "") -> list[tuple[Scalar, ...]]:
        """All formulas for a result, flat: they have the same values and different costs.

        Args:
            result: a key of `RESULTS`.
            frame: identifier of a frame; "" for the system as a whole.
        """
        if frame:
            return self._of_frame(result, self._tips[frame])
        return self._of_whole[result]()

    def _of_frame(self, result: str, tip: int) -> list[tuple[Scalar, ...]]:
        view = self.view
        if result == "position":
            return [position(view, tip)]
        if result == "rotation":
            return [tuple(x for row in view.rotation(tip) for x in row)]
        if result == "jacobian":
            return [self._flat(columns(view, tip))]
        found = velocities(view, tip) if result == "velocity" else accelerations(view, tip)
        return [(*linear, *angular) for linear, angular in found]

    @property
    def _of_whole(self) -> dict[str, Callable[[], list[tuple[Scalar, ...]]]]:
        view, centers = self.view, self._centers
        rows = 3 * len(self._f.v)
        return {
            "com": lambda: list(centers),
            "com_velocity": lambda: [
                *(total(found)[0] for found in self._center_columns),
                center_velocity(self._shares),
            ],
            "Jcom": lambda: [self._flat(found)[:rows] for found in self._center_columns],
            "hg": lambda: [(*x, *y) for c in centers for x, y in momenta(view, c)],
            "Ag": lambda: [self._flat(momentum_columns(view, c)) for c in centers],
            "Agdot_v": lambda: [(*x, *y) for x, y in (momentum_rate(view, c) for c in centers)],
        }

    @cached_property
    def _shares(self) -> Outlook:
        return self._seen(shared(self._tipped.tree, self._tipped.mass))

    @cached_property
    def _centers(self) -> list[Vector]:
        """Formulas for the centre of mass: with shares of the mass, or divided by it at the end."""
        mass, at_rest = self._tipped.mass, self._tipped.at_rest
        set_label(self._f.dag, "centre of mass")
        resting, per_mass = scale(1 / mass, at_rest), 1 / mass
        return [center(self._shares, resting), scale(per_mass, center(self.view, at_rest))]

    @cached_property
    def _center_columns(self) -> list[list[Column]]:
        """Formulas for its Jacobian: in the same two ways, or from the momentum matrix."""
        mass = self._tipped.mass
        return [
            center_columns(self._shares),
            scaled(center_columns(self.view), mass),
            *(scaled(momentum_columns(self.view, c), mass) for c in self._centers),
        ]

    def _flat(self, found: Iterable[Column]) -> tuple[Scalar, ...]:
        return tuple(x for row in matrix(found, len(self._f.v)) for x in row)


def besides(asked: Sequence[str], frames: Sequence[NamedFrame]) -> tuple[str, ...]:
    """Keys that a request for frames or for several functions of the whole adds.

    Args:
        asked: keys of the requested functions.
        frames: the requested frames.
    """
    several = sum(key in WHOLE for key in asked) > 1
    return (*(["frames"] if frames else []), *(["kinematics"] if frames or several else []))


def frames(f: Workspace) -> tuple[Program | Routine, ...]:
    """Pose, velocity, Jacobian and acceleration at v̇ = 0 of every requested frame."""
    found = []
    for frame in f.frames:
        own = both(f, (frame,))
        for function, results in OF_FRAMES.items():
            keys = [(result, frame.identifier) for result in results]
            entries = shortest(own, keys)
            made = tuple(
                _result(f, RENAMED.get(result, result), result, frame.name, entries[key])
                for result, key in zip(results, keys, strict=True)
            )
            about = ABOUT[function].format(f'"{frame.name}"', _prescribed(f))
            given = ("q", "v") if function in ("velocity", "jacobian_dot_v") else ("q",)
            found.append(f.program(f"frame_{frame.identifier}_{function}", about, given, made))
    return tuple(found)


def whole(function: str) -> Callable[[Workspace], tuple[Program | Routine, ...]]:
    """The maker of one of the functions of `WHOLE`."""

    def make(f: Workspace) -> tuple[Program | Routine, ...]:
        require_mass(f)
        result = OF_WHOLE[function]
        entries = shortest([Kinematics(f, (), whole=True)], [(result, "")])
        made = _result(f, result, result, "", entries[(result, "")])
        given = ("q", "v") if result in ("com_velocity", "hg", "Agdot_v") else ("q",)
        return (f.program(function, ABOUT[function].format(_prescribed(f)), given, (made,)),)

    return make


def kinematics(f: Workspace) -> tuple[Program | Routine, ...]:
    """One function for all requested results of kinematics, sharing work; for all there are by default."""
    functions = [key for key in WHOLE if key in f.asked] or ([] if f.frames else list(WHOLE))
    if functions:
        require_mass(f)
    of_frames = [
        (result, frame.identifier)
        for frame in f.frames
        for results in OF_FRAMES.values()
        for result in results
    ]
    of_whole = [(OF_WHOLE[function], "") for function in functions]
    keys = [*of_frames, *of_whole]
    together = shortest(both(f, f.frames, whole=bool(functions)), keys)
    apart = [source for frame in f.frames for source in both(f, (frame,))]
    apart += [Kinematics(f, (), whole=True)] if functions else []
    found = min((together, shortest(apart, keys)), key=_cost)
    names = {frame.identifier: frame.name for frame in f.frames}
    made = tuple(
        _result(f, f"{frame}_{result}" if frame else result, result, names.get(frame, ""), entries)
        for (result, frame), entries in found.items()
    )
    _require_apart(made, found)
    about = "Kinematics of frames and of the whole at once, sharing work."
    return (f.program("kinematics", about, ("q",), made),)


def _require_apart(made: Sequence[Result], keys: Iterable[Key]) -> None:
    """Refuse a frame whose results have the names of those of the whole, such as a frame named com.

    Raises:
        ModelError: two results have the same name.
    """
    times = Counter(result.name for result in made)
    for result, (_, frame) in zip(made, keys, strict=True):
        if times[result.name] > 1:
            problem = (
                f"its {result.name} and that of the whole would have one name in kinematics; rename it, or "
                "ask with --only for the functions themselves"
            )
            raise ModelError(f'frame "{frame or result.name}"', problem)


def require_mass(f: Workspace) -> None:
    """Refuse functions of the centre of mass if the total mass is zero.

    Raises:
        ModelError: all that moves has no mass, at the default parameters.
    """
    links = f.derivation.sample.links
    if not sum(link.moments.mass for link in links) > 0:
        problem = (
            "all that moves has no mass together, so it has no centre of mass; give a body its mass, or "
            f"do without {', '.join(WHOLE)}"
        )
        raise ModelError(f'model "{f.tree.system.name}"', problem)


def both(f: Workspace, frames: Sequence[NamedFrame], *, whole: bool = False) -> list[Kinematics]:
    """Kinematics with the frames' axes, and without them.

    Args:
        f: the shared equations.
        frames: the frames.
        whole: whether masses matter.
    """
    return [Kinematics(f, frames, whole=whole), Kinematics(f, frames, turning=False)]


Key = tuple[str, str]
"""A result, and the identifier of its frame."""


def shortest(sources: Sequence[Kinematics], keys: Sequence[Key]) -> dict[Key, tuple[Scalar, ...]]:
    """One formula for every result, so that all together take few operations.

    First each result gets the formula that adds the fewest operations to those before it, starting with
    results that others may be computed from; then each is chosen again with all others given, until
    nothing changes. Trying all combinations would take too long.

    Args:
        sources: where formulas come from.
        keys: the results.
    """
    ways = {
        key: [
            (way, needed_for(way))
            for source in sources
            if source.has(*key)
            for way in source.ways(*key)
        ]
        for key in keys
    }
    chosen: dict[Key, tuple[Scalar, ...]] = {}
    taken: dict[Key, frozenset[int]] = {}
    uses: Counter[int] = Counter()
    for _ in range(SWEEPS):
        before = dict(taken)
        for key in sorted(keys, key=lambda key: key[0] not in FIRST):
            uses.subtract(taken.get(key, ()))
            costs = [sum(not uses[node] for node in needed) for _, needed in ways[key]]
            chosen[key], taken[key] = ways[key][costs.index(min(costs))]
            uses.update(taken[key])
        if taken == before:
            break
    return {key: chosen[key] for key in keys}


def _cost(found: dict[Key, tuple[Scalar, ...]]) -> int:
    return len(needed_for(x for entries in found.values() for x in entries))


def _result(f: Workspace, name: str, kind: str, frame: str, entries: tuple[Scalar, ...]) -> Result:
    shape, about = RESULTS[kind]
    counts = tuple("NV" if size < 0 else "" for size in shape)
    shape = tuple(len(f.v) if size < 0 else size for size in shape)
    return Result(name, shape, entries, about.format(f'"{frame}"'), counts)


def _prescribed(f: Workspace) -> str:
    """Addition to a description if the velocity is not J v alone."""
    return PRESCRIBED if any(link.place.drive for link in f.tree.links) else ""
