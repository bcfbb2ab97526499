# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of the demo's results: HTML in one file, with all pictures in it."""

import html
import json
import math
import string

from . import demo_table
from .demo_runs import CHANGE
from .report_html import figure


def html_table(table, rows):
    """`table`: the headings, and the cells of each of `rows`."""
    head = "".join(f"<th>{html.escape(h)}</th>" for h in table[0])
    body = "".join(
        f'<tr><th><i style="background:{row["color"]}"></i>{html.escape(cells[0])}</th>' +
        "".join(f"<td>{cell}</td>" for cell in cells[1:]) + "</tr>"
        for cells, row in zip(table[1:], rows))
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def nice_step(length, wanted):
    """1, 2 or 5 times a power of ten, so that at most `wanted` steps make up `length`."""
    raw = length / wanted
    power = 10 ** math.floor(math.log10(raw))
    return next(m * power for m in (1, 2, 5, 10) if m * power >= raw)


WIDTH, HEIGHT = 960, 320  # of the chart
LEFT, RIGHT, TOP, BOTTOM = 56, 16, 16, 46  # its margins


class Axes:
    """Places of the chart: distances [m] up to `upper`, and shares [%] up to `highest`."""

    def __init__(self, upper, highest):
        self.upper, self.highest = upper, highest

    def x(self, metres):
        return LEFT + (WIDTH - LEFT - RIGHT) * metres / self.upper

    def y(self, share):
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * share / self.highest

    def grid(self):
        step = nice_step(self.highest, 4)
        for i in range(int(self.highest / step) + 1):
            yield (f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" '
                   f'y1="{self.y(i * step):.1f}" y2="{self.y(i * step):.1f}"/>'
                   f'<text x="{LEFT - 8}" y="{self.y(i * step) + 4:.1f}" text-anchor="end">'
                   f'{i * step:g}</text>')
        step = nice_step(self.upper * 1e3, 8)
        for i in range(int(self.upper * 1e3 / step + 1e-9) + 1):
            yield (f'<text x="{self.x(i * step / 1e3):.1f}" y="{HEIGHT - BOTTOM + 18}" '
                   f'text-anchor="middle">{i * step:g}</text>')

    def titles(self, bin_width):
        middle = (LEFT + WIDTH - RIGHT) / 2
        yield (f'<text x="{middle}" y="{HEIGHT - 6}" text-anchor="middle">distance from the true '
               f'surface [mm]</text><text transform="translate(14 {(HEIGHT - BOTTOM) / 2}) '
               f'rotate(-90)" text-anchor="middle">% of the points per {bin_width * 1e3:g} mm</text>')


def shares_of(row):
    """The percentage of the row's points in each bin of its histogram."""
    counts = row["histogram"]["counts"]
    total = sum(counts) + row["histogram"]["beyond"]
    return [100 * count / total for count in counts]


def curve(row, shares, axes, bin_width):
    line = " ".join(f"{axes.x((i + 0.5) * bin_width):.1f},{axes.y(share):.1f}"
                    for i, share in enumerate(shares))
    median = axes.x(min(row["median_m"], axes.upper))
    return (f'<polyline points="{line}" stroke="{row["color"]}"/>'
            f'<line x1="{median:.1f}" x2="{median:.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}" '
            f'stroke="{row["color"]}" stroke-dasharray="2 4"/>')


def histogram_svg(rows):
    """The distances of each cloud's points from the true surface as histograms on common axes."""
    upper, shares = rows[0]["histogram"]["upper"], [shares_of(row) for row in rows]
    axes, bin_width = Axes(upper, max(map(max, shares)) * 1.05), upper / len(shares[0])
    parts = [*axes.grid(),
             *(curve(row, share, axes, bin_width) for row, share in zip(rows, shares)),
             *axes.titles(bin_width)]
    legend = "".join(f'<span><i style="background:{row["color"]}"></i>{row["title"]}: '
                     f'{100 * row["histogram"]["beyond"] / max(row["points"], 1):.1f} % lie beyond '
                     f'{upper * 1e3:g} mm</span>' for row in rows)
    return (f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="error histograms">'
            f'{"".join(parts)}</svg><p class="legend">{legend}</p>')


def cloud_pictures(rows):
    return "".join(f'<section class="card"><h3><i style="background:{row["color"]}"></i>'
                   f'{html.escape(row["title"])}</h3><p>{html.escape(row["meaning"])}</p>' +
                   figure(row["folder"] / "evaluation.png",
                         "Points seen from the first camera, coloured by error") + "</section>"
                   for row in rows)


def depth_pictures(rows):
    figures = []
    for row in rows:
        for path in sorted(row["folder"].glob("depth-*.png")):
            view = path.stem.removeprefix("depth-")
            figures.append(figure(path, f'{row["title"]}, view {view}: estimate, truth, error'))
    return "".join(figures)


def mesh_pictures(meshes, photograph):
    name = photograph.stem
    cards = "".join(
        f'<section class="card"><h3><i style="background:{row["color"]}"></i>'
        f'{html.escape(row["title"])}</h3>' +
        figure(row["folder"] / "rendered" / f"{name}.jpg", f"Textured, view {name}") +
        figure(row["folder"] / "rendered" / f"{name}.errors.jpg", "Coloured by error") + "</section>"
        for row in meshes)
    return (f'<section class="card"><h3>The photograph under water</h3>' +
            figure(photograph, f"View {name}, left out of texturing") + "</section>" + cards)


def falsely_changed(results):
    """The share of the compared area that the comparison calls changed."""
    change = json.loads((results / f"{CHANGE}.change.json").read_text())
    return change["area_changed"] / change["area_compared"]


def survey(run, results):
    """The part of the page about the survey of `run`: links to its files in `results`, the folder of the page."""
    link = lambda name, text: f'<a href="{name}">{html.escape(text)}</a>'
    parts = [f'{link(f"{run}_map.ortho.tif", "Orthomosaic")}, {link(f"{run}_map.dem.tif", "heights")} '
             f'and {link(f"{run}_map.views.tif", "numbers of views")} are GeoTIFFs. The surveys (a) and '
             f'(b) have the same ground; CompareSurveys calls {100 * falsely_changed(results):.2f} % of '
             f'the area changed.']
    if (results / f"{run}_page").exists():
        parts.insert(0, f'{link(f"{run}_page/index.html", "The page of the survey")} shows the cloud '
                        f'and its errors, the mesh, the photographs, the depth maps, the maps and the '
                        f'changes, and measures distances, areas and volumes.')
    return f"<p>{' '.join(parts)}</p>"


PAGE = string.Template("""<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>AxialMVS: $scene</title>
<style>
:root { color-scheme: light; --ink: #0f172a; --soft: #475569; --line: #dbe3ec; --page: #f4f7fa; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink);
       font: 16px/1.55 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
header { background: linear-gradient(160deg, #06263f, #0b4f6c 60%, #12708a); color: #fff;
         padding: 3rem 1.25rem 2.5rem; }
header div { max-width: 1100px; margin: auto; }
main { max-width: calc(1100px + 2.5rem); margin: auto; }
header h1 { margin: 0 0 .5rem; font-size: 2rem; line-height: 1.2; letter-spacing: -.01em; }
header p { margin: 0; max-width: 46rem; color: #d5e7f0; }
main { padding: 1.5rem 1.25rem 4rem; }
h2 { margin: 2.5rem 0 .75rem; font-size: 1.3rem; }
h3 { margin: 0 0 .25rem; font-size: 1.05rem; }
p { margin: .25rem 0 .75rem; color: var(--soft); }
.panel, .card { background: #fff; border: 1px solid var(--line); border-radius: 10px;
                padding: 1rem 1.25rem; }
.panel { overflow-x: auto; }
table { width: 100%; border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .55rem .75rem; text-align: right; white-space: nowrap; }
th:first-child { text-align: left; }
thead th { color: var(--soft); font-weight: 500; font-size: .85rem; }
tbody tr { border-top: 1px solid var(--line); }
i { display: inline-block; width: .7rem; height: .7rem; border-radius: 50%; margin-right: .5rem; }
.cards { display: grid; gap: 1rem; grid-template-columns: repeat(auto-fit, minmax(320px, 1fr)); }
figure { margin: .5rem 0 0; }
.depths figure { background: #fff; border: 1px solid var(--line); border-radius: 10px;
                 padding: 1rem; margin-bottom: 1rem; }
img { width: 100%; height: auto; display: block; border-radius: 4px; }
figcaption { color: var(--soft); font-size: .85rem; margin-top: .4rem; }
svg { width: 100%; height: auto; } svg text { fill: var(--soft); font-size: 12px; }
svg polyline { fill: none; stroke-width: 2.2; stroke-linejoin: round; }
svg .grid { stroke: var(--line); }
.legend span { margin-right: 1.5rem; white-space: nowrap; display: inline-block; }
</style></head><body>
<header><div><h1>Dense reconstruction through a flat port: $scene</h1>
<p>$description Simulated with ground truth; $size resolution.</p></div></header>
<main>
<h2>Three ways to reconstruct it</h2>
<div class="panel">$table</div>
<p>Distances are measured from every reconstructed point to the true surface. The F-score also counts
missing parts of the surface that at least two views see. The camera centres determine where a cloud
lies. In (a) and (b) they are the true centres. In (c) they are fitted to the true centres, but a lens
model that has absorbed the refraction has its centre elsewhere. For the last row, the cloud of (c)
was moved rigidly onto the true surface. Seconds are those of DensifyPointCloud.</p>
<h2>How far the points are from the truth</h2>
<div class="panel">$histograms</div>
<p>Dashed: medians.</p>
<h2>Where they are wrong</h2>
<div class="cards">$clouds</div>
<h2>From clouds to textured meshes</h2>
<div class="panel">$mesh_table</div>
<p>ReconstructMesh makes a mesh from the clouds of (a) and (b), RefineMesh moves its vertices until the
photographs agree, and TextureMesh gives it the colours of the photographs, without view $left_out.
Numbers are those of the surface that at least two views see. PSNR compares the textured mesh, rendered
into view $left_out through the port of its camera, with the photograph that was not used. Seconds are
those of the three programs.</p>
<div class="cards">$mesh_pictures</div>
<h2>The survey</h2>
$survey
<h2>Depth maps beside the truth</h2>
<div class="depths">$depths</div>
</main></body></html>
""")


def page(rows, lines, meshes, photograph, survey, **texts):
    """The text of the page. `rows`: the runs. `lines`: the rows of the table. `meshes`: the rows of
    the table of meshes. `photograph`: the file of the view that was left out of texturing. `survey`:
    the HTML about the survey. `texts`: the scene's name and description, and the size of the
    images."""
    return PAGE.substitute(
        texts, table=html_table(demo_table.of_clouds(lines), lines), histograms=histogram_svg(rows),
        clouds=cloud_pictures(rows), depths=depth_pictures(rows),
        mesh_table=html_table(demo_table.of_meshes(meshes), meshes), left_out=photograph.stem,
        mesh_pictures=mesh_pictures(meshes, photograph), survey=survey)
