# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of the paper's experiments, by matplotlib. Each function takes the results of one experiment,
as ReproducePaper writes them, and returns {file name: figure}."""

import base64
import io

import matplotlib
import matplotlib.figure
import numpy

import cells
import clouds
import reconstruction as reconstruction_tables
import simulations

# Colours by Okabe and Ito, which colour-blind readers can distinguish.
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#56b4e9", "#000000")
STYLE = {"font.size": 8, "axes.titlesize": 8, "axes.grid": True, "grid.color": "#e3e3e3",
         "legend.fontsize": 7, "legend.frameon": False, "axes.prop_cycle": matplotlib.cycler(color=COLORS)}


def grid(title, rows, columns, width, height):
    """A figure of rows x columns panels, each width x height inches, and its panels."""
    matplotlib.rcParams.update(STYLE)
    figure = matplotlib.figure.Figure(figsize=(width * columns, height * rows + 0.3), layout="constrained")
    figure.suptitle(title, fontsize=10)
    return figure, figure.subplots(rows, columns, squeeze=False).ravel()


def lines(panel, curves, title, x_title, y_title):
    """Curves with marked points on a logarithmic axis. `curves`: {name: [(x, y), ...]}."""
    for name, points in curves.items():
        panel.plot(*zip(*points), label=name, marker=".", linewidth=1)
    panel.set(title=title, xlabel=x_title, ylabel=y_title, yscale="log")


def one_legend(figure, panel):
    """A legend for panels that all have the curves of `panel`."""
    figure.legend(*panel.get_legend_handles_labels(), loc="upper center",
                  bbox_to_anchor=(0.5, 0), ncols=4)


def maps(title, panels, columns, highest):
    """`panels`: {title: values in rows}. Negative values are missing and drawn grey."""
    figure, axes = grid(title, -(-len(panels) // columns), columns, 1.9, 2.1)
    for axis in axes[len(panels):]:
        axis.set_visible(False)
    colors = matplotlib.colormaps["viridis"].with_extremes(under="#bebebe")
    for axis, (name, values) in zip(axes, panels.items()):
        image = axis.imshow(values, cmap=colors, vmin=0, vmax=highest, interpolation="nearest")
        axis.set_title(name, fontsize=6)
        axis.set_axis_off()
    figure.colorbar(image, ax=list(axes), label="px", shrink=0.6)
    return figure


DRAWN_BINS = 10  # drawn as one: errors in float are multiples of a coordinate's last bit


def density(method, unit):
    """The density of the errors, in units of `unit` pixels."""
    bins = numpy.array(method["bins"])
    sums = bins[:len(bins) // DRAWN_BINS * DRAWN_BINS].reshape(-1, DRAWN_BINS).sum(axis=1)
    width = DRAWN_BINS * method["bins_upper"] / len(bins) / unit
    return [((k + 0.5) * width, count / method["count"] / width) for k, count in enumerate(sums)]


def figure2(results):
    series = simulations.series_of(results)
    figure, panels = grid("Reprojection error, " + simulations.sampling(results), 2, len(series), 2.9, 2.8)
    kinds = (("line_search", "Algorithm 1", 1, "error [px]"),
             ("exact", "exact projection, float", 1e-6, "error [millionths of a pixel]"))
    for k, (method, title, unit, x_title) in enumerate(kinds):
        for panel, (name, values) in zip(panels[k * len(series):], series.items()):
            curves = {f"{simulations.value_title(name, value)}: mean "
                      f"{cells.significant(result[method]['mean'])} px": density(result[method], unit)
                      for value, result in values}
            for label, points in curves.items():
                panel.plot(*zip(*points), label=label, linewidth=1)
            panel.set(title=title, xlabel=x_title, ylabel="density", ylim=(0, None))
            panel.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2))
    return {"figure2.png": figure}


def runtime(results):
    figure, panels = grid("One forward projection, one thread, float", 1, 2, 4, 3)
    titles = ("points scattered over the image", "neighbouring points in turn")
    for panel, order, title in zip(panels, simulations.ORDERS, titles):
        curves = {name: [(size, cells.results_of(results, f"{order}_{size}mp")[method]["nanoseconds"])
                         for size in simulations.megapixels(results)]
                  for method, name in simulations.PROJECTIONS.items()}
        lines(panel, curves, title, "image size [megapixels]", "time per projection [ns]")
    one_legend(figure, panels[0])
    return {"runtime.png": figure}


def figure3(results):
    figures = {}
    for setup in (1, 2):
        result = cells.results_of(results, f"setup{setup}")
        side = result["texels_across"]
        panels = {title: numpy.reshape(result["errors"][warp], (side, side))
                  for warp, title in simulations.SHOWN_WARPS.items()}
        highest = max(values.max() for values in panels.values())
        figures[f"figure3_setup{setup}.png"] = maps(
            f"Error of every texel of every patch, 10 x 10 image, setup {setup}", panels, 4, highest)
    return figures


def patch_maps(results, setup, warp):
    panels, side = {}, 100
    for series, values in simulations.series_of(results, setup, "_100px").items():
        for value, result in values:
            mean = cells.significant(result["warps"][warp]["mean"])
            panels[f"{simulations.value_title(series, value)}:\nmean {mean} px"] = 1e-6 * numpy.reshape(
                result["maps_in_millionths"][warp], (side, side))
    return maps(f"Mean patch error, 100 x 100 image, setup {setup}: {simulations.WARPS[warp]}", panels, 6,
                max(values.max() for values in panels.values()))


def figure4(results):
    figures = {f"figure4_setup{setup}_{warp}.jpg": patch_maps(results, setup, warp)
               for setup in (1, 2) for warp in ("papers", "first_order")}
    series = simulations.series_of(results, 1, "_2048px")
    figure, panels = grid("Mean patch error, 2048 x 2048 image", 2, len(series), 2.3, 2.1)
    for k, setup in enumerate((1, 2)):
        for panel, (name, values) in zip(panels[k * len(series):],
                                         simulations.series_of(results, setup, "_2048px").items()):
            curves = {title: [(value, result["warps"][warp]["mean"]) for value, result in values]
                      for warp, title in simulations.WARPS.items()}
            lines(panel, curves, f"setup {setup}", simulations.SERIES_TITLES[name], "mean e_BH [px]")
    one_legend(figure, panels[0])
    return {**figures, "figure4_means.png": figure}


NEED_PANELS = (("port_distance_mm", "lens to glass [mm]", 20), ("scale", "distance of the scene [m]", None),
               ("tilt_degrees", "tilt [degrees]", 0), ("fov_degrees", "field of view [degrees]", 80),
               ("relief", "far / near, the outcrop", None),
               ("reef_relief", "far / near, a reef from above", None),
               ("second_survey", "second survey: distance / first one's", None))


def need_points(results, series, usual):
    """[(x, result), ...] of a series, by ascending x. `usual`: x of the usual case."""
    measured = {"scale": "scene_distance", "relief": "range_ratio", "reef_relief": "range_ratio"}
    points = []
    for name, part in results["parts"].items():
        of, value = clouds.need_case(name)
        if of == series or (name == "usual" and series not in ("reef_relief", "second_survey")):
            field = measured.get(series)
            x = part["result"][field] if field else usual if name == "usual" else value
            points.append((x, part["result"]))
    return sorted(points, key=lambda point: point[0])


def need(results):
    shown = [(title, points) for series, title, usual in NEED_PANELS
             if (points := need_points(results, series, usual))]
    figure, panels = grid("A known port on true poses beside a lens calibrated under water",
                          -(-len(shown) // 4), 4, 2.4, 2.2)
    for panel in panels[len(shown):]:
        panel.set_visible(False)
    kinds = {"known port, true poses": lambda result: result["ours"],
             "self-calibrated": lambda result: result["today"]["as_it_lies"],
             "self-calibrated, after a rigid move": lambda result: result["today"]["moved"]}
    for panel, (title, points) in zip(panels, shown):
        curves = {name: [(x, 1e3 * cloud(result)["mean"]) for x, result in points if cloud(result)]
                  for name, cloud in kinds.items()}
        lines(panel, {name: curve for name, curve in curves.items() if curve}, "", title,
              "mean distance [mm]")
    one_legend(figure, panels[0])
    return {"need.png": figure}


def sheet(title, panels, columns, width, height):
    """`panels`: {title: picture as PNG in base64}."""
    figure, axes = grid(title, -(-len(panels) // columns), columns, width, height)
    for axis, (name, picture) in zip(axes, panels.items()):
        axis.imshow(matplotlib.image.imread(io.BytesIO(base64.b64decode(picture)), format="png"))
        axis.set_title(name)
        axis.set_axis_off()
    return figure


def reconstruction(results):
    """Pictures of the first seed."""
    first = next(iter(results["parts"].values()))
    colors = f"0 to {1e3 * first['inputs']['evaluation']['color_max']:g} mm"
    on_colmaps, on_true = (reconstruction_tables.parts_of(results, poses)[0] for poses in ("colmap", "true"))
    titles = {method: reconstruction_tables.METHODS[method] for method in reconstruction_tables.JUDGED}
    return {
        "reconstruction_views.jpg": sheet(
            "The first of the views", {"in air": on_colmaps["photographs"]["air"],
                                       "through the port": on_colmaps["photographs"]["water"]}, 2, 4, 3.2),
        "reconstruction_clouds.jpg": sheet(
            f"Clouds on COLMAP's poses, coloured by their distance from the true surface, {colors}",
            {title: on_colmaps["clouds"][method]["picture"] for method, title in titles.items()}, 3, 3, 2.8),
        "reconstruction_depth.jpg": sheet(
            f"Depth maps on true poses: estimate, truth, error ({colors})",
            {title: on_true["pictures"][method] for method, title in titles.items()}, 1, 8, 2.5)}
