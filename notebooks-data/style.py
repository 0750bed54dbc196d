"""The look of all pictures: one colour and one mark for each technique, as in the maps of `detp choose --map`."""
import io
import os
import pathlib
import re

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

HERE = pathlib.Path(__file__).parent
FIGURES = pathlib.Path(os.environ.get("DETP_FIGURES", HERE / "figures"))
# Ten colours that colour-blind readers can tell apart (Paul Tol's "muted"); each technique has a mark, too.
TECHNIQUES = {
    "brute-force": ("#bbbbbb", "x"), "sphere-cache": ("#332288", "o"), "cell-spheres": ("#88ccee", "v"), "sphere-tree": ("#44aa99", "^"),
    "box-tree": ("#ddcc77", "s"), "octree": ("#117733", "D"), "grid": ("#cc6677", "P"), "bsp": ("#999933", "*"),
    "bvh": ("#882255", "X"), "ray-map": ("#aa4499", "h"),
}  # fmt: skip
LINES = ["#332288", "#cc6677", "#117733", "#ddcc77", "#882255", "#88ccee"]
MARKS = ["o", "s", "D", "^", "v", "P"]

matplotlib.rcParams.update({
    "figure.dpi": 100, "font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd",
    "grid.linewidth": 0.6, "axes.axisbelow": True, "legend.frameon": False, "figure.constrained_layout.use": True,
    "svg.fonttype": "none", "svg.hashsalt": "detp", "font.family": "sans-serif",
})  # fmt: skip


def read(name):
    return pd.read_csv(HERE / name)


def colour(technique):
    return TECHNIQUES[technique][0]


def mark(technique):
    return TECHNIQUES[technique][1]


def style_once(group):
    """A group of marks with the style in the group, if all marks have the same."""
    styles = set(re.findall(r'style="([^"]*)"', group.group(2)))
    if len(styles) != 1:
        return group.group()
    marks = re.sub(r' style="[^"]*"', "", group.group(2))
    return f'{group.group(1)} style="{styles.pop()}">\n{marks}'


def interval(axes, x, low, high, **look):
    """Bars from low to high, as one line."""
    gap = np.full(len(x), np.nan)
    axes.plot(np.column_stack([x, x, gap]).ravel(), np.column_stack([low, high, gap]).ravel(), linewidth=0.8, **look)


def save(figure, name):
    """Writes NAME.svg to the folder figures, or to $DETP_FIGURES, at most 60 kB, the same bytes each time."""
    for axes in figure.axes:
        axes.minorticks_off()
    drawn = io.StringIO()
    figure.savefig(drawn, format="svg", bbox_inches="tight", metadata={"Date": None, "Creator": None})
    text = re.sub(r"<[^>]*>", lambda tag: re.sub(r"\d+\.\d{2,}", lambda number: f"{float(number.group()):.1f}", tag.group()), drawn.getvalue())
    text = re.sub(r"\n\s*", "\n", text)
    text = re.sub(r'(<g clip-path="[^"]*")>\n((?:<use [^>]*/>\n)+)', style_once, text)
    if len(text) > 60_000:
        raise ValueError(f"{name}.svg has {len(text)} bytes, more than 60 kB")
    FIGURES.mkdir(exist_ok=True)
    (FIGURES / f"{name}.svg").write_text(text)


def zones(axes, cells, best, title):
    """A cell's colour and letters say which technique is fastest. `cells` has a row for each cell."""
    rays, radii = sorted(cells["rays"].unique()), sorted(cells["disc_radius"].unique(), reverse=True)
    for _, cell in cells.iterrows():
        technique = cell[best]
        x, y = rays.index(cell["rays"]), radii.index(cell["disc_radius"])
        axes.add_patch(plt.Rectangle((x, y), 1, 1, facecolor=colour(technique), edgecolor="white", linewidth=1.5))
        dark = sum(w * int(colour(technique)[i:i + 2], 16) for w, i in [(0.3, 1), (0.59, 3), (0.11, 5)]) < 140
        letters = "".join(word[0] for word in technique.split("-"))
        axes.text(x + 0.5, y + 0.5, letters if len(letters) > 1 else technique[:2], ha="center", va="center", color="white" if dark else "black", fontsize=9)
    xs = cells.groupby("disc_radius")["x"].first()
    axes.set(xlim=(0, len(rays)), ylim=(len(radii), 0), title=title, xlabel="rays", ylabel="X = distance between samples / d")
    axes.set_xticks([i + 0.5 for i in range(len(rays))], [f"{n / 1000:g}k" if n >= 1000 else f"{n:g}" for n in rays])
    axes.set_yticks([i + 0.5 for i in range(len(radii))], [f"{xs[d]:.2g}" for d in radii])
    axes.grid(False)
    axes.tick_params(length=0)
