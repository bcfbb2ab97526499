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


def load_meshes(rows, runs):
    """`rows`: of the clouds. Returns a row for the mesh of each of `runs`."""
    return [{**{key: row[key] for key in ("run", "title", "mark", "color")}, **numbers_of_mesh(row["folder"])}
            for row in rows if row["run"] in runs]


def numbers_of_score(score):
    return {"tolerance_m": score["tolerance"], "precision": score["precision"], "recall": score["recall"],
            "f_score": score["f_score"]}


def numbers(folder, file):
    result = json.loads((folder / file).read_text())
    accuracy = result["accuracy"]
    return {"folder": folder, "histogram": result["accuracy_histogram"],
            "points": accuracy["count"], "mean_m": accuracy["mean"],
            "median_m": accuracy["median"], "rms_m": accuracy["rms"],
            **numbers_of_score(result["scores"][0]), "seconds": float((folder / "seconds").read_text())}


def numbers_of_mesh(folder):
    result = json.loads((folder / "mesh.json").read_text())
    seen = result["seen"]
    return {"folder": folder, "vertices": result["topology"]["vertices"], "median_m": seen["accuracy"]["median"],
            **numbers_of_score(seen["scores"][0]), "normals_within_10": seen["normals"]["within_10_20_30"][0],
            "psnr_db": result["render"]["psnr"], "seconds": float((folder / "mesh-seconds").read_text())}


# The columns of a table: key of the number, heading, form of a cell, and factor of the number.
F_SCORE, SECONDS = ("f_score", "F-score at {:g} mm", "{:.3f}", 1), ("seconds", "seconds", "{:.0f}", 1)
MEDIAN = ("median_m", "median [mm]", "{:.2f}", 1e3)
OF_CLOUDS = (("points", "points", "{:,}", 1), ("mean_m", "mean [mm]", "{:.2f}", 1e3), MEDIAN,
             ("rms_m", "RMS [mm]", "{:.2f}", 1e3), F_SCORE, SECONDS)
OF_MESHES = (("vertices", "vertices", "{:,}", 1), MEDIAN, ("precision", "precision", "{:.3f}", 1),
             ("recall", "completeness", "{:.3f}", 1), F_SCORE,
             ("normals_within_10", "normals to 10 deg", "{:.0f} %", 100), ("psnr_db", "PSNR [dB]", "{:.1f}", 1),
             SECONDS)


def table(first, columns, rows):
    """The headings, and the cells of each of `rows`. `first`: the heading of the names."""
    tolerance = rows[0]["tolerance_m"] * 1e3
    return [[first, *(heading.format(tolerance) for _, heading, _, _ in columns)],
            *([f"{row['mark']} {row['title']}", *(form.format(row[key] * factor) for key, _, form, factor in columns)]
              for row in rows)]


def of_clouds(rows):
    return table("", OF_CLOUDS, rows)


def of_meshes(rows):
    return table("mesh", OF_MESHES, rows)


def text_table(table):
    """A table of cells as text. The first row holds the headings."""
    widths = [max(len(line[i]) for line in table) for i in range(len(table[0]))]
    lines = ["  ".join(cell.ljust(w) if i == 0 else cell.rjust(w)
                       for i, (cell, w) in enumerate(zip(line, widths))) for line in table]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


OF_THE_PAGE = ("title", "mark", "color", "meaning", "folder", "histogram")


def json_table(lines, meshes, scene, size):
    """The text of table.json: the numbers of the rows about clouds and meshes."""
    runs, meshes = ([{key: value for key, value in row.items() if key not in OF_THE_PAGE} for row in rows]
                    for rows in (lines, meshes))
    return json.dumps({"scene": scene, "size": size, "runs": runs, "meshes": meshes}, indent=1) + "\n"
