"""The options that commands take."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from collections.abc import Callable

    Command = Callable[..., None]
    Option = Callable[[Command], Command]

LANGUAGES = ("c", "python")

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
    "power",
    "outputs",
    "regressor",
    "inertial_parameters",
)
"""What functions `emit` can be asked for."""

ON_REQUEST = ("power", "regressor", "inertial_parameters")
"""Those of them that are written only where they are asked for."""


def with_options(options: tuple[Option, ...]) -> Option:
    """A decorator that adds options to a command, in this order."""

    def add(command: Command) -> Command:
        for option in reversed(options):
            command = option(command)
        return command

    return add


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
"""The argument and options that every command on a model takes."""

EMIT: tuple[Option, ...] = (
    click.option(
        "--out",
        metavar="DIR",
        type=click.Path(file_okay=False, path_type=str),
        default=".",
        help="Folder for the files; made if need be.  [default: the current folder]",
    ),
    click.option(
        "--name", metavar="NAME", help="Prefix of functions and files.  [default: the model's name]"
    ),
    click.option(
        "--with",
        "functions",
        type=click.Choice(ON_REQUEST),
        metavar="FUNCTION",
        multiple=True,
        help="Further function to write; repeatable. power: the audit of through times across over all "
        "edges. regressor: Y of tau = Y pi, linear in masses, moments and friction. inertial_parameters: "
        "the model's own pi.",
    ),
    click.option(
        "--only",
        type=click.Choice(FUNCTIONS),
        metavar="FUNCTION",
        multiple=True,
        help="Write nothing but this function and what it calls; repeatable. "
        f"One of {', '.join(FUNCTIONS)}.",
    ),
    click.option(
        "--lang",
        "languages",
        type=click.Choice(LANGUAGES),
        multiple=True,
        help="Language to write; repeatable.  [default: all]",
    ),
    click.option(
        "--trig",
        type=click.Choice(["libm", "inline"]),
        default="libm",
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
)
"""What `emit` takes besides."""


def output(endings: str) -> Option:
    """The file that a command writes."""
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
"""Where a mechanism is to stand."""

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
"""What `graph` takes besides."""

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
"""What `derive` takes besides."""
