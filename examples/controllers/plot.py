"""Draw the log of a controller's simulation.

    python examples/controllers/plot.py mpc build/controllers/mpc/log.csv build/controllers/mpc/plot.png

The first argument names the folder that the log is of; the pictures of the READMEs are made so. The same log
gives the same bytes with the same version of matplotlib.
"""

from __future__ import annotations

import argparse
import csv
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable

Array = NDArray[np.float64]
Log = dict[str, Array]


@dataclass(frozen=True)
class Panel:
    """One diagram over time.

    Attributes:
        label: of its ordinate, with the unit.
        lines: what is drawn, by the words of the legend: a column's name, or a function of the log. Without
            words a line belongs to the one before it.
        limits: values worth to compare with, as those of the goal: dashed lines.
        logarithmic: whether the ordinate is.
        shown: the least and the largest value that is shown, where not all are.
    """

    label: str
    lines: dict[str, str | Callable[[Log], Array]]
    limits: tuple[float, ...] = ()
    logarithmic: bool = False
    shown: tuple[float, float] | None = None


def largest_error(law: str) -> Callable[[Log], Array]:
    """The joint's error that is largest at the time, in mrad."""

    def errors(log: Log) -> Array:
        joints = [log[f"{law}_q{i}"] - log[f"wanted{i}"] for i in range(1, 8)]
        return np.asarray(1e3 * np.max(np.abs(joints), axis=0))

    return errors


def scaled(column: str, factor: float, less: str = "") -> Callable[[Log], Array]:
    """A column in another unit, another column subtracted."""
    return lambda log: factor * (log[column] - (log[less] if less else 0.0))


def degrees(column: str) -> Callable[[Log], Array]:
    """An angle in degrees."""
    return lambda log: np.degrees(log[column])


def within(column: str, sign: float) -> Callable[[Log], Array]:
    """Two standard deviations that the filter believes a column's error has."""
    return lambda log: sign * 2.0 * log[f"{column}_deviation"]


PANELS = {
    "cart_pole_motor": (
        Panel("pole / deg", {"": degrees("swing")}, limits=(-180, 180)),
        Panel("cart / m", {"": "slide"}, limits=(-0.5, 0.5)),
        Panel("voltage / V", {"": "voltage"}, limits=(-12, 12)),
        Panel("current / A", {"": "current"}),
    ),
    "computed_torque": (
        Panel("angle / rad", {f"joint {i}": f"computed_q{i}" for i in (1, 2, 4, 7)}),
        Panel(
            "largest error / mrad",
            {"PD and gravity": largest_error("pd"), "computed torque": largest_error("computed")},
            limits=(8,),
        ),
        Panel("torque / N m", {f"joint {i}": f"computed_u{i}" for i in (1, 2, 4, 7)}),
    ),
    "ekf": (
        Panel("angle / rad", {"arm": "shaft", "pendulum": "hinge"}),
        Panel("rate / rad/s", {"difference": "hinge_difference", "estimate": "hinge_dot_estimate"}),
        Panel(
            "error of the rate / rad/s",
            {
                "estimate": scaled("hinge_dot_estimate", 1, "hinge_dot"),
                "2 deviations believed": within("hinge_dot", 1),
                "": within("hinge_dot", -1),
            },
            shown=(-0.2, 0.2),
        ),
        Panel("normalized error", {"": "mean_normalized"}, limits=(3.1718, 4.9229)),
    ),
    "four_bar": (
        Panel("angle / rad", {"crank": "motor", "rocker": "swing", "rocker, wanted": "wanted"}),
        Panel("error of the rocker / mrad", {"": scaled("swing", 1e3, "wanted")}, limits=(-2, 2)),
        Panel("torque / N m", {"": "torque"}),
        Panel("loop open by / m", {"": "open"}, limits=(1e-9,), logarithmic=True),
    ),
    "furuta": (
        Panel("pendulum / deg", {"": degrees("hinge")}, limits=(-180, 180)),
        Panel("arm / rad", {"": "shaft"}, limits=(-1.5, 1.5)),
        Panel("torque / N m", {"": "torque"}, limits=(-0.5, 0.5)),
    ),
    "impedance": (
        Panel("y / m", {"wanted": "wanted_y", "tool": "y", "response": "response_y"}),
        Panel("x / m", {"wanted": "wanted_x", "tool": "x"}),
        Panel("force / N", {"": "force"}, limits=(17.48, 25)),
        Panel("turned by / mrad", {"": scaled("turn", 1e3)}, limits=(10,)),
    ),
    "mpc": (
        Panel("pole / deg", {"": degrees("swing")}, limits=(-180, 180)),
        Panel("cart / m", {"": "slide"}, limits=(-0.6, 0.6)),
        Panel("force / N", {"": "force"}, limits=(-8, 8)),
    ),
}
"""What is drawn of each controller."""

COLOURS = ("#1f5fa8", "#d1702a", "#3c8d4f", "#8a4fa3")


def read(path: Path) -> Log:
    """The columns of a log by their names."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        names = next(rows)
        values = np.array([[float(entry) for entry in row] for row in rows])
    return dict(zip(names, values.T, strict=True))


def draw(name: str, log: Log, path: Path) -> None:
    """Write the picture of a log as PNG."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    panels = PANELS[name]
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        figure = Figure(figsize=(8, 1.9 * len(panels) + 0.4), dpi=100)
        canvas = FigureCanvasAgg(figure)
        for place, panel in enumerate(panels, start=1):
            axes = figure.add_subplot(len(panels), 1, place)
            colours = iter(COLOURS)
            colour = COLOURS[0]
            for words, what in panel.lines.items():
                colour = next(colours) if words else colour
                values = log[what] if isinstance(what, str) else what(log)
                axes.plot(log["t"], values, color=colour, linewidth=1.2, label=words)
            for limit in panel.limits:
                axes.axhline(limit, color="#888888", linewidth=0.8, linestyle="--")
            if panel.logarithmic:
                axes.set_yscale("log")
            if panel.shown is not None:
                axes.set_ylim(panel.shown)
            if len(panel.lines) > 1:
                axes.legend(loc="upper right", fontsize=8, ncols=len(panel.lines))
            axes.set_ylabel(panel.label, fontsize=9)
            axes.set_xlim(log["t"][0], log["t"][-1])
            axes.grid(color="#dddddd", linewidth=0.6)
            axes.tick_params(labelsize=8, labelbottom=place == len(panels))
        axes.set_xlabel("t / s", fontsize=9)
        figure.align_ylabels()
        figure.subplots_adjust(
            left=0.1, right=0.98, top=0.98, bottom=0.45 / (len(panels) + 0.2) / 1.9, hspace=0.12
        )
        canvas.print_png(str(path), metadata={"Software": None})  # type: ignore[no-untyped-call]


def main() -> None:
    """Read the command line, read the log, draw it."""
    parser = argparse.ArgumentParser(description="Draw the log of a controller's simulation.")
    parser.add_argument("controller", choices=sorted(PANELS))
    parser.add_argument("log", type=Path)
    parser.add_argument("picture", type=Path)
    arguments = parser.parse_args()
    draw(arguments.controller, read(arguments.log), arguments.picture)


if __name__ == "__main__":
    main()
