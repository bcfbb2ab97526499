# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the experiments that need no other program. Each function at the end of a section takes
the results of one experiment, as ReproducePaper writes them, and returns {file name: text}."""

import re

from cells import results_of, significant, table, verdicts

SERIES_TITLES = {"fov_degrees": "field of view [degrees]", "distance_mm": "interface distance [mm]",
                 "tilt_degrees": "interface tilt [degrees]", "plane_degrees": "plane angle [degrees]",
                 "n_glass": "refractive index of the glass", "n_water": "refractive index of the water"}


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
