"""The figure of cascades. Needs matplotlib (the extra ``plots``)."""

from typing import Any

from matplotlib.figure import Figure

from ...figures import style

SHARES = {
    "forces_1": "forces changed by more than 1 % of the mean",
    "forces_10": "by more than 10 %",
    "moved": "beads moved by more than 0.001 r",
    "new": "contacts that are new",
}


def draw(summary: list[dict[str, Any]]) -> Figure:
    """Draw one panel a load: shares over M, with bars of two standard errors."""
    loads = list(dict.fromkeys(row["load"] for row in summary))
    figure = style.figure(style.PAGE, 2.9)
    panels = figure.subplots(1, len(loads), sharey=True, squeeze=False)[0]
    for axes, load in zip(panels, loads, strict=True):
        rows = [row for row in summary if row["load"] == load]
        for number, (name, words) in enumerate(SHARES.items()):
            colour, marker = style.series(number)
            axes.errorbar(
                [row["height"] for row in rows],
                [row[name] for row in rows],
                [2 * row[f"{name}_error"] for row in rows],
                color=colour, marker=marker, ms=3.5, capsize=2, linewidth=0.8, label=words,
            )  # fmt: skip
        axes.set_title(f"{load} load", loc="left")
        axes.set_xlabel("height $M$")
        axes.set_ylim(0, 1)
        axes.set_xticks([row["height"] for row in rows])
    panels[0].set_ylabel("share")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure
