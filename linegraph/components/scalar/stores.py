"""What stores with one edge have in common: the charge of a kept variable."""

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
    """A store by a constant, by its charge as a function of what it keeps, or by its co-energy.

    With k what is kept, ``W' = constant k² / 2``, and the other variable is ``d/dt ∂W'/∂k``.
    """

    keeps: ClassVar[str]
    charge_field: ClassVar[str] = ""
    grounded: ClassVar[bool] = False
    """Whether one of its ends is ground: what it keeps is measured from there."""

    def constant(self, at: Terminals) -> Scalar:
        """The charge for one of what is kept."""
        raise NotImplementedError

    def kept(self) -> tuple[str, ...]:
        """Its across variable, or its through variable."""
        return (self.keeps,)

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """Half the constant times the square of what is kept, or as given; not known of a charge."""
        given = getattr(self, "coenergy", None)
        if given is not None:
            return self._law(at, given)
        if self._charge is not None:
            return 0
        kept = at.X[0] if self.keeps == ACROSS else at.Y[0]
        return self.constant(at) * (kept * kept / 2)

    def charges(self, at: Terminals) -> tuple[Scalar, ...] | None:
        """The charge where it is given as such."""
        return None if self._charge is None else (self._law(at, self._charge),)

    def require_fields(self) -> None:
        """Refuse also a store that is measured from ground and does not end there."""
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
    """A store of the A-type: ``Y = d/dt Q(X)``."""

    keeps = ACROSS


@dataclass(frozen=True)
class ThroughStore(Store):
    """A store of the T-type: ``X = d/dt Λ(Y)``."""

    keeps = THROUGH


@dataclass(frozen=True)
class Spring1D(OnePort):
    """A spring in 1-D mechanics: by its stiffness, or by a force or an energy of its displacement.

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
        """Its force, if it is linear."""
        return (THROUGH if self.stiffness is not None else STATIC,)

    def states(self) -> tuple[OwnState, ...]:
        """Its displacement, if it is not."""
        letter, unit, about = DOMAINS[self.domain_name].across.integral
        return () if self.stiffness is not None else (OwnState("x", letter, unit, about),)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """The force of its displacement."""
        if self.stiffness is not None:
            return (0,)
        x = at.states["x"]
        if self.force is not None:
            return (at.Y[0] - at.value(self.force, x=x),)
        return (at.Y[0] - at.derivative(at.value(self.energy, x=x), x),)

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``Y² / (2 stiffness)``."""
        return 0 if self.stiffness is None else at.Y[0] * at.Y[0] / (2 * at.value(self.stiffness))

    def rates(self, at: Terminals) -> tuple[Scalar, ...]:
        """The displacement grows with X."""
        return () if self.stiffness is not None else (at.X[0],)

    def own_energy(self, at: Terminals) -> Scalar:
        """As given; not known of a force."""
        return 0 if self.energy is None else at.value(self.energy, x=at.states["x"])
