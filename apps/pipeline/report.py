#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the demo's results as a table on the screen, as table.json, and as a page of one file."""

import argparse
import base64
import html
import json
import math
import pathlib
import string

RUNS = [
    ("air", "In air", "(a)", "#0f766e",
     "The photographs without refraction: what the cameras and the engine can do."),
    ("refractive", "Under water, refractive", "(b)", "#1d4ed8",
     "Through the port, under the same poses, every ray refracted exactly."),
    ("selfcalibrated", "Under water, self-calibrated", "(c)", "#b45309",
     "Today's practice: COLMAP absorbs the refraction in a lens model, the engine believes it."),
]
SCENES = {
    "closeup": "Twelve views around an object with overhangs, 0.5 to 0.9 m away, through 1.8 cm of "
               "acrylic 3 cm from the lens and tilted by 3 degrees.",
    "reef": "Ten views over a seabed 2 to 3.5 m away, through 1.4 cm of glass 2 cm from the lens.",
}


def load(work):
    rows = []
    for key, title, mark, color, meaning in RUNS:
        rows.append({"run": key, "title": title, "mark": mark, "color": color, "meaning": meaning,
                     **numbers(work / key, "evaluation.json")})
    return rows


def load_best_fit(work):
    """The results of run (c) after ICP moved the cloud rigidly onto the true surface."""
    key, _, mark, color, _ = RUNS[2]
    return {"run": key + "_moved", "title": "The same, moved onto the truth by ICP", "mark": mark,
            "color": color, **numbers(work / key, "evaluation-moved.json")}


def numbers(folder, file):
    result = json.loads((folder / file).read_text())
    accuracy, score = result["accuracy"], result["scores"][0]
    return {"folder": folder, "histogram": result["accuracy_histogram"],
            "points": accuracy["count"], "mean_m": accuracy["mean"],
            "median_m": accuracy["median"], "rms_m": accuracy["rms"],
            "tolerance_m": score["tolerance"], "precision": score["precision"],
            "recall": score["recall"], "f_score": score["f_score"],
            "seconds": float((folder / "seconds").read_text())}


def cells(row):
    return [f"{row['mark']} {row['title']}", f"{row['points']:,}", f"{row['mean_m'] * 1e3:.2f}",
            f"{row['median_m'] * 1e3:.2f}", f"{row['rms_m'] * 1e3:.2f}", f"{row['f_score']:.3f}",
            f"{row['seconds']:.0f}"]


def headings(rows):
    return ["", "points", "mean [mm]", "median [mm]", "RMS [mm]",
            f"F-score at {rows[0]['tolerance_m'] * 1e3:g} mm", "seconds"]


def text_table(rows):
    table = [headings(rows)] + [cells(row) for row in rows]
    widths = [max(len(line[i]) for line in table) for i in range(len(table[0]))]
    lines = ["  ".join(cell.ljust(w) if i == 0 else cell.rjust(w)
                       for i, (cell, w) in enumerate(zip(line, widths))) for line in table]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


def html_table(rows):
    head = "".join(f"<th>{html.escape(h)}</th>" for h in headings(rows))
    body = "".join(
        f'<tr><th><i style="background:{row["color"]}"></i>{html.escape(cells(row)[0])}</th>' +
        "".join(f"<td>{cell}</td>" for cell in cells(row)[1:]) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def nice_step(length, wanted):
    """1, 2 or 5 times a power of ten, so that at most `wanted` steps make up `length`."""
    raw = length / wanted
    power = 10 ** math.floor(math.log10(raw))
    return next(m * power for m in (1, 2, 5, 10) if m * power >= raw)


def histogram_svg(rows, width=960, height=320):
    """The distances of each cloud's points from the true surface as histograms on common axes."""
    left, right, top, bottom = 56, 16, 16, 46
    upper = rows[0]["histogram"]["upper"]
    shares = []
    for row in rows:
        counts = row["histogram"]["counts"]
        total = sum(counts) + row["histogram"]["beyond"]
        shares.append([100 * count / total for count in counts])
    highest = max(max(share) for share in shares) * 1.05
    x = lambda metres: left + (width - left - right) * metres / upper
    y = lambda share: height - bottom - (height - top - bottom) * share / highest

    bin_width = upper / len(shares[0])
    parts = []
    step = nice_step(highest, 4)
    for i in range(int(highest / step) + 1):
        parts.append(f'<line class="grid" x1="{left}" x2="{width - right}" y1="{y(i * step):.1f}" '
                     f'y2="{y(i * step):.1f}"/><text x="{left - 8}" y="{y(i * step) + 4:.1f}" '
                     f'text-anchor="end">{i * step:g}</text>')
    step = nice_step(upper * 1e3, 8)
    for i in range(int(upper * 1e3 / step + 1e-9) + 1):
        parts.append(f'<text x="{x(i * step / 1e3):.1f}" y="{height - bottom + 18}" '
                     f'text-anchor="middle">{i * step:g}</text>')
    for row, share in zip(rows, shares):
        line = " ".join(f"{x((i + 0.5) * bin_width):.1f},{y(s):.1f}" for i, s in enumerate(share))
        median = x(min(row["median_m"], upper))
        parts.append(f'<polyline points="{line}" stroke="{row["color"]}"/>')
        parts.append(f'<line x1="{median:.1f}" x2="{median:.1f}" y1="{top}" y2="{height - bottom}" '
                     f'stroke="{row["color"]}" stroke-dasharray="2 4"/>')
    middle = (left + width - right) / 2
    parts.append(f'<text x="{middle}" y="{height - 6}" text-anchor="middle">distance from the true '
                 f'surface [mm]</text><text transform="translate(14 {(height - bottom) / 2}) '
                 f'rotate(-90)" text-anchor="middle">% of the points per {bin_width * 1e3:g} mm</text>')
    legend = "".join(f'<span><i style="background:{row["color"]}"></i>{row["title"]}: '
                     f'{100 * row["histogram"]["beyond"] / max(row["points"], 1):.1f} % lie beyond '
                     f'{upper * 1e3:g} mm</span>' for row in rows)
    return (f'<svg viewBox="0 0 {width} {height}" role="img" aria-label="error histograms">'
            f'{"".join(parts)}</svg><p class="legend">{legend}</p>')


def image(path, caption):
    data = base64.b64encode(path.read_bytes()).decode()
    return (f'<figure><img src="data:image/png;base64,{data}" alt="{html.escape(caption)}">'
            f"<figcaption>{html.escape(caption)}</figcaption></figure>")


def cloud_pictures(rows):
    return "".join(f'<section class="card"><h3><i style="background:{row["color"]}"></i>'
                   f'{html.escape(row["title"])}</h3><p>{html.escape(row["meaning"])}</p>' +
                   image(row["folder"] / "evaluation.png",
                         "Points seen from the first camera, coloured by error") + "</section>"
                   for row in rows)


def depth_pictures(rows):
    figures = []
    for row in rows:
        for path in sorted(row["folder"].glob("depth-*.png")):
            view = path.stem.removeprefix("depth-")
            figures.append(image(path, f'{row["title"]}, view {view}: estimate, truth, error'))
    return "".join(figures)


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
<p>Distances are from every reconstructed point to the true surface, none left out. The F-score also
counts what is missing of the surface that at least two views see. Clouds are where their camera
centres put them: the true centres in (a) and (b), centres fitted to them in (c), where a lens model
that has swallowed the refraction has its centre elsewhere. The last row takes that part away: there
the cloud is moved rigidly onto the true surface. Seconds are those of DensifyPointCloud.</p>
<h2>How far the points are from the truth</h2>
<div class="panel">$histograms</div>
<p>Dashed: medians.</p>
<h2>Where they are wrong</h2>
<div class="cards">$clouds</div>
<h2>Depth maps beside the truth</h2>
<div class="depths">$depths</div>
</main></body></html>
""")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder of the runs")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder of the results")
    parser.add_argument("--scene", choices=SCENES, required=True)
    parser.add_argument("--size", choices=("half", "full"), required=True)
    options = parser.parse_args()

    rows = load(options.work)
    lines = rows + [load_best_fit(options.work)]
    kept = ("run", "points", "mean_m", "median_m", "rms_m", "tolerance_m", "precision", "recall",
            "f_score", "seconds")
    table = {"scene": options.scene, "size": options.size,
             "runs": [{key: row[key] for key in kept} for row in lines]}
    (options.out / "table.json").write_text(json.dumps(table, indent=1) + "\n")
    (options.out / "report.html").write_text(PAGE.substitute(
        scene=options.scene, description=SCENES[options.scene], size=options.size,
        table=html_table(lines), histograms=histogram_svg(rows), clouds=cloud_pictures(rows),
        depths=depth_pictures(rows)))
    print(text_table(lines))


if __name__ == "__main__":
    main()
