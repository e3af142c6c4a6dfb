"""The figures as a picture: what a call of M and h takes, relative to CasADi."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

COLOURS = {
    "linegraph": "#1f6f8b",
    "linegraph, --trig inline": "#5fb0c9",
    "CasADi": "#c8553d",
    "Pinocchio C++": "#8a8a8a",
    "MuJoCo": "#d8b365",
}


def draw(found: dict[str, Any], path: Path, function: str = "equations") -> None:
    """Write an SVG; the same figures give the same bytes."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "linegraph", "font.size": 9})
    from matplotlib import pyplot

    robots = {
        name: figures["functions"][function]
        for name, figures in found["robots"].items()
        if "CasADi" in figures["functions"].get(function, {})
    }
    peers = [peer for peer in COLOURS if any(peer in rows for rows in robots.values())]
    figure, axes = pyplot.subplots(figsize=(10, 3.4), layout="constrained")
    width = 0.84 / max(len(peers), 1)
    for k, peer in enumerate(peers):
        places = [x for x, rows in enumerate(robots.values()) if peer in rows]
        here = [rows for rows in robots.values() if peer in rows]
        heights = [rows[peer]["ns"] / rows["CasADi"]["ns"] for rows in here]
        shifted = [x + (k - (len(peers) - 1) / 2) * width for x in places]
        bars = axes.bar(shifted, heights, width, color=COLOURS[peer], label=peer)
        labels = [f"{rows[peer]['ns'] / 1000:.3g}" for rows in here]
        axes.bar_label(bars, labels, fontsize=6, rotation=90, padding=2)
    axes.axhline(1.0, color="#444444", linewidth=0.6)
    axes.set_xticks(range(len(robots)), list(robots))
    axes.set_ylabel("time of a call, CasADi = 1")
    axes.set_title("M and h in one call (above the bars: µs)", fontsize=9)
    axes.margins(x=0.01, y=0.12)
    figure.legend(loc="outside lower center", fontsize=7, ncols=len(peers), frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)
