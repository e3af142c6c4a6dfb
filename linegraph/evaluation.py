"""Numeric functions of a derivation: the emitted Python, loaded without writing a file."""

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
"""Name of the function that evaluates a SymPy expression."""

FRAME_FUNCTIONS = "frame_"
"""Prefix of the names of a frame's functions."""


@dataclass(frozen=True)
class Function:
    """An emitted function, ready to be called.

    Attributes:
        name: its name.
        arguments: names of its arguments, in order.
        model: name of the model.
        source: text of the Python module that contains it.
        module: the loaded module.
        single: whether the result is one number instead of an array.
    """

    name: str
    arguments: tuple[str, ...]
    model: str
    source: str
    module: Any
    single: bool = False

    def __call__(self, *given: Any, parameters: Mapping[str, float] | None = None) -> Any:
        """Call the function with one state, or with many: the last axis of an array is that of one state.

        Args:
            given: q, v, ... in the order of `arguments`, in SI units.
            parameters: values in place of the model's own.

        Returns:
            An array with the shape of the result after the leading axes of the arguments, or a tuple of
            arrays.

        Raises:
            ModelError: the number of arguments is wrong, or there is no such parameter.
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
        """Return its name and arguments."""
        return f"<function {self.name}({', '.join(self.arguments)}) of {self.model}>"


def function(derivation: Derived, what: Any, frames: Iterable[str] = ()) -> Function:
    """Return an emitted function by name, or a function that evaluates a SymPy expression.

    Args:
        derivation: the model.
        what: name of a function, or a SymPy expression or matrix in the derivation's symbols.
        frames: bodies, or frames of bodies as ``body.frame``, whose functions are available by name.

    Raises:
        ModelError: there is no such function, or a symbol does not belong to the derivation.
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
    """Key of `PROGRAMS` that creates a function, where it follows from the function's name."""
    if what.startswith(FRAME_FUNCTIONS):
        kinds = [key for key in OF_FRAMES if what.endswith(key)]
        return (*kinds, "frames")[:1]
    return (what,) if what in PROGRAMS else ()


def _of_expression(derivation: Derived, name: str, what: Any) -> Function:
    """Function of an expression or matrix, with those of q, v, u, a as arguments on which it depends."""
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
    # A column matrix becomes a vector: NumPy users expect shape (n,), not (n, 1).
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
    """Load one function of a module.

    Args:
        derivation: the model.
        module: the programs, rendered as Python.
        name: name of the function.
        single: whether its result is an array of one number, to be returned as a number.
    """
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
