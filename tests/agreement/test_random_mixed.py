"""Random systems of mechanics and networks: balances, invariance, an independent tableau, emitted code.

300 systems x 20 states. The reference is linegraph's derivation over numbers (`mixed_reference`, the same as
`Derivation.numeric`, for many states at once); what it says is held against power and energy, against the
same system said otherwise, against equations assembled apart (`mixed_tableau`), and against emitted code.
"""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from oracles import mixed_tableau
from oracles.mixed_reference import STEP, Reference, rate, reference_of
from oracles.mixed_tableau import Instant, Tableau
from support.compiled import Compiled
from support.emitted import load
from systems import random_mixed as mixed

from linegraph import ModelError, derive
from linegraph.dynamics.edge_quantities import network_powers, powers
from linegraph.emission.emit import render
from linegraph.model.system import variant
from linegraph.numeric.between_trees import transfer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from pathlib import Path

    from systems.random_mixed import Part, States, System

Array = Any

SYSTEMS, STATES, CHUNK = 300, 20, 10
CHUNKS = range(0, SYSTEMS, CHUNK)
FEW = CHUNKS[::15]
"""Ten systems of every hundred and fifty."""
AUDIT = 1e-11
"""Of the sums of through times across in each subspace, relative to the largest power."""
BALANCE = 1e-9
"""Of energy, of each component and of the whole."""
SAME = 1e-9
"""Accelerations and rates of one system said in two ways."""
APART = 1e-8
"""Everything by the tableau."""
EXACT = 1e-12
"""One derivation in numbers, in lanes, and emitted."""
SOLVED = 1e-10
"""The same after solving."""


# ---- systems at states


@dataclass
class Case:
    """A system at random states."""

    system: System
    states: States
    reference: Reference

    @property
    def rng(self) -> np.random.Generator:
        return np.random.default_rng([int(self.system.name[5:]), 3])

    def named(self) -> tuple[dict[str, Array], dict[str, Array], dict[str, Array]]:
        """Coordinates, velocities and inputs by name; of inputs also the rates that other variants need."""
        tree, r = self.reference.tree, self.reference
        names = [
            [x.name for x in group] for group in (tree.positions, tree.velocities, tree.inputs)
        ]
        columns = (r.q.T, r.v.T, r.u.T)
        q, v, u = (dict(zip(n, c, strict=True)) for n, c in zip(names, columns, strict=True))
        return q, v, {**self.states.u, **u}


def case_of(seed: int, count: int = STATES) -> Case:
    """A system, at states drawn for it."""
    system = mixed.random_system(seed)
    rng = np.random.default_rng([seed, 1])
    states = mixed.draw_states(rng, system, count)
    derivation = derive(mixed.model_of(system))
    tree = derivation.structure
    first = tree.layout.mechanical
    assert [x.name for x in tree.velocities[:first]] == system.own
    z = rng.uniform(-1.2, 1.2, (count, len(tree.velocities) - first))
    for k, quantity in enumerate(tree.velocities[first:]):
        if quantity.name.startswith("T_"):
            z[:, k] = rng.uniform(0.5, 2.0, count)
    given = {name: rng.normal(size=count) for name in system.own} | states.u
    u = np.array([given[x.name] for x in tree.inputs]).reshape(len(tree.inputs), count).T
    v = np.hstack((states.v, z))
    return Case(system, states, Reference.at(derivation, states.t, states.q, v, u))


def failures(seeds: Iterable[int], check: Callable[[int], Iterable[str]]) -> list[str]:
    """What a check says of the systems of a chunk."""
    return [f"system {seed}: {problem}" for seed in seeds for problem in check(seed)]


def problem_of(check: Callable[..., None], *given: Any) -> Iterator[str]:
    """Nothing if a check holds."""
    try:
        check(*given)
    except (AssertionError, ArithmeticError, ModelError, np.linalg.LinAlgError) as error:
        yield f"{check.__name__}: {type(error).__name__}: {str(error)[:300]}"


def held(seeds: Iterable[int], check: Callable[[int], None]) -> None:
    """A check on all systems of a chunk; all that fail are named."""
    found = failures(seeds, lambda seed: problem_of(check, seed))
    assert not found, "\n".join(found)


def chunk(first: int) -> range:
    return range(first, first + CHUNK)


def error(found: Array, expected: Array) -> float:
    """The worst difference, relative to 1 + the largest of the same state."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape, (found.shape, expected.shape)
    if not found.size:
        return 0.0
    rest = tuple(range(1, found.ndim))
    size = 1 + np.max(np.abs(expected), axis=rest)
    return float(np.max(np.max(np.abs(found - expected), axis=rest) / size))


# ---- a: powers; d: the mass matrix


def audited(case: Case) -> None:
    """Powers sum to zero in each subspace; every component stores or loses what it takes in."""
    r = case.reference
    found, sums = powers(r.scheme.edges())
    more, domains = network_powers(r.tree.network, r.scheme.network())
    every = np.abs(r.stacked([*found.values(), *more.values()]))
    size = 1 + np.max(every, axis=1, initial=0.0, keepdims=True)
    assert np.max(np.abs(r.stacked(list(sums))) / size) <= AUDIT
    assert np.max(np.abs(r.stacked(list(domains.values()))) / size, initial=0.0) <= AUDIT
    gains = r.stacked(list(r.scheme.gains().values()))
    assert np.max(np.abs(gains) / size, initial=0.0) <= BALANCE


def massive(case: Case) -> None:
    """𝓜 is symmetric, is the slope of inverse dynamics, and one state in plain numbers agrees."""
    r = case.reference
    if not case.system.controlled:
        assert r.tree.network is None or r.tree.network.symmetric
        assert error(r.mass, np.swapaxes(r.mass, 1, 2)) <= EXACT
        mechanical = r.mass[:, : r.first, : r.first]
        assert np.all(np.linalg.eigvalsh(mechanical) > 0)
    a = case.rng.normal(size=r.v.shape)
    taken = r.inverse(r.acceleration + 1j * STEP * a)
    assert error(rate(taken), np.einsum("sij,sj->si", r.mass, a)) <= EXACT
    assert error(np.real(taken) + r.bias, r.forces + r.bias) <= SOLVED
    numeric = r.derivation.numeric(None, float(r.t[0]), list(r.u[0]))
    q, v = list(r.q[0]), list(r.v[0])
    M, h = numeric.mass_matrix(q, v), numeric.bias(q, v)
    assert error(r.mass[:1], np.array(M, float)[None]) <= EXACT
    assert error(r.bias[:1], np.array(h, float)[None]) <= EXACT
    columns = [numeric.inverse_dynamics(q, v, list(row)) for row in np.eye(len(v))]
    slopes = np.array(columns, float).T - np.array(h, float)[:, None]
    assert error(slopes[None], np.array(M, float)[None]) <= SOLVED


# ---- b: energy

LOSSY = (
    *("resistor", "conductance", "diode", "element", "pipe", "orifice", "valve"),
    *("rotational_damper", "rotational_friction", "translational_damper"),
)


def lost(
    part: Part, X: Mapping[str, Array], Y: Mapping[str, Array], value: Callable[[Any], Any]
) -> Array:
    """What a component turns into heat, by the textbook."""
    name, given = part.name, {k: value(x) for k, x in part.options.items() if k in SCALARS}
    if part.kind in LOSSY:
        return X[name] * Y[name]
    if part.kind == "dc_motor":
        speed = given.get("ratio", 1) * X[f"{name}.mechanical"]
        heat = given["resistance"] * Y[f"{name}.electrical"] ** 2
        return heat + given.get("damping", 0) * speed**2
    if part.kind in ("solenoid", "reluctance_machine", "moving_coil"):
        return given.get("resistance", 0) * Y[f"{name}.electrical"] ** 2
    if part.kind == "synchronous_machine":
        return given.get("resistance", 0) * sum(Y[p.edge] ** 2 for p in part.ports[:-1])
    if part.kind in ("pump", "hydraulic_motor"):
        return given.get("leakage", 0) * X[f"{name}.hydraulic"] ** 2
    return 0.0


SCALARS = ("resistance", "damping", "ratio", "leakage")


def variables(case: Case) -> tuple[dict[str, Array], dict[str, Array]]:
    """X and Y of all edges of components, those in 3-D mechanics too."""
    r = case.reference
    known: Any = r.scheme.variables()
    edges = [port.edge for part in case.system.parts if part.kind != "law" for port in part.ports]
    X = {edge: r.stacked(known[f"across({edge})"]) for edge in edges}
    Y = {edge: r.stacked(known[f"through({edge})"]) for edge in edges}
    return X, Y


def terms_of_power(case: Case) -> list[Array]:
    """What sources deliver, joint efforts and prescribed motions among them, and what becomes heat."""
    system, r, states = case.system, case.reference, case.states
    X, Y = variables(case)
    _, v, u = case.named()
    joints = {
        joint.name: np.array([_whole(system, w[0], joint.name) for w in states.whole])
        for joint in system.tree.joints
    }
    scope = {**system.parameters, **states.u, **joints, "t": states.t, "sin": np.sin}
    scope["across"] = X.__getitem__

    def value(x: Any) -> Any:
        text = re.sub(r"across\(([\w.]+)\)", r'across("\1")', str(x))
        return eval(text, {"__builtins__": {}}, scope)

    found = []
    for part in system.parts:
        thermal = any(port.domain == "thermal" for port in part.ports)
        if part.kind == "opamp":
            found += [-X[port.edge] * Y[port.edge] for port in part.ports]
        elif part.kind in mixed.SOURCES and not thermal:
            found.append(-X[part.name] * Y[part.name])
        elif part.kind != "law" and not thermal:
            found.append(-lost(part, X, Y, value))
    laws = {part.name for part in system.parts if part.kind == "law"}
    laws |= {name for kind, name, _ in system.forces if kind != "spring"}
    edges = r.scheme.edges()
    for name in sorted(laws):
        found.append(r.stacked(sum(powers({name: edges[name]})[1])))
    for quantity in r.tree.inputs:
        if quantity.name in system.own:
            found.append(u[quantity.name] * v[quantity.name])
    for joint, effort in r.scheme.drives().items():
        place = system.tree.velocity_slices[joint].start
        found.append(r.stacked(effort) * np.array([w[1][place] for w in states.whole]))
    return [np.broadcast_to(x, r.t.shape) for x in found]


def _whole(system: System, q: Array, joint: str) -> float:
    coupling = next((c for c in system.tree.couplings if c.joint == joint), None)
    if coupling is not None:
        return float(coupling.ratio * _whole(system, q, coupling.master) + coupling.offset)
    return float(q[system.tree.coordinate_slices[joint].start])


def energetic(system: System) -> bool:
    """Whether all energy is known: nothing stores by a charge alone, and the power of all drives is given."""
    charges = ("charge", "flux", "volume")
    parts = (p for p in system.parts if p.kind != "synchronous_machine")
    return system.compared and not any(key in p.options for p in parts for key in charges)


def conserved(case: Case) -> None:
    """dE/dt is what sources deliver less what becomes heat."""
    if not energetic(case.system):
        return
    change = rate(case.reference.moved.energy)
    terms = terms_of_power(case)
    size = 1 + np.sum(np.abs(terms), axis=0) + np.sum(np.abs(change), axis=1)
    assert np.max(np.abs(np.sum(change, axis=1) - np.sum(terms, axis=0)) / size) <= BALANCE


def test_energy_is_judged_of_most() -> None:
    assert sum(energetic(mixed.random_system(seed)) for seed in range(SYSTEMS)) >= 0.6 * SYSTEMS


# ---- c: the same system said otherwise


@dataclass
class Other:
    """A system said otherwise: the sign and the former name of its edges."""

    system: System
    signs: Mapping[str, int]
    former: Mapping[str, str]


def compared(case: Case, other: Other) -> None:
    """Accelerations, rates of states, all variables and the energy are those of the base."""
    base = case.reference
    derivation = derive(mixed.model_of(other.system))
    tree, network = derivation.structure, derivation.formulation.network
    first = tree.layout.mechanical
    keys, signs = [], []
    for kind, place in [state.key for state in network.states] if network else []:
        name, dot, label = place.partition(".")
        former = other.former.get(place) or f"{_component(other, name)}{dot}{label}"
        keys.append((kind, former))
        signs.append(other.signs.get(former, 1) if kind != "s" else 1)
    turned = np.array(signs, dtype=float)
    q, v, u = case.named()
    kept = base.kept(keys) * turned if keys else np.zeros((STATES, 0))
    v = v | {x.name: kept[:, k] for k, x in enumerate(tree.velocities[first:])}
    r = reference_of(derivation.system, base.t, q, v, u)
    names = [quantity.name for quantity in base.tree.velocities]
    order = [names.index(x.name) for x in tree.velocities[:first]]
    rates = rate(base.moved.kept(keys)) * turned if keys else kept
    expected = np.hstack((base.acceleration[:, order], rates))
    assert error(r.acceleration, expected) <= SAME
    pairs = [(other.signs.get(former, 1), former, now) for now, former in other.former.items()]
    for place in (0, 1):
        found = [r.network[now][place] for _, former, now in pairs if former in base.network]
        given = [
            s * base.network[former][place] for s, former, _ in pairs if former in base.network
        ]
        assert not found or error(np.array(found).T, np.array(given).T) <= SAME
    sums = np.sum(base.energy, axis=1), np.sum(r.energy, axis=1)
    assert error(sums[1], sums[0]) <= SAME


def _component(other: Other, name: str) -> str:
    edge = next((e for e in other.former if e.partition(".")[0] == name), name)
    return other.former.get(edge, edge).partition(".")[0]


def as_it_is(system: System) -> dict[str, str]:
    return {port.edge: port.edge for part in system.parts for port in part.ports}


def another_tree(system: System, rng: np.random.Generator) -> Other:
    """Other stores as states, other branches."""
    edges = [p.edge for part in system.parts for p in part.ports if p.between is not None]
    rng.shuffle(edges)
    return Other(replace(system, wanted=tuple(edges[: 1 + len(edges) // 2])), {}, as_it_is(system))


def turned_around(system: System, rng: np.random.Generator) -> Other:
    """Some passive components reversed, everything renamed and in another order."""
    found, signs = mixed.reversed_parts(system, rng)
    found, edges = mixed.renamed(found)
    return Other(mixed.reordered(found, rng), signs, {new: old for old, new in edges.items()})


def with_another_tree(case: Case) -> None:
    compared(case, another_tree(case.system, case.rng))


def turned_and_renamed(case: Case) -> None:
    compared(case, turned_around(case.system, case.rng))


CHECKS = (audited, massive, conserved, with_another_tree, turned_and_renamed)


def problems(seed: int) -> Iterator[str]:
    """What does not hold of one system."""
    found: list[Case] = []

    def derived() -> None:
        found.append(case_of(seed))

    yield from problem_of(derived)
    for check in CHECKS if found else ():
        yield from problem_of(check, found[0])


@pytest.mark.seeds(FEW, CHUNKS)
def test_balances_and_invariance(seed: int) -> None:
    """Worst measured: powers 3e-15, components 2e-15, energy 3e-14, 𝓜 6e-15, another description 3e-14."""
    found = failures(chunk(seed), problems)
    assert not found, "\n".join(found)


@pytest.mark.seeds(range(0, SYSTEMS, 360), range(0, SYSTEMS, 60))
def test_other_coordinates_of_mechanics_move_alike(seed: int) -> None:
    """Inertia edges as branches: the joints that carry networks are chords then, with constraints."""
    held(range(seed, seed + 60, 6), on_inertia_edges)


def on_inertia_edges(seed: int) -> None:
    """Every body on its inertia edge; v̇ is compared by the motion of mass centres, networks as they are."""
    case = case_of(seed)
    system, base = case.system, case.reference
    network = base.tree.network
    if system.tree.couplings or network is None or any(base_inertia(case)):
        return
    model = variant(mixed.model_of(system).system(), coordinates="absolute")
    derivation = derive(model)
    n, m = base.first, derivation.structure.layout.mechanical
    q, v = [], []
    for k in range(3):
        at = (None, float(base.t[k]), list(base.u[k]))
        source, target = base.derivation.numeric(*at), derivation.numeric(*at)
        there, moving = transfer(source, list(base.q[k]), list(base.v[k]), target)
        q.append(there)
        v.append([*moving[:m], *base.v[k, n:]])
    r = Reference.at(derivation, base.t[:3], np.array(q), np.array(v), base.u[:3])
    assert error(r.acceleration[:, m:], base.acceleration[:3, n:]) <= SAME
    for name, (x, y) in r.network.items():
        assert error(x, base.network[name][0][:3]) <= SAME
        assert error(y, base.network[name][1][:3]) <= SAME
    assert error(motions(r, 3), motions(base, 3)) <= SAME


def motions(r: Reference, count: int) -> Array:
    """Accelerations of all mass centres."""
    names = list(r.model.bodies)
    found = [[r.scheme.center(name).pull, r.scheme.center(name).spin] for name in names]
    return r.stacked(found).reshape(len(r.t), -1)[:count]


def base_inertia(case: Case) -> list[bool]:
    """Whether networks reflect inertia to edges in mechanics."""
    network = case.reference.tree.network
    count = len(network.states)
    return [i >= count or j >= count for i, j in network.mass]


# ---- e: a tableau

APART_SYSTEMS, APART_STATES = 150, 5


def apart(seed: int) -> None:
    """Accelerations, rates, all across and through variables, the energy: by equations assembled apart."""
    case = case_of(seed, APART_STATES)
    system, states, r = case.system, case.states, case.reference
    q, v, u = case.named()
    bare = reference_of(mixed.model_of(system, bare=True), states.t, q, v, u)
    right = bare.forces - bare.bias
    X, Y = variables(case)
    for part in system.parts:
        if part.kind == "law":
            element = next(e for e in r.model.elements if e.name == part.name)
            Y[part.name] = r.stacked(r.scheme.tension(element)[1])
    network = r.tree.network
    keys = [state.key for state in network.states] if network else []
    edges = [p.edge for part in system.parts for p in part.ports if p.between is not None]
    tableau = Tableau(system)
    for k in range(APART_STATES):
        given = {name: float(x[k]) for name, x in u.items()}
        at = Instant(*states.whole[k], float(states.t[k]), given, bare.mass[k], right[k])
        z = dict(zip(keys, r.v[k, r.first :], strict=True))
        start = {("X", e): X[e][k] for e in edges} | {("Y", e): Y[e][k] for e in edges}
        found = tableau.solve(at, z, start if network and network.loop else None)
        rates = [found.rates[key] for key in keys]
        assert error([[*found.acceleration, *rates]], r.acceleration[k : k + 1]) <= APART
        for kind, all_of in (("X", X), ("Y", Y)):
            names = list(all_of)
            values = [[found.values[(kind, name)] for name in names]]
            assert error(values, [[all_of[name][k] for name in names]]) <= APART
        assert error([found.energy], r.energy[k : k + 1, 2]) <= APART


@pytest.mark.seeds(range(0, APART_SYSTEMS, 6 * CHUNK), range(0, APART_SYSTEMS, CHUNK))
def test_a_tableau_agrees(seed: int) -> None:
    """Worst measured 8e-13; algebraic loops start at the reference's solution."""
    held(chunk(seed), apart)


def test_every_law_of_the_tableau_is_used() -> None:
    """Every kind of part is among the systems, and each state of them somewhere."""
    seen: dict[str, int] = {}
    for seed in range(APART_SYSTEMS):
        for kind in {part.kind for part in mixed.random_system(seed).parts}:
            seen[kind] = seen.get(kind, 0) + 1
    assert set(seen) == set(mixed_tableau.LAWS)
    assert min(seen.values()) >= 3, seen


# ---- emitted code


def arguments(emitted: Any, r: Reference) -> dict[str, Array]:
    """What emitted functions take."""
    return {
        "p": getattr(emitted, "DEFAULT_PARAMETERS", None),
        "t": r.t,
        "q": r.q,
        "v": r.v,
        "u": r.u,
        "a": r.acceleration,
    }


def call(emitted: Any, name: str, given: Mapping[str, Array]) -> Any:
    function = getattr(emitted, name)
    return function(*(given[key] for key in inspect.signature(function).parameters))


def told(r: Reference) -> dict[str, Array]:
    """What functions of edges say, in emitted order."""
    across = r.stacked([x for pair in r.scheme.across().values() for part in pair for x in part])
    reactions = [x for name in r.tree.ends for part in r.scheme.reaction(name) for x in part]
    pairs = r.network.values()
    X, Y = (np.array([pair[k] for pair in pairs]).reshape(len(pairs), len(r.t)).T for k in (0, 1))
    return {
        "across": np.hstack((across, X)),
        "reactions": np.hstack((r.stacked(reactions), Y)),
    }


@pytest.mark.seeds(range(0, SYSTEMS, 360), range(0, SYSTEMS, 60))
def test_emitted_python_says_the_same(seed: int, tmp_path: Path) -> None:
    def check(seed: int) -> None:
        case = case_of(seed)
        r, name = case.reference, case.system.name
        files = render(r.model, languages=["python"], functions=("power",))
        emitted = load(files, name, tmp_path)
        given = arguments(emitted, r)
        mass, bias = call(emitted, "equations", given)
        assert error(np.broadcast_to(mass, r.mass.shape), r.mass) <= EXACT
        assert error(bias, r.bias) <= EXACT
        assert error(call(emitted, "forward_dynamics", given), r.acceleration) <= SOLVED
        back = call(emitted, "inverse_dynamics", given)
        assert error(np.real(back) + r.bias, r.forces + r.bias) <= SOLVED
        assert error(call(emitted, "energy", given), r.energy) <= EXACT
        for function, expected in told(r).items():
            assert error(call(emitted, function, given), expected) <= SOLVED
        found, sums = call(emitted, "power", given)
        assert np.max(np.abs(sums)) <= AUDIT * (1 + np.max(np.abs(found)))

    held(range(seed, seed + 60, 7), check)


@pytest.mark.parametrize("first", range(3, SYSTEMS, 100))
def test_emitted_c_says_the_same(first: int, tmp_path: Path) -> None:
    def check(seed: int) -> None:
        case = case_of(seed, 4)
        r, name = case.reference, case.system.name
        only = ("equations", "forward_dynamics", "energy", "across", "reactions")
        files = render(r.model, only=only)
        python, compiled = load(files, name, tmp_path), Compiled(files, name, tmp_path)
        n = r.v.shape[1]
        sizes = {
            "equations": [(n, n), (n,)],
            "forward_dynamics": [(n,)],
            "energy": [(3,)],
            "across": [(python.NX,)],
            "reactions": [(python.NR,)],
        }
        expected = {**told(r), "energy": r.energy, "forward_dynamics": r.acceleration}
        for k in range(4):
            given = {
                key: x if x is None else x[k]
                for key, x in arguments(python, r).items()
                if key != "p"
            }
            given |= {"t": float(r.t[k]), "p": None}
            for function, out in sizes.items():
                names = inspect.signature(getattr(python, function)).parameters
                found = compiled.call(function, *(given[key] for key in names), out=out)
                if function == "equations":
                    assert error(found[0][None], r.mass[k : k + 1]) <= EXACT
                    assert error(found[1][None], r.bias[k : k + 1]) <= EXACT
                else:
                    assert error(found[None], expected[function][k : k + 1]) <= SOLVED

    held(range(first, first + 100, 27), check)
