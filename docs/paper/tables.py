# SPDX-License-Identifier: GPL-3.0-or-later
"""Markdown tables of the paper's experiments. Each function takes the results of one experiment, as
ReproducePaper writes them, and returns {file name: text}. Lengths in results are in metres."""

import math
import re
import statistics

SERIES_TITLES = {"fov_degrees": "field of view [degrees]", "distance_mm": "interface distance [mm]",
                 "tilt_degrees": "interface tilt [degrees]", "plane_degrees": "plane angle [degrees]",
                 "n_glass": "refractive index of the glass", "n_water": "refractive index of the water"}


def table(rows):
    """The table with these rows of cells. The first row is the header."""
    lines = ["| " + " | ".join(row) + " |\n" for row in rows]
    lines.insert(1, "|---" * len(rows[0]) + "|\n")
    return "".join(lines)


def significant(value, digits=3):
    """The number rounded to `digits` significant digits, without an exponent: "0.267", "24600"."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)
    rounded = math.copysign(math.floor(abs(value) / unit + 0.5) * unit, value)
    # Rounding may have added a digit: 9.996 became 10.00.
    decimals = digits - 1 - math.floor(math.log10(abs(rounded * (1 + 1e-12))))
    return f"{rounded:.{max(0, decimals)}f}"


def millimetres(metres):
    return "-" if metres is None else significant(1e3 * metres)


def percent(fraction):
    return "-" if fraction is None else f"{100 * fraction:.1f}"


def verdicts(*rows):
    """A table of requirements: (what is asked, what is seen, whether it is met)."""
    return table([("asked", "seen", "met")] + [(asked, seen, "yes" if met else "no")
                                               for asked, seen, met in rows])


def results_of(results, part):
    return results["parts"][part]["result"]


def series_of(results, setup=1, size=""):
    """{series: [(value, result), ...]} of the parts setup<setup>_<series>_<value><size>, by ascending
    value. Each series contains the default setup."""
    default = results["parts"][f"setup{setup}_default{size}"]
    inputs = default["inputs"].get("setup", default["inputs"])
    usual = {**inputs["camera"], "plane_degrees": inputs.get("plane_degrees"),
             "distance_mm": 1e3 * inputs["camera"]["distance"]}
    found = {}
    for name, part in results["parts"].items():
        if match := re.fullmatch(rf"setup{setup}_(\D+)_([\d.]+){size}", name):
            one = found.setdefault(match[1], [(usual[match[1]], default["result"])])
            one.append((float(match[2]), part["result"]))
    return {name: sorted(values, key=lambda pair: pair[0]) for name, values in found.items()}


def value_title(series, value):
    if series == "distance_mm":
        return f"distance {value:g} mm"
    title = SERIES_TITLES[series].split(" [")[0]
    return f"{title} {value:g}" + ("" if series.startswith("n_") else "\u00b0")


# Figure 2: errors of projections.

def sampling(results):
    inputs = next(iter(results["parts"].values()))["inputs"]
    return f"{inputs['size']} x {inputs['size']} image, positions {inputs['step']:g} px apart"


def figure2(results):
    rows = [("varied", "value", "Algorithm 1: mean [px]", "median", "95 %", "largest", "missed",
             "exact, float: mean [px]", "95 %", "largest", "missed")]
    for series, values in series_of(results).items():
        for value, result in values:
            papers, exact = result["line_search"], result["exact"]
            rows.append((SERIES_TITLES[series], f"{value:g}",
                         *(significant(papers[key]) for key in ("mean", "median", "p95", "largest")),
                         str(papers["missed"]),
                         *(significant(exact[key]) for key in ("mean", "p95", "largest")),
                         str(exact["missed"])))
    means = [part["result"]["line_search"]["mean"] for part in results["parts"].values()]
    ours = max(part["result"]["exact"]["largest"] for part in results["parts"].values())
    return {"figure2.md": table(rows) + f"\n({sampling(results)})\n",
            "figure2_verdicts.md": verdicts(
                ("Algorithm 1: mean of 0.24 to 0.29 px for every value",
                 f"{significant(min(means))} to {significant(max(means))} px",
                 min(means) >= 0.24 and max(means) <= 0.29),
                ("exact projection, float: every error below 0.001 px", significant(ours) + " px",
                 ours < 1e-3))}


# Run time.

PROJECTIONS = {"exact": "exact projection", "line_search_plain": "line search, 8 numbers a pixel",
               "line_search_compact": "line search, 4 numbers (compact)",
               "line_search_tight": "line search, 2 numbers", "analytic": "12th-degree polynomial"}
ORDERS = ("scattered", "reading")


def megapixels(results):
    return sorted({int(re.search(r"\d+", name)[0]) for name in results["parts"]})


def timing_table(results, titles, cells):
    sizes = megapixels(results)
    rows = [("points", "method", *(f"{size} MP{title}" for size in sizes for title in titles))]
    for order in ORDERS:
        for method, title in PROJECTIONS.items():
            times = [results_of(results, f"{order}_{size}mp")[method] for size in sizes]
            rows.append((order, title, *(cell for time in times for cell in cells(time))))
    return table(rows)


def runtime(results):
    sizes = megapixels(results)
    ratio = lambda order, size, method: \
        results_of(results, f"{order}_{size}mp")[method]["ratio_to_exact"]
    processor = results_of(results, f"scattered_{sizes[0]}mp")["processor"]
    analytic = [("points", "12th-degree polynomial / line search of",
                 *(f"{size} MP" for size in sizes), "the paper, 2 to 10 MP")]
    for order in ORDERS:
        for method in list(PROJECTIONS)[1:-1]:
            analytic.append((order, PROJECTIONS[method].removeprefix("line search, "),
                             *(significant(ratio(order, size, "analytic") / ratio(order, size, method))
                               for size in sizes), "18 to 34"))
    faster = {size: ratio("scattered", size, "line_search_compact") for size in (sizes[0], sizes[-1])}
    least = min(ratio(order, size, "analytic") for order in ORDERS for size in sizes)
    return {
        "runtime.md": timing_table(results, (" [ns]", ", of exact"), lambda time: (
            significant(time["nanoseconds"]), significant(time["ratio_to_exact"])))
        + f"\nProcessor: {processor}\n",
        "runtime_errors.md": timing_table(results, (", mean error [px]", ", missed"), lambda time: (
            significant(time["mean_error"]), f"{time['missed']} of {time['points']}")),
        "runtime_analytic.md": table(analytic),
        "runtime_verdicts.md": verdicts(
            *((f"scattered points, {size} MP: exact projection at least 10 times faster than the "
               "compact line search", significant(value), value >= 10)
              for size, value in faster.items()),
            ("exact projection at least 300 times faster than the polynomial, every size",
             significant(least), least >= 300))}


# Figure 3: errors within patches.

SHOWN_WARPS = {"papers": "the paper's", "exact_centre": "f_v = f, exact centre",
               "scaled": "local virtual scale", "first_order": "first-order exact"}


def figure3(results):
    rows = [("setup", "warp", "mean [px]", "largest [px]")]
    for setup in ("1", "2"):
        for warp, title in SHOWN_WARPS.items():
            errors = [e for e in results_of(results, f"setup{setup}")["errors"][warp] if e >= 0]
            rows.append((setup, title, significant(sum(errors) / max(1, len(errors))),
                         significant(max(errors, default=0))))
    return {"figure3.md": table(rows)}


# Figure 4: mean errors of patches.

WARPS = {"papers": "the paper's: Algorithm 1, nearest pixel",
         "rounded": "exact projection, nearest pixel", "exact_centre": "exact centre, f_v = f",
         "scaled_rounded": "local virtual scale, nearest pixel",
         "scaled": "local virtual scale, exact centre", "first_order": "first-order exact",
         "per_texel": "every texel, float"}
# Mean errors [px] of a prototype that was written independently before this project, for 2048 x 2048
# pixels and indices 1.52 and 1.333: setup, series, value; the paper's warp (rounded lookup), the
# exact lookup with f_v = f, and the first-order exact warp.
PROTOTYPE = ((1, "fov_degrees", 80, 0.475, 0.454, 0.0022), (1, "fov_degrees", 100, 0.706, 0.685, 0.0034),
             (1, "distance_mm", 100, 0.462, 0.440, 0.0021), (1, "tilt_degrees", 6, 0.502, 0.481, 0.0024),
             (1, "plane_degrees", 40, 0.487, 0.463, 0.0025), (2, "fov_degrees", 80, 0.254, 0.205, 0.0010))


def patch_table(results, size, header, cells):
    rows = [("setup", "varied", "value", *header)]
    for setup in (1, 2):
        for series, values in series_of(results, setup, size).items():
            rows += [(str(setup), SERIES_TITLES[series], f"{value:g}", *cells(result))
                     for value, result in values]
    return table(rows)


def terms(result):
    """The parts of the error, and which part is larger."""
    warps = result["warps"]
    return (str(result["centres"]), significant(warps["exact_centre"]["mean"]),
            significant(warps["rounded"]["mean_at_centre"]),
            significant(warps["papers"]["mean_at_centre"]),
            *(f"{100 * result[key]:.0f} %" for key in ("rounding_over_warp", "papers_rounding_over_warp",
                                                       "middle_not_least")))


TERMS = ("patches", "warp alone [px]", "rounding alone, nearest pixel [px]",
         "rounding alone, Algorithm 1 [px]", "patches with more rounding than warp",
         "the same, Algorithm 1", "patches whose middle is not the best texel")


def means_beside_prototype(results, setup, series, value):
    return {warp: dict(series_of(results, setup, "_2048px")[series])[value]["warps"][warp]["mean"]
            for warp in WARPS}


def prototype_table(results):
    rows = [("setup", "varied", "value", "prototype's paper's warp", "exact projection, nearest pixel",
             "/ prototype's", "Algorithm 1, nearest pixel", "/ prototype's",
             "prototype's exact lookup, f_v = f", "ours", "prototype's first-order exact", "ours")]
    for setup, series, value, rounded, exact_centre, first_order in PROTOTYPE:
        ours = means_beside_prototype(results, setup, series, value)
        rows.append((str(setup), SERIES_TITLES[series], f"{value:g}", significant(rounded),
                     significant(ours["rounded"]), f"{ours['rounded'] / rounded:.3f}",
                     significant(ours["papers"]), f"{ours['papers'] / rounded:.3f}",
                     significant(exact_centre), significant(ours["exact_centre"]),
                     significant(first_order, 2), significant(ours["first_order"])))
    return table(rows)


def figure4_verdicts(results):
    ours = max(result["warps"]["first_order"]["mean"] for setup in (1, 2)
               for series, values in series_of(results, setup, "_2048px").items()
               for value, result in values if series != "fov_degrees" or value == 80)
    rows = [("first-order exact, 2048 px, 80 degrees: every mean at most 0.005 px",
             significant(ours) + " px", ours <= 0.005)]
    for warp in ("rounded", "papers"):
        for setup in (1, 2):
            deviation = max(abs(means_beside_prototype(results, *row[:3])[warp] / row[3] - 1)
                            for row in PROTOTYPE if row[0] == setup)
            rows.append((f"{WARPS[warp]}, setup {setup}: within 10 % of the prototype",
                         f"{100 * deviation:.1f} %", deviation <= 0.1))
    return verdicts(*rows)


def figure4(results):
    documents = {}
    for size in ("_100px", "_2048px"):
        documents[f"figure4{size}.md"] = patch_table(results, size, WARPS.values(), lambda result: [
            significant(result["warps"][warp]["mean"]) for warp in WARPS])
        documents[f"figure4_terms{size}.md"] = patch_table(results, size, TERMS, terms)
    return {**documents, "figure4_prototype.md": prototype_table(results),
            "figure4_verdicts.md": figure4_verdicts(results)}


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
