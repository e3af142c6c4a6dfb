"""Names of the symbols in a derivation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.dynamics.chords import equations
from linegraph.model.name_register import Claim, FreeNames, declared, require_distinct

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.kinematics.formulated import Formulated

MULTIPLIERS = "lam"


def symbol_names(derivation: Formulated) -> dict[str, tuple[str, ...]]:
    """The names of all entries of each argument: distinct, and different from all declared names.

    Coordinates and velocities keep their own names; the rate of a coordinate x is ``x_dot``. Any other
    symbol gets the first free name of a list: a state of a network its own name, then ``state_v_C``; an
    acceleration ``a_x``, ``x_ddot`` (``a_w``, ``w_dot`` if w is no rate of a coordinate); an effort
    ``u_x``, ``effort_x``; a multiplier and an unknown of an algebraic loop its own name, then that name
    after ``lam_`` or ``loop_``; after these, the last one with a number.

    Raises:
        ModelError: the model declares a name twice; names both owners.
    """
    model, tree = derivation.system, derivation.structure
    network = derivation.formulation.network
    owners = require_distinct([*declared(model), *_of_networks(derivation)], model.places)
    positions = [quantity.name for quantity in tree.positions]
    velocities = [quantity.name for quantity in tree.velocities]
    free = FreeNames(model.parameters)
    rates = [
        free.name(f"{name}_dot" if name in positions else name, f"state_{name}")
        for name in velocities
    ]
    free.take(*owners, *positions)
    accelerations = [
        free.name(f"a_{name}", f"{name}_ddot" if name in positions else f"{name}_dot")
        for name in velocities
    ]
    efforts = {
        velocity.name
        for joint in model.joints
        if joint.effort and joint.drive is None
        for velocity in joint.velocities()
    }
    inputs = [
        free.name(f"u_{x.name}", f"effort_{x.name}") if x.name in efforts else x.name
        for x in tree.inputs
    ]
    multipliers = (equation.multiplier.name for equation in equations(tree))
    loops = () if network is None else network.loop_names
    return {
        "q": tuple(positions),
        "v": tuple(rates),
        "u": tuple(inputs),
        "a": tuple(accelerations),
        MULTIPLIERS: tuple(free.name(name, f"lam_{name}") for name in multipliers),
        "loop": tuple(free.name(name, f"loop_{name}") for name in loops),
    }


def _of_networks(derivation: Formulated) -> Iterator[Claim]:
    """The names that networks add: their states, and derivatives of inputs that they need.

    A state with the name of a parameter is left out: in emitted code they are different arguments.
    """
    network = derivation.formulation.network
    if network is None:
        return
    for state in network.states:
        if state.quantity.name in derivation.system.parameters:
            continue
        owner = network.owner(state)
        thing = f'{owner.kind} "{owner.name}"'
        yield Claim(state.quantity.name, thing, "its state", f"a state of {thing}")
    for name, order in network.rates.items():
        for suffix in ("rate", "acceleration")[:order]:
            thing = f'input "{name}"'
            what = f"the derivative of {thing} that networks need"
            yield Claim(f"{name}_{suffix}", thing, "its derivative", what)
