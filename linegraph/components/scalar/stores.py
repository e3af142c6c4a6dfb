"""Stores with one edge: a kept variable, and the rate of its charge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.body import COMMON_NAMES, GROUND
from linegraph.components.domains import DOMAINS
from linegraph.components.scalar.base import ACROSS, STATIC, THROUGH, OnePort, Own, OwnState
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Store(OnePort):
    """A store by a constant, by its charge as a function of the variable kept, or by its co-energy.

    With k the variable kept, ``W' = constant k² / 2``, and the other variable is ``d/dt ∂W'/∂k``. It stores
    ``k ∂W'/∂k - W'`` (J).
    """

    keeps: ClassVar[str]
    charge_field: ClassVar[str] = ""
    grounded: ClassVar[bool] = False
    """Whether one of its ends must be ground, from which the variable it keeps is measured."""

    def constant(self, at: Terminals) -> Scalar:
        """The charge for a unit of the variable kept.

        Args:
            at: the component's variables.
        """
        raise NotImplementedError

    def kept(self) -> tuple[str, ...]:
        """Its across or its through variable, depending on its type."""
        return (self.keeps,)

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``constant k² / 2`` (J), or as given; 0 of a charge, which the network integrates."""
        given = getattr(self, "coenergy", None)
        if given is not None:
            return self._law(at, given)
        if self._charge is not None:
            return 0
        kept = at.X[0] if self.keeps == ACROSS else at.Y[0]
        return self.constant(at) * (kept * kept / 2)

    def charges(self, at: Terminals) -> tuple[Scalar, ...] | None:
        """The charge where it is given as such; else None, and it follows from the co-energy."""
        return None if self._charge is None else (self._law(at, self._charge),)

    def require_fields(self) -> None:
        """Refuse also a store that is measured from ground and does not end there.

        Raises:
            ModelError: a field is missing or one too many, or neither end is ground.
        """
        super().require_fields()
        if self.grounded and GROUND not in self.between:
            meant = next((v for v in self.between if v.lower() in COMMON_NAMES), None)
            hint = "" if meant is None else f'; is "{meant}" meant to be "{GROUND}"?'
            problem = (
                f"one of its ends must be {GROUND}, from where its {self._measured} is measured; it has "
                f"{' and '.join(self.between)}{hint}"
            )
            raise ModelError(f'{self.kind} "{self.name}"', problem)

    @property
    def _measured(self) -> str:
        return DOMAINS[self.domain_name].across.name

    @property
    def _charge(self) -> Any:
        return getattr(self, self.charge_field) if self.charge_field else None

    def _law(self, at: Terminals, given: Any) -> Scalar:
        return at.value(given, x=at.X[0]) if self.keeps == ACROSS else at.value(given, y=at.Y[0])


@dataclass(frozen=True)
class AcrossStore(Store):
    """A store of the A-type: ``Y = d/dt Q(X)``.

    It keeps X, as a capacitor its voltage and a mass its velocity [Rowell and Wormley 1997].
    """

    keeps = ACROSS


@dataclass(frozen=True)
class ThroughStore(Store):
    """A store of the T-type: ``X = d/dt Λ(Y)``.

    It keeps Y, as an inductor its current and a spring its force [Rowell and Wormley 1997].
    """

    keeps = THROUGH


@dataclass(frozen=True)
class Spring1D(OnePort):
    """A spring in 1-D mechanics: by its stiffness, or by a force or an energy of its displacement.

    X is the velocity of the tail relative to the head, Y the force (N) or torque (N m) that presses the ends
    together. Linear, ``dY/dt = stiffness X``, it keeps Y and stores ``Y² / (2 stiffness)`` (J). Else its
    displacement x is a state, ``dx/dt = X``, and ``Y = force(x)`` or ``Y = dE/dx`` of its energy: the force
    alone does not determine x where it is not monotonic.

    Attributes:
        stiffness: N/m, or N m/rad; it keeps its force; or
        force: an expression of its displacement x, which then is its state; or
        energy: the same, its energy (J), of which the force is the derivative.
    """

    stiffness: Any = None
    force: Any = None
    energy: Any = None
    own: ClassVar[Own] = {"force": ("x",), "energy": ("x",)}
    needs = (("stiffness", "force", "energy"),)

    def kept(self) -> tuple[str, ...]:
        """Its force or torque, if it is linear; else nothing."""
        return (THROUGH if self.stiffness is not None else STATIC,)

    def states(self) -> tuple[OwnState, ...]:
        """Its displacement x (m or rad), if it is not linear."""
        letter, unit, about = DOMAINS[self.domain_name].across.integral
        return () if self.stiffness is not None else (OwnState("x", letter, unit, about),)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual: Y less the force or torque of the displacement; 0 of a linear spring."""
        if self.stiffness is not None:
            return (0,)
        x = at.states["x"]
        if self.force is not None:
            return (at.Y[0] - at.value(self.force, x=x),)
        return (at.Y[0] - at.derivative(at.value(self.energy, x=x), x),)

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``Y² / (2 stiffness)`` (J) of a linear spring; else 0."""
        return 0 if self.stiffness is None else at.Y[0] * at.Y[0] / (2 * at.value(self.stiffness))

    def rates(self, at: Terminals) -> tuple[Scalar, ...]:
        """``dx/dt = X``, if the displacement is a state."""
        return () if self.stiffness is not None else (at.X[0],)

    def own_energy(self, at: Terminals) -> Scalar:
        """The energy at x (J), if it is given; 0 of a force, which the network integrates."""
        return 0 if self.energy is None else at.value(self.energy, x=at.states["x"])
