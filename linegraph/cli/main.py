"""The command line: `linegraph new`, `emit`, `derive`, `graph`, `show`, `check` and the other commands.

Results go to standard output, messages and progress to standard error (`output`). Exit statuses are those
of `exits`. Heavy modules are imported by the command that needs them, to keep start-up fast.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import click

from linegraph.cli.options import ABOUT_MODEL, DERIVE, EMIT, GRAPH, SET, assignment, with_options
from linegraph.cli.output import explained, progress, warn
from linegraph.exits import CHECK_FAILED
from linegraph.files import is_stream
from linegraph.version import __version__

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph.model.builder import Model

_about_model = with_options(ABOUT_MODEL)


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="linegraph", message="%(prog)s %(version)s")
def main() -> None:
    """Equations of motion from linear (terminal) graphs, emitted as C and Python.

    linegraph reads a system (a model file: bodies and joints, circuits, hydraulics, heat, in any mixture) or
    a robot (a URDF), unites its terminal graphs into the system graph, picks a tree, derives

        M(q) v' + h(q, v) = Q(u),    q' = N(q) v

    by the principle of orthogonality, fully symbolically, and writes source files that need no library.

    \b
    Examples:
      linegraph new crane
      linegraph emit crane.toml --out build
      linegraph emit panda.urdf --out build
      linegraph emit anymal.urdf --base floating --lang c --out build
      linegraph emit panda.urdf --lock panda_finger_joint1=0.02 --out build
      linegraph emit panda.urdf --frame panda_hand --with center_of_mass --out build
      linegraph derive crane.toml --output crane.html

    Exit status: 0 done; 1 a check has failed; 2 the model or the call is wrong, nothing written;
    74 the output could not be written (a full disk, a device); 130 interrupted; 70 an error of linegraph.
    """


def run() -> int:
    """Run the command line of this process and return the exit status.

    Raises:
        KeyboardInterrupt: the user broke it off.
        OSError: output could not be written.
    """
    try:
        found = main.main(prog_name="linegraph", standalone_mode=False)
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except click.Abort:
        raise KeyboardInterrupt from None
    except SystemExit as left:
        return left.code if isinstance(left.code, int) else int(left.code is not None)
    return found if isinstance(found, int) else 0


@main.command()
@_about_model
@with_options(EMIT)
def emit(
    model: str,
    base: str,
    locks: tuple[str, ...],
    parameters: str | None,
    snap: float,
    out: str,
    languages: tuple[str, ...],
    **choices: Any,
) -> None:
    """Write the equations of motion of MODEL as source files.

    MODEL is a model file (.toml or .json; `linegraph new` writes one to start from) or a URDF. Of a model
    file, the order of joints is the order of coordinates. Of a URDF, every moving joint that does not
    mimic another becomes a coordinate of its name, in the order of a walk from the root, with its effort
    as an input; fixed joints are welded.

    \b
    Written are NAME.h and NAME.c (C99, only <math.h>, no allocation) and NAME.py (only NumPy) with
      mass_matrix        M(q)
      bias               h(q, v)
      equations          M and h at once
      inverse_dynamics   tau = M a + h
      forward_dynamics   a = M^-1 (Q(u) - h)
      coordinate_rates   q' = N(q) v
      energy             kinetic and potential, and what networks store
      rhs                x' = f(x, u, t) of the whole state x = (q, v), for integrators
      across, reactions  every variable of every joint, element and component, by the inverse scheme
      outputs            what the model asks for by name
    and with closed loops or constraints
      constraints, constraint_jacobian, constraint_rates, constraint_bias, project,
      complete, reduction, reduced_equations: the mechanism in its independent coordinates
    and on request, --with FUNCTION
      linearize          A and B of dx' = A dx + B du at any state, on the tangent space
      inverse_dynamics_derivatives, forward_dynamics_derivatives    by q, v and a or u
      inverse_dynamics_parameter_derivatives, forward_dynamics_parameter_derivatives
      center_of_mass, center_of_mass_velocity, center_of_mass_jacobian
      momentum, centroidal_momentum_matrix, centroidal_momentum_bias
      operational_space, operational_position    Lambda, mu and Jbar of each --frame
      kinematics         poses, Jacobians, mass centre and momentum that are asked for, at once
      regressor          Y of tau = Y pi, linear in masses, moments and friction; inertial_parameters: pi
      power              the audit of through times across
    and for each --frame
      frame_NAME_pose, frame_NAME_velocity, frame_NAME_jacobian, frame_NAME_jacobian_dot_v

    Where joints move no inertia, as in URDFs without masses, M is singular: functions that divide by it are
    left out with one warning, and refused if asked for by name.
    """
    with explained():
        from linegraph.emission.emit import emit as write

        system = _read(model, base, locks, parameters, snap)
        with progress() as tell:
            written = write(
                system,
                out,
                languages=languages or None,
                folded=parameters == "folded",
                progress=tell,
                warn=warn,
                **choices,
            )
        for path in written:
            click.echo(str(path))


@main.command()
@_about_model
@with_options(DERIVE)
def derive(
    model: str,
    base: str,
    locks: tuple[str, ...],
    parameters: str | None,
    snap: float,
    format: str | None,
    output: str | None,
    level: str,
) -> None:
    """Write the derivation of MODEL as a person would.

    The terminal graphs, the system graph of each subspace with its incidence matrix, the tree and why it
    was chosen, cutset, circuit, terminal and connecting equations, the principle of orthogonality for this
    system, then M, h, Q and the reactions: in closed form where these are short, else part by part.

    \b
    Examples:
      linegraph derive crane.toml
      linegraph derive crane.toml --output crane.html
      linegraph derive crane.toml --output crane.tex --level fast
    """
    with explained():
        from linegraph.derivation import derive as derived
        from linegraph.report import format_of, report, save

        chosen = format or (format_of(output) if output else "text")
        system = _read(model, base, locks, parameters, snap)
        with progress() as tell:
            tell("deriving")
            derivation = derived(system)
            folded = parameters == "folded"
            text = report(derivation, chosen, level=level, folded=folded, progress=tell)
        if output is None:
            click.echo(text, nl=False)
        else:
            _wrote(save(output, text))


@main.command()
@_about_model
def trees(
    model: str, base: str, locks: tuple[str, ...], parameters: str | None, snap: float
) -> None:
    """List the trees MODEL may be derived with, cheapest first.

    The tree decides which variables are coordinates and which joints close loops; the motion is the same
    with each. Printed are operations (M, h and, with loops, J and gamma), velocities, constraints, the
    joints that are cut, and what to write in [formulation] for this tree.
    """
    with explained():
        from linegraph.programs.tree_costs import trees as sensible

        system = _read(model, base, locks, parameters, snap)
        with progress() as tell:
            found = sensible(system, tell)
        click.echo(str(found), nl=False)


@main.command()
@_about_model
def parameters(
    model: str, base: str, locks: tuple[str, ...], parameters: str | None, snap: float
) -> None:
    """List the base parameters of MODEL: what of its masses and moments motion can tell apart.

    Standard parameters are ten of each link (mass, first moment, inertia about its origin) and damping, dry
    friction and rotor inertia of each joint. Printed are the independent ones, each with what has to be
    added to it, and those without effect. Angles such as 1.5708 keep axes almost, not quite, parallel:
    --snap 1e-4 makes them so.
    """
    with explained():
        from linegraph.derivation import derive

        derivation = derive(_read(model, base, locks, parameters, snap))
        click.echo(str(derivation.base_parameters()), nl=False)


@main.command()
@_about_model
@with_options((SET,))
def assemble(
    model: str,
    base: str,
    locks: tuple[str, ...],
    parameters: str | None,
    snap: float,
    held: tuple[str, ...],
) -> None:
    """Find a position of MODEL that closes all loops.

    The search begins at the joints' start values. Printed are the coordinates, the degrees of freedom and
    how many constraints are redundant.
    """
    with explained():
        from linegraph.derivation import derive
        from linegraph.report import assembled

        values = dict(assignment(text, "--set") for text in held)
        derivation = derive(_read(model, base, locks, parameters, snap))
        click.echo(assembled(derivation, derivation.placed_assembly(values)), nl=False)


@main.command()
@_about_model
def show(
    model: str, base: str, locks: tuple[str, ...], parameters: str | None, snap: float
) -> None:
    """Print what MODEL is made of and how its equations arise.

    Bodies, joints, domains, the system graph, the chosen tree, the coordinates, and the fundamental
    cutset and circuit matrices.
    """
    with explained():
        from linegraph.derivation import derive
        from linegraph.report import show as text

        system = _read(model, base, locks, parameters, snap)
        click.echo(text(derive(system), lambda title: click.style(title, bold=True)), nl=False)


@main.command()
@_about_model
@with_options(GRAPH)
def graph(
    model: str,
    base: str,
    locks: tuple[str, ...],
    parameters: str | None,
    snap: float,
    held: tuple[str, ...],
    output: str | None,
    **choices: Any,
) -> None:
    """Draw the system graph of MODEL, its mechanism, or both.

    In each subspace ground is a rail, vertices are dots, those of one body in a region of their own;
    branches are bold, chords thin, each with its name. A mechanism is seen face-on where it is planar, at
    the position that `assemble` finds.
    """
    with explained():
        from linegraph.derivation import derive
        from linegraph.drawing.files import picture, require_ending, write

        require_ending(output)
        values = dict(assignment(text, "--set") for text in held)
        derivation = derive(_read(model, base, locks, parameters, snap))
        content = picture(derivation, output, hold=values, **choices)
        if output is None:
            click.echo(content, nl=False)
        else:
            _wrote(write(output, content))


@main.command()
@click.argument("name")
@click.option(
    "--out",
    metavar="FILE",
    type=click.Path(dir_okay=False, path_type=str),
    help="The file to write; none may be there yet.  [default: NAME.toml]",
)
def new(name: str, out: str | None) -> None:
    """Write a commented model file called NAME to start from.

    It describes a pendulum on a cart and can be shown and emitted as it is.
    """
    with explained():
        from linegraph.readers.modelfile.starter import write

        _wrote(write(name, out))


@main.command()
def schema() -> None:
    """Print the JSON Schema of model files, for editors that complete and check them.

    \b
    In the folder of your models:    linegraph schema > linegraph.schema.json
    First line of a model:           #:schema ./linegraph.schema.json
    """
    from linegraph.readers.modelfile.schema import text

    click.echo(text(), nl=False)


@main.command()
@_about_model
def check(
    model: str, base: str, locks: tuple[str, ...], parameters: str | None, snap: float
) -> None:
    """Check MODEL and the equations that follow from it.

    Reads and derives it, prints its coordinates, and at random states compares M and h of the program that
    would be emitted with two other routes, and the rate of energy with the power of all that acts.
    Exit status 1 if they differ by more than rounding.
    """
    with explained():
        from linegraph.derivation import derive
        from linegraph.verification import checking

        derivation = derive(_read(model, base, locks, parameters, snap))
        findings = checking.check(derivation)
        text = checking.report(derivation, findings, lambda title: click.style(title, bold=True))
        click.echo(text, nl=False)
        if not findings.good:
            sys.exit(CHECK_FAILED)


@main.command()
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
def completion(shell: str) -> None:
    """Print the completion script for SHELL.

    \b
    For bash, add to ~/.bashrc:    eval "$(linegraph completion bash)"
    For zsh, add to ~/.zshrc:      eval "$(linegraph completion zsh)"
    For fish, once:                linegraph completion fish > ~/.config/fish/completions/linegraph.fish
    """
    from click.shell_completion import get_completion_class

    kind = get_completion_class(shell)
    if kind is None:
        raise click.UsageError(f"no completion for {shell}")
    click.echo(kind(main, {}, "linegraph", "_LINEGRAPH_COMPLETE").source())


def _read(
    source: str, base: str, locks: tuple[str, ...], parameters: str | None, snap: float
) -> Model:
    """Read a model file or a URDF, lock joints and print warnings."""
    from linegraph.readers.read import read

    model = read(source, base=base, symbolic=parameters == "symbolic", snap=snap)
    for lock in locks:
        joint, value = assignment(lock, "--lock", 0.0)
        model.lock(joint, value)
    for warning in model.warnings:
        warn(warning)
    return model


def _wrote(path: Path) -> None:
    """Print the path of a written file; nothing for a device or pipe, which may be standard output itself."""
    if not is_stream(path):
        click.echo(str(path))
