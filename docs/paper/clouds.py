# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of simulated scenes that were reconstructed. Each function at the end of a section takes
the results of one experiment, as ReproducePaper writes them, and returns {file name: text}."""

import re
import statistics

from cells import millimetres, percent, results_of, table

# Sensitivity: a wrong housing file.

MISTAKES = {"none": "none", "distance_1mm": "distance to the glass, 1 mm",
            "distance_5mm": "distance to the glass, 5 mm", "distance_20mm": "distance to the glass, 20 mm",
            "tilt_0.1": "tilt, 0.1 degrees", "tilt_0.5": "tilt, 0.5 degrees", "tilt_2": "tilt, 2 degrees",
            "n_water_0.005": "refractive index of the water, 0.005",
            "thickness_2mm": "thickness of the glass, 2 mm"}


def sensitivity(results):
    rows = [("distance of the scene [m]", "wrong in the housing file", "points", "mean [mm]",
             "/ none wrong", "mean after a rigid move [mm]", "/ none wrong", "completeness [%]")]
    for name, part in results["parts"].items():
        distance, mistake = name.split("_", 1)
        result, right = part["result"], results_of(results, f"{distance}_none")
        means = []
        for how in ("as_it_lies", "moved"):
            mean = result[how]["mean"]
            means += [millimetres(mean), f"{mean / right[how]['mean']:.2f}"]
        rows.append((f"{result['scene_distance']:.2f}", MISTAKES[mistake],
                     str(result["as_it_lies"]["points"]), *means,
                     percent(result["as_it_lies"]["recall"])))
    return {"sensitivity.md": table(rows)}


# When a refractive model is needed.

NEED_TITLES = {"port_distance_mm": "lens to glass {:g} mm", "scale": "everything but the port, times {:g}",
               "tilt_degrees": "tilt {:g}\u00b0",
               "near_tilt_degrees": "everything but the port, times 0.5, and tilt {:g}\u00b0",
               "fov_degrees": "field of view {:g}\u00b0",
               "reef_relief": "seen from above, heights times {:g}", "relief": "heights times {:g}",
               "second_survey": "second survey, distance times {:g}"}
USUAL_SCALE = 0.5


def need_case(name):
    """(series, value) of a part; the value is None if the series has none."""
    match = re.fullmatch(r"(\D+)_([\d.]+)", name)
    return (match[1], float(match[2])) if match else (name, None)


def need_title(name):
    series, value = need_case(name)
    if value is None:
        return "the usual case" if name == "usual" else f"scene '{name}' as it comes"
    return NEED_TITLES[series].format(value / USUAL_SCALE if series == "scale" else value)


def need_row(name, part):
    result, scene = part["result"], part["inputs"]["scene"]
    ours, today = result["ours"], result["today"]
    field = lambda how, key: today[how] and today[how][key]
    moved = field("moved", "mean")
    return (need_title(name), f"{result['scene_distance']:.2f}", f"{result['range_ratio']:.2f}",
            f"{result['port_distance'] / result['scene_distance']:.3f}", f"{result['tilt_degrees']:.1f}",
            f"{result['fov_degrees']:g}", millimetres(ours["mean"]),
            f"{today['images']} of {scene[scene.index('--views') + 1]}", millimetres(today["centre_rms"]),
            millimetres(field("as_it_lies", "mean")), millimetres(moved),
            "-" if moved is None else f"{moved / ours['mean']:.2f}", percent(ours["recall"]),
            percent(field("moved", "recall")))


def need(results):
    rows = [("case", "scene distance [m]", "far / near", "glass / scene distance", "tilt [degrees]",
             "field of view [degrees]", "known port on true poses: mean [mm]", "self-calibrated: images",
             "camera centres, RMS [mm]", "mean [mm]", "mean after a rigid move [mm]",
             "after the move / known port", "complete, known port [%]", "complete, self-calibrated [%]")]
    return {"need.md": table(rows + [need_row(*part) for part in results["parts"].items()])}


# Completeness by the number of cameras that see a place.

def completeness_columns(report):
    """[(title, format, scale, path of the value in a report), ...]"""
    seen = [(title, ".1f", 100, ("by_views", k, "recall", 0))
            for k, title in enumerate(("seen by 2 [%]", "by 3 [%]", "by 4 or more [%]"))]
    optional = [("of 2 maps [%]", ".1f", 100, ("points_by_views", 0, "share")),
                ("their mean [mm]", ".3f", 1e3, ("points_by_views", 0, "mean")),
                ("error / expected, RMS", ".3f", 1, ("calibration", "rms")),
                ("density, most / least", ".2f", 1, ("strip", "ratio"))]
    return [*seen, ("precision [%]", ".1f", 100, ("scores", 0, "precision")),
            ("F", ".3f", 1, ("scores", 0, "f_score")), ("mean [mm]", ".3f", 1e3, ("accuracy", "mean")),
            ("gross [%]", ".3f", 100, ("gross", "share")), ("points", ".0f", 1, ("accuracy", "count")),
            *(column for column in optional if column[3][0] in report),
            ("CPU [s]", ".1f", 1, ("cpu_seconds",))]


def thickness_columns(report):
    columns = []
    for k, one in enumerate(report["by_thickness"]):
        title = "not thin" if one["least"] is None else f"from {one['least']:.1f} px" \
            if one["most"] is None else f"{one['least']:.1f} to {one['most']:.1f} px"
        columns.append((f"{title} [%]", ".1f", 100, ("by_thickness", k, "recall", 0)))
    return columns


def value_at(report, path):
    for key in path:
        report = report[key]
    return report


def seeds_table(results, columns):
    """One row for each seed, and a row of medians. A missing number is "-" and does not count."""
    reports = {name.removeprefix("seed"): part["result"] for name, part in results["parts"].items()}
    cell = lambda value, column: "-" if value is None else f"{column[2] * value:{column[1]}}"
    rows, medians = [("seed", *(column[0] for column in columns))], ["median"]
    for seed, report in reports.items():
        rows.append((seed, *(cell(value_at(report, column[3]), column) for column in columns)))
    for column in columns:
        known = [value for report in reports.values()
                 if (value := value_at(report, column[3])) is not None]
        medians.append(cell(statistics.median(known) if known else None, column))
    return table(rows + [medians])


def completeness(results):
    part = next(iter(results["parts"].values()))
    inputs, report = part["inputs"], part["result"]
    preset = inputs["scene"][inputs["scene"].index("--preset") + 1]
    text = (f"{preset}, {inputs['medium']}, {inputs['poses']} poses, tolerance "
            f"{1e3 * inputs['tolerance']:g} mm; gross: beyond {1e3 * report['gross']['distance']:g} mm\n\n"
            + seeds_table(results, completeness_columns(report)))
    if "by_thickness" in report:
        text += "\n" + seeds_table(results, thickness_columns(report))
    return {f"{results['experiment']}.md": text}
