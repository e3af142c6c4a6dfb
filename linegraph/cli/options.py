"""Options of the commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

import codegen

if TYPE_CHECKING:
    from collections.abc import Callable

    Command = Callable[..., None]
    Option = Callable[[Command], Command]

FURTHER = (
    "linearize",
    "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
    "inverse_dynamics_parameter_derivatives",
    "forward_dynamics_parameter_derivatives",
    "center_of_mass",
    "center_of_mass_velocity",
    "center_of_mass_jacobian",
    "momentum",
    "centroidal_momentum_matrix",
    "centroidal_momentum_bias",
    "operational_space",
    "operational_position",
    "kinematics",
    "regressor",
    "inertial_parameters",
    "power",
)
"""Functions that `emit` writes only on request."""

FUNCTIONS = (
    "mass_matrix",
    "bias",
    "equations",
    "inverse_dynamics",
    "constraints",
    "forward_dynamics",
    "coordinate_rates",
    "energy",
    "rhs",
    "project",
    "reduction",
    "across",
    "reactions",
    "drives",
    "outputs",
    "frames",
    *FURTHER,
)
"""Functions whose names the command `emit` accepts."""

ON_REQUEST = ("power", "regressor", "inertial_parameters")
"""Functions that are written only if they are named."""


def with_options(options: tuple[Option, ...]) -> Option:
    """Return a decorator that adds options to a command, in this order."""

    def add(command: Command) -> Command:
        for option in reversed(options):
            command = option(command)
        return command

    return add


def assignment(text: str, option: str, default: float | None = None) -> tuple[str, float]:
    """Split NAME=VALUE; a name may itself contain an equals sign.

    Args:
        text: the text of the option, NAME=VALUE, or NAME alone if there is a default.
        option: the option, for messages.
        default: value for NAME alone; None if a value is required.

    Returns:
        The name and the value (rad or m).

    Raises:
        click.BadParameter: the value is not a number.
    """
    name, sign, value = text.rpartition("=")
    if not sign and default is not None:
        return text, default
    try:
        return name, float(value)
    except ValueError:
        raise click.BadParameter(
            f"{value!r} is not a number (rad or m)", param_hint=option
        ) from None


ABOUT_MODEL: tuple[Option, ...] = (
    click.argument("model", type=click.Path(path_type=str)),
    click.option(
        "--base",
        type=click.Choice(["fixed", "floating"]),
        default="fixed",
        show_default=True,
        help="Weld a URDF's root link to the ground, or let it float on a free joint named 'root'.",
    ),
    click.option(
        "--lock",
        "locks",
        metavar="JOINT[=VALUE]",
        multiple=True,
        help="Weld a joint at a value of its coordinate (rad or m; default 0). Repeatable.",
    ),
    click.option(
        "--parameters",
        type=click.Choice(["symbolic", "folded"]),
        help="Keep masses, moments and offsets as named parameters of the emitted functions, or fold "
        "their values into the code.  [default: symbolic for a model file, folded for a URDF]",
    ),
    click.option(
        "--snap",
        type=click.FloatRange(0, 0.01),
        default=1e-11,
        show_default=True,
        help="Round rotation entries this close to 0, 1, -1, 1/2 or -1/2 to these values: the dust of "
        "decimal angles.",
    ),
)
"""Argument and options of every command that reads a model."""

EMIT: tuple[Option, ...] = (
    click.option(
        "--out",
        metavar="DIR",
        type=click.Path(file_okay=False, path_type=str),
        default=".",
        help="Folder for the files; made if need be.  [default: the current folder]",
    ),
    click.option(
        "--name",
        metavar="NAME",
        help="Name of the files, and prefix of functions.  [default: the model's name]",
    ),
    click.option(
        "--with",
        "functions",
        type=click.Choice(FURTHER),
        metavar="FUNCTION",
        multiple=True,
        help="Write this function of those on request, too; repeatable.",
    ),
    click.option(
        "--frame",
        "frames",
        metavar="BODY[.FRAME]",
        multiple=True,
        help="Write pose, velocity, Jacobian and its rate of a body's frame: a link of a URDF, or a body "
        "or BODY.FRAME of a model file; repeatable.",
    ),
    click.option(
        "--only",
        type=click.Choice(FUNCTIONS),
        metavar="FUNCTION",
        multiple=True,
        help="Write nothing but this function, any of those above, and what it calls; repeatable. All frames "
        "are frames, all constraints constraints.",
    ),
    click.option(
        "--lang",
        "languages",
        type=click.Choice(codegen.LANGUAGES),
        multiple=True,
        help="Language to write; repeatable.  [default: all; with --arduino C alone]",
    ),
    click.option(
        "--trig",
        type=click.Choice(codegen.TRIG),
        default=codegen.TRIG[0],
        show_default=True,
        help="Sines and cosines in C: of <math.h>, or of the file itself, within 2 units in the last "
        "place and for all joints at once.",
    ),
    click.option(
        "--batch",
        is_flag=True,
        help="Write functions of many states in C, too: equations_batch(n, q, v, M, h) and the like, with "
        "several states side by side in vector registers.",
    ),
    click.option(
        "--tests",
        is_flag=True,
        help="Write golden vectors, too: NAME_test.c and test_NAME.py, which check the functions on the "
        "target against values found by another route.",
    ),
    click.option(
        "--real",
        type=click.Choice(codegen.REAL),
        default=codegen.REAL[0],
        show_default=True,
        help="The type of C's numbers; with float nothing is computed in doubles.",
    ),
    click.option(
        "--prefix",
        metavar="PREFIX",
        help="Prefix of functions, types and macros in C.  [default: the files' name]",
    ),
    click.option(
        "--report",
        is_flag=True,
        help="Say in the header what each function costs: operations by kind, variables, stack, lines.",
    ),
    click.option(
        "--cmake",
        is_flag=True,
        help="Write CMakeLists.txt, too: for add_subdirectory, or to install and find_package(NAME).",
    ),
    click.option(
        "--arduino",
        is_flag=True,
        help="Write C as a library of Arduino's: NAME/library.properties, NAME/src, NAME/examples.",
    ),
)
"""Further options of `emit`."""


def output(endings: str) -> Option:
    """Return the option for the output file."""
    return click.option(
        "-o",
        "--output",
        metavar="FILE",
        type=click.Path(dir_okay=False, path_type=str),
        help=f"The file to write: {endings}",
    )


WHAT = ("graph", "sketch", "both")

SET: Option = click.option(
    "--set",
    "held",
    metavar="COORDINATE=VALUE",
    multiple=True,
    help="Hold a coordinate at a value (rad or m). Repeatable.",
)
"""Option that holds a coordinate of the mechanism."""

GRAPH: tuple[Option, ...] = (
    output(".svg, .png or .dot, for Graphviz.  [default: SVG to standard output]"),
    click.option(
        "--subspace",
        "subspaces",
        metavar="NAME",
        multiple=True,
        help="Draw this subspace, e.g. translation or electrical; repeatable.  [default: all]",
    ),
    click.option(
        "--what",
        type=click.Choice(WHAT),
        default="graph",
        show_default=True,
        help="Draw the graph, a sketch of the mechanism, or both side by side.",
    ),
    SET,
)
"""Further options of `graph`."""

DERIVE: tuple[Option, ...] = (
    click.option(
        "--format",
        type=click.Choice(["text", "markdown", "latex", "html"]),
        help="What to write.  [default: as the ending of FILE says (.txt, .md, .tex, .html), else text]",
    ),
    output(".txt, .md, .tex or .html.  [default: to standard output]"),
    click.option(
        "--level",
        type=click.Choice(["none", "fast", "full"]),
        default="full",
        show_default=True,
        help="How far closed forms are simplified.",
    ),
)
"""Further options of `derive`."""
