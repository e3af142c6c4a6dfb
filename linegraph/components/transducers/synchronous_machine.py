"""Machines with several windings and a rotor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import STATIC, THROUGH, Component, Pair, Port, Transducer
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class SynchronousMachine(Component):
    """Windings on a stator and a rotor at angle x: ``W' = i^T inductance i / 2 + i^T flux``.

    ``X = resistance i + d/dt (inductance i + flux)``, and it drives with ``∂W'/∂x``. Two phases, three, any
    number, with a field winding or with magnets. Its edges are
    "winding1", "winding2", ... and "mechanical".

    X is the column of the windings' voltages (V), i that of their currents (A), inductance and flux are
    functions of the mechanical angle x (rad), which for p pole pairs enters as ``p x``. The torque (N m) is
    ``i^T inductance'(x) i / 2 + i^T flux'(x)``; the energy of the magnets alone, and with it the
    cogging torque, is not part of W' [Woodson and Melcher 1968, sec. 4.2.4].

    Attributes:
        windings: the vertices of each, (tail, head).
        inductance: the matrix, row by row (H), of expressions of the angle x.
        flux: the flux linkage of the magnets in each winding (V s), expressions of x; none if left out.
        resistance: of each winding (ohm).
        joint: the joint it drives; or
        shaft: the vertices of its edge in a network of 1-D rotation.

    Example:
        >>> pair = (("a", "ground"), ("b", "ground"))
        >>> L = (("L", 0), (0, "L"))
        >>> turning = ("psi*cos(x)", "psi*sin(x)")
        >>> SynchronousMachine("m", pair, L, turning, 0.5, joint="axle").kept()
        ('through', 'through', '')
    """

    windings: tuple[Pair, ...]
    inductance: tuple[tuple[Any, ...], ...] = ()
    flux: tuple[Any, ...] | None = None
    resistance: Any = 0
    joint: str | None = None
    shaft: Pair | None = None
    kind = "synchronous_machine"
    own: ClassVar[Own] = {"inductance": ("x",), "flux": ("x",)}

    def ports(self) -> tuple[Port, ...]:
        """An electrical edge for each winding, then the mechanical one."""
        phases = (
            Port(f"winding{k + 1}", ELECTRICAL.name, ends) for k, ends in enumerate(self.windings)
        )
        rotor = _Rotor(self.name, ("", ""), joint=self.joint, shaft=self.shaft)
        return (*phases, rotor.mechanical())

    def kept(self) -> tuple[str, ...]:
        """The current of every winding; nothing in mechanics."""
        return (*(THROUGH,) * len(self.windings), STATIC)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Voltages of the resistances (V); Y alone in mechanics, where the co-energy adds the torque."""
        resistance = at.value(self.resistance)
        return (*(resistance * y for y in at.Y[:-1]), at.Y[-1])

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``W'(i, x) = i^T inductance i / 2 + i^T flux`` (J), each mutual inductance counted once."""
        total: Scalar = 0
        for i, row in enumerate(self.inductance):
            for j, entry in enumerate(row[: i + 1]):
                half = at.Y[i] * at.Y[i] / 2 if i == j else at.Y[i] * at.Y[j]
                total = total + at.value(entry, x=at.x) * half
        for y, linkage in zip(at.Y, self.flux or (), strict=False):
            total = total + at.value(linkage, x=at.x) * y
        return total

    def dissipation(self, at: Terminals) -> Scalar:
        """Heat of the windings: ``resistance i^T i`` (W)."""
        squares: Scalar = 0
        for y in at.Y[:-1]:
            squares = squares + y * y
        return at.value(self.resistance) * squares

    @property
    def displaced(self) -> bool:
        """True: inductance and flux depend on the angle."""
        return True

    def require_fields(self) -> None:
        """Refuse a machine without windings, and matrices that do not fit them.

        Raises:
            ModelError: no winding, a matrix or a list of another size, or a matrix that is not symmetric as
                it is written.
        """
        n, who = len(self.windings), f'{self.kind} "{self.name}"'
        rows = self.inductance
        if n < 1:
            raise ModelError(who, "windings: at least one is needed, each [tail, head]")
        if len(rows) != n or any(len(row) != n for row in rows):
            raise ModelError(who, f"inductance: a {n} x {n} matrix is needed for {n} windings")
        if any(str(rows[i][j]) != str(rows[j][i]) for i in range(n) for j in range(i)):
            raise ModelError(who, "inductance: the matrix is not symmetric")
        if self.flux is not None and len(self.flux) != n:
            raise ModelError(who, f"flux: {n} linkages are needed for {n} windings")


@dataclass(frozen=True)
class _Rotor(Transducer):
    """The place of the rotor: its port in mechanics."""

    kind = SynchronousMachine.kind
    domain_name = ELECTRICAL.name
    turns = True
