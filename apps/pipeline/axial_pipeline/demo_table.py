# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's runs, their numbers, and the table of them."""

import json

RUNS = [
    ("air", "In air", "(a)", "#0f766e",
     "The photographs without refraction: the accuracy of cameras and matching alone."),
    ("refractive", "Under water, refractive", "(b)", "#1d4ed8",
     "The photographs through the port, with the same poses. Every ray is refracted exactly."),
    ("selfcalibrated", "Under water, self-calibrated", "(c)", "#b45309",
     "The usual practice: COLMAP absorbs the refraction in a lens model, and matching uses this model."),
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


def table(rows):
    return [headings(rows), *map(cells, rows)]


def text_table(table):
    """A table of cells as text. The first row holds the headings."""
    widths = [max(len(line[i]) for line in table) for i in range(len(table[0]))]
    lines = ["  ".join(cell.ljust(w) if i == 0 else cell.rjust(w)
                       for i, (cell, w) in enumerate(zip(line, widths))) for line in table]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


KEPT = ("run", "points", "mean_m", "median_m", "rms_m", "tolerance_m", "precision", "recall",
        "f_score", "seconds")


def json_table(lines, meshes, scene, size):
    """The text of table.json. `meshes`: the numbers of the meshes."""
    return json.dumps({"scene": scene, "size": size,
                       "runs": [{key: row[key] for key in KEPT} for row in lines],
                       "meshes": meshes}, indent=1) + "\n"
