"""Twins: one class of component with a type for each of several power subspaces.

A damper obeys ``Y = damping X`` whether it slides or turns, and a source prescribes a voltage as it would a
pressure. Such a law is written once, in one class; the names of types and keys, and the units, which differ
from subspace to subspace, are data. Each type is a dataclass of its own, because the reader of model
files, the schema and the builder take keys and descriptions from its fields and its docstring.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, make_dataclass
from inspect import cleandoc
from typing import TYPE_CHECKING, Any, TypeVar

from linegraph.components.scalar.base import Component, TwoPort
from linegraph.components.scalar.sources import AcrossSource, ThroughSource

if TYPE_CHECKING:
    from linegraph.components.domains import Domain

One = TypeVar("One", bound=Component)


@dataclass(frozen=True)
class Twins:
    """The types that classes become in one power subspace.

    Attributes:
        domain: the subspace of their edges.
        module: the file they are assigned in, its ``__name__``, where copies look for them.

    Example:
        >>> from linegraph.components.domains import ELECTRICAL
        >>> kind = Twins(ELECTRICAL, __name__).across_source("battery", "voltage")
        >>> kind("B", ("plus", "ground"), voltage=12.0)
        Battery(name='B', between=('plus', 'ground'), voltage=12.0)
    """

    domain: Domain
    module: str

    def of(self, one: type[One], kind: str, about: str, /, **keys: str) -> type[One]:
        """The type of one class in this subspace.

        Its docstring is `about`, followed by the class's docstring from the second paragraph on, and by the
        keys.

        Args:
            one: the class, with the law; it reads the value of an added key by `required`.
            kind: the type's name in model files; the class is called the same in CamelCase.
            about: the first line of its docstring, with its equation.
            keys: what each key means, with its unit. A key that the class does not have becomes a field of
                the type, and must be given.

        Returns:
            A frozen dataclass on the class.
        """
        added = tuple(key for key in keys if key not in {f.name for f in fields(one)})
        _, _, rest = cleandoc(one.__doc__ or "").partition("\n\n")
        common, section, told = rest.partition("Example:")[0].partition("Attributes:")
        if keys:
            told = "".join(f"\n    {key}: {text}" for key, text in keys.items())
        parts = (about, common.strip(), f"Attributes:{told.rstrip()}\n" if section or keys else "")
        name = self.domain.name
        ends = {"domain_names": (name, name)} if issubclass(one, TwoPort) else {"domain_name": name}
        constants: dict[str, Any] = {"kind": kind, **ends}
        if added:
            constants["required"] = (*one.required, *added)
        made: type[One] = make_dataclass(
            kind.title().replace("_", ""),
            [(key, Any, None) for key in added],
            bases=(one,),
            namespace={
                **constants,
                "__doc__": "\n\n".join(part for part in parts if part),
                "__module__": self.module,
            },
            frozen=True,
        )
        return made

    def across_source(self, kind: str, key: str) -> type[AcrossSource]:
        """The source of this subspace's across variable.

        Args:
            kind: the type's name in model files.
            key: the name of the prescribed value.
        """
        about = f"A source: ``X = {key}``, tail over head."
        return self.of(AcrossSource, kind, about, **{key: _given(self.domain.across.symbol)})

    def through_source(self, kind: str, key: str) -> type[ThroughSource]:
        """The source of this subspace's through variable.

        Args:
            kind: the type's name in model files.
            key: the name of the prescribed value.
        """
        about = f"A source: ``Y = {key}``, through it from tail to head."
        return self.of(ThroughSource, kind, about, **{key: _given(self.domain.through.symbol)})


def _given(unit: str) -> str:
    """The description of a prescribed value: its unit, and the kinds of value allowed."""
    return f"{unit.replace('*', ' ')}: a number, an input, an expression of t or of any variable."
