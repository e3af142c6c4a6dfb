"""Workspace of a derivation that compute: the emitted Python, loaded without a file."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.abc import SourceLoader
from importlib.util import module_from_spec, spec_from_loader
from typing import TYPE_CHECKING, Any

import sympy

import codegen
from linegraph.algebra.sympy_scalars import evaluate
from linegraph.components.validation import nearest
from linegraph.errors import ModelError
from linegraph.ir.program import PREPARED_SUFFIX, Module, Result, reads
from linegraph.ir.prologue import PREPARE
from linegraph.programs.frame_names import named_frames
from linegraph.programs.register import OF_FRAMES, PROGRAMS, module_of, parameters_of
from linegraph.programs.request import Request
from linegraph.programs.workspace import Workspace

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from linegraph.numeric.derived import Derived

NAME = "expression"
"""The function that computes a sympy expression."""

FRAME_FUNCTIONS = "frame_"
"""How the names of functions of frames begin."""


@dataclass(frozen=True)
class Function:
    """An emitted function, ready to be called.

    Attributes:
        name: its own.
        arguments: the names of what it takes.
        model: the name of the model.
        source: the Python it is from.
        module: the same, loaded.
        single: whether what it computes is one number and no array.
    """

    name: str
    arguments: tuple[str, ...]
    model: str
    source: str
    module: Any
    single: bool = False

    def __call__(self, *given: Any, parameters: Mapping[str, float] | None = None) -> Any:
        """Call it with one state, or with many: arrays whose last axis is that of one.

        Args:
            given: q, v, ... as `arguments` lists them.
            parameters: values in place of the model's own.

        Raises:
            ModelError: there are more or fewer arguments, or no such parameter.
        """
        if len(given) != len(self.arguments):
            problem = f"takes {', '.join(self.arguments) or 'nothing'}; got {len(given)} arguments"
            raise ModelError(f'function "{self.name}"', problem)
        values = self._parameters(parameters or {})
        found = getattr(self.module, self.name)(*values, *given)
        return found[..., 0] if self.single else found

    def _parameters(self, given: Mapping[str, float]) -> tuple[Any, ...]:
        own = getattr(self.module, "DEFAULT_PARAMETERS", None)
        known = () if own is None else [*own._values()]
        for name in given:
            if name not in known:
                raise ModelError(f'parameter "{name}"', f"is not there; {nearest(name, known)}")
        if own is None:
            return ()
        return (own.replace(**given) if given else own,)

    def __repr__(self) -> str:
        """Its name and arguments."""
        return f"<function {self.name}({', '.join(self.arguments)}) of {self.model}>"


def function(derivation: Derived, what: Any, frames: Iterable[str] = ()) -> Function:
    """An emitted function by its name, or one that computes a sympy expression.

    Raises:
        ModelError: there is no such function, or a symbol is not of this derivation.
    """
    name = codegen.naming.identifier(derivation.system.name)
    if not isinstance(what, str):
        return _of_expression(derivation, name, what)
    if what == PREPARE or what.endswith(PREPARED_SUFFIX):
        problem = "the order of its constants is that of one emitted file; ask for the function without them"
        raise ModelError(f'function "{what}"', problem)
    folded = not derivation.system.parameters
    named = named_frames(derivation.system, frames)
    only = _maker(what) if named or what in PROGRAMS else ()
    module = module_of(derivation, name, Request(folded, only=only, frames=named))
    known = [program.name for program in module.programs]
    if what in module.omitted:
        raise derivation.no_inverse([what])
    if what not in known:
        frame = "; its frame has to be in frames=(...)" * what.startswith(FRAME_FUNCTIONS)
        raise ModelError(f'function "{what}"', f"is not there; {nearest(what, known)}{frame}")
    return loaded(derivation, module, what)


def _maker(what: str) -> tuple[str, ...]:
    """The key of `PROGRAMS` that makes a function, where it is known by the function's name."""
    if what.startswith(FRAME_FUNCTIONS):
        kinds = [key for key in OF_FRAMES if what.endswith(key)]
        return (*kinds, "frames")[:1]
    return (what,) if what in PROGRAMS else ()


def _of_expression(derivation: Derived, name: str, what: Any) -> Function:
    """The function of an expression or a matrix: of q, v, u, a as far as it depends on them."""
    functions = Workspace(derivation, not derivation.system.parameters)
    whole = sympy.sympify(what, strict=True)
    dag, tree = functions.dag, functions.tree
    symbols = {
        symbol: dag.symbol(argument, k)
        for argument, names in derivation.symbol_names.items()
        for k, symbol in enumerate(names)
    }
    symbols |= {**functions.tree.parameters, "t": dag.symbol("t")}
    single = not isinstance(whole, sympy.MatrixBase)
    # a column is a vector to those who compute
    shape = (1,) if single else tuple(n for k, n in enumerate(whole.shape) if k == 0 or n != 1)
    try:
        entries = tuple(evaluate(e, dag, symbols) for e in ([whole] if single else whole))
    except ModelError as error:
        problem = f"{error}; it is no symbol of this derivation" if error.thing else str(error)
        raise ModelError("expression", problem) from None
    result = Result("values", shape, entries, "an expression of the model's symbols")
    given = tuple(argument for argument in functions.sizes if reads(argument, (result,)))
    program = functions.program(NAME, "An expression of the model's symbols.", given, (result,))
    state = (tree.positions, tree.velocities, tree.inputs)
    parameters = parameters_of(derivation)
    time = derivation.system.depends_on_time
    module = Module(name, (), *state, parameters, time, (program,))
    return loaded(derivation, module, NAME, single=single)


def loaded(derivation: Derived, module: Module, name: str, *, single: bool = False) -> Function:
    """A function of a module, ready to be called; `single` if it computes one number and no array."""
    (source,) = codegen.render(module, "python").values()
    program = next(p for p in module.programs if p.name == name)
    arguments = tuple(a.name for a in program.arguments if a.name != "p")
    loaded = _Loader(source).loaded(module.name)
    return Function(name, arguments, derivation.system.name, source, loaded, single)


class _Loader(SourceLoader):
    """Loads a module from its text."""

    def __init__(self, source: str) -> None:
        self._source = source

    def get_filename(self, fullname: str) -> str:
        return f"<{fullname}, emitted>"

    def get_data(self, path: str) -> bytes:
        return self._source.encode("ascii")

    def loaded(self, name: str) -> Any:
        specification = spec_from_loader(name, self)
        assert specification is not None
        module = module_from_spec(specification)
        self.exec_module(module)
        return module
