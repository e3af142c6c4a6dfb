"""The measurements: for every robot all peers together, in one run."""

from __future__ import annotations

import statistics
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from typing import TYPE_CHECKING, Any

import linegraph_peer
from calls import FIVE, Call, Sizes, count_instructions, folder, time_calls, verify, verify_batches
from environment import described, say
from linegraph_peer import Emitted
from robots import Robot, robot

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Figures = dict[str, Any]


@dataclass(frozen=True)
class Plan:
    """What to do.

    Attributes:
        robots: names of the systems.
        functions: some of `calls.FUNCTIONS`.
        skip: peers and measurements to leave out.
        processes: in how many each function is timed.
        rounds: how often in each of them.
        milliseconds: how long each time.
        runs: how often a process is measured.
        links: lengths of the planar chains that SymPy derives.
    """

    robots: Sequence[str]
    functions: Sequence[str]
    skip: frozenset[str]
    processes: int
    rounds: int
    milliseconds: float
    runs: int
    links: Sequence[int]


def study(plan: Plan) -> Figures:
    """All figures."""
    made = datetime.now(UTC).isoformat(timespec="seconds")
    found: Figures = {"date": made, "machine": described(), "robots": {}, "short": {}}
    for name in plan.robots:
        say(f"{name} ...")
        found["robots"][name] = _robot(plan, robot(name, folder("robots")))
    if "sympy" not in plan.skip:
        for n in plan.links:
            say(f"SymPy, {n} links ...")
            found["short"][f"planar{n}"] = _short(plan, n)
    return found


def _robot(plan: Plan, system: Robot) -> Figures:
    emitted = linegraph_peer.emit(system)
    found: Figures = {"nv": emitted.sizes.nv, "base": system.base, "functions": {}}
    for function in plan.functions:
        calls = [*linegraph_peer.calls(system, function, plan.runs)]
        calls += _peers(plan, system, emitted, function)
        found["functions"][function] = _measured(plan, calls, emitted.sizes)
    if "batch" not in plan.skip and (calls := linegraph_peer.batches(system)):
        found["functions"]["equations of many states"] = _measured(plan, calls, emitted.sizes)
    if "casadi" not in plan.skip:
        import casadi_peer

        found["counts"] = casadi_peer.counts(system)
    if "generation" not in plan.skip:
        found["generation"] = _generation(plan, system, emitted)
    return found


def _peers(plan: Plan, system: Robot, emitted: Emitted, function: str) -> list[Call]:
    calls: list[Call] = []
    joints = emitted.joints
    if "casadi" not in plan.skip:
        import casadi_peer

        calls += casadi_peer.calls(system, joints, function, plan.runs)
    if "pinocchio" not in plan.skip:
        import pinocchio_peer

        calls += pinocchio_peer.calls(system, joints, function)
    if "mujoco" not in plan.skip:
        import mujoco_peer

        calls += mujoco_peer.calls(system, joints, function)
    return calls


def _measured(plan: Plan, calls: list[Call], sizes: Sizes) -> dict[str, Figures]:
    """Figures by peer; nothing is timed before all agree."""
    differences = verify(calls, sizes)
    verify_batches(calls, sizes)
    time_calls(calls, sizes, plan.processes, plan.rounds, plan.milliseconds)
    if "instructions" not in plan.skip:
        count_instructions(calls, sizes)
    for call in calls:
        if call.peer in differences:
            call.figures["difference"] = differences[call.peer]
    return {call.peer: call.figures for call in calls}


def _generation(plan: Plan, system: Robot, emitted: Emitted) -> dict[str, Figures]:
    """What generating costs, the peers interleaved; medians."""
    makers: dict[str, Callable[[], Figures]] = {
        "linegraph, M and h": partial(linegraph_peer.generation, system, ("equations",)),
        "linegraph, five functions": partial(linegraph_peer.generation, system, FIVE),
        "linegraph, everything": partial(linegraph_peer.generation, system, ()),
    }
    wholes = {"linegraph, everything": linegraph_peer.whole(emitted, plan.runs)}
    five = linegraph_peer.emit(system, "five", *(w for f in FIVE for w in ("--only", f)))
    wholes["linegraph, five functions"] = linegraph_peer.whole(five, plan.runs)
    if "casadi" not in plan.skip:
        import casadi_peer

        makers["CasADi, M and h"] = partial(casadi_peer.generation, system, ("equations",))
        makers["CasADi, five functions"] = partial(casadi_peer.generation, system, FIVE)
        wholes["CasADi, five functions"] = casadi_peer.whole(system, plan.runs)
    samples: dict[str, list[Figures]] = {peer: [] for peer in makers}
    for _ in range(plan.runs):
        for peer, maker in makers.items():
            samples[peer].append(maker())
    return {
        peer: {key: statistics.median(run[key] for run in runs) for key in runs[0]}
        | wholes.get(peer, {})
        for peer, runs in samples.items()
    }


def _short(plan: Plan, n: int) -> dict[str, Figures]:
    """A planar chain by SymPy, and by linegraph beside it."""
    import sympy_peer

    system = robot(f"planar{n}", folder("robots"))
    emitted = linegraph_peer.emit(system)
    calls = linegraph_peer.calls(system, "equations", plan.runs)
    generation = linegraph_peer.generation(system, ("equations",))
    calls[0].figures |= {f"generation_{key}": value for key, value in generation.items()}
    return _measured(plan, [*calls, *sympy_peer.calls(emitted, n, plan.runs)], emitted.sizes)
