# SPDX-License-Identifier: GPL-3.0-or-later
"""How good a survey is, as parts of report.html: scale, control, expected errors and changes."""

from . import control, files
from .report_html import paragraph, picture, table, without_folders
from .survey_facts import refined

RESTORED = "restored/colors.json"


def share_text(sigma):
    """A relative standard deviation. RefinePoses writes null for not known, and 0 for known poses."""
    return "not known" if sigma is None else "taken as known" if sigma == 0 else f"{100 * sigma:.2g} %"


def numbers(values):
    return ", ".join("-" if one is None else f"{one:.2f}" for one in values)


def control_tables(found):
    rows = [(row["name"], row["use"], row["photographs"], numbers(row["residual_mm"]),
             numbers(row["expected_sigma_mm"])) for row in control.rows_of(found)]
    return (paragraph(f"{found['targets']} targets at {found['observations']} places, {found['rms_px']:.3f} px "
                      "root mean square.") +
            table(rows, ("bar or control point", "use", "photographs", "found minus stated [mm]",
                         "expected sigma [mm]"), "Residuals: of a bar its length, of a point x, y and z. Entries with "
                  "the use \"check\" had no part in the result") +
            table(((without_folders(line),) for line in found.get("left_out", [])), ("left out",)))


def sources_of_scale(given, found):
    """The inputs of the adjustment that have lengths. Checks are no input."""
    if given.scale_from:
        yield f"--scale-from {without_folders(given.scale_from)}"
    if any(row["use"] != "check" for row in control.rows_of(found["control"])) if found.get("control") else False:
        yield "bars and control points"
    if any(camera["pose"] != "free" for rig in found.get("rigs", []) for camera in rig["cameras"]):
        yield "the rig (--rig)"


def scale(given, out):
    found = refined(out)
    sources = ", ".join(sources_of_scale(given, found))
    source = (f"The scale was given by {sources}." if sources else
              "No length and no position was given: the scale comes from the refraction at the port alone.")
    source += "".join(f" Not used: {without_folders(one)}." for one in found.get("unused", []))
    rows = [("Scale, one standard deviation", share_text(found.get("scale_sigma")))]
    return paragraph(source) + table(rows) + (control_tables(found["control"]) if found.get("control") else "")


def accuracy_rows(evaluation):
    accuracy = evaluation.get("accuracy", {})
    for name, key in (("mean", "mean"), ("median", "median"), ("root mean square", "rms")):
        if accuracy.get(key) is not None:
            yield f"Distance of the cloud from the true mesh, {name}", f"{1e3 * accuracy[key]:.3f} mm"
    for percent, value in accuracy.get("percentiles", {}).items():
        if percent in ("90", "99"):
            yield (f"Distance of the cloud from the true mesh, {percent} % of the points are nearer",
                   f"{1e3 * value:.3f} mm")


def color_rows(found):
    if "spread_after" in found:
        yield ("Difference of the light of a point between photographs, before and after the restoring",
               f"{100 * found['spread_before']:.1f} %, {100 * found['spread_after']:.1f} %")


def error_rows(out, made, scene):
    found = refined(out)
    yield "Scale", share_text(found.get("scale_sigma"))
    yield "Shape, as a share of the distance of the points", share_text(found.get("shape_sigma"))
    yield "Distances of the points from the cameras", share_text(found.get("depth_sigma"))
    for layer in scene.get("map", {}).get("layers", []) if "map" in made else ():
        if layer["id"] == "sigma":
            yield "Heights of the map: 99 % of the places are below", f"{1e3 * layer['legend']['high']:.2f} mm"
    if "evaluate" in made:
        yield from accuracy_rows(files.read_object(out / "evaluation.json"))
    if "colors" in made:
        yield from color_rows(files.read_object(out / RESTORED))


def errors(out, made, scene):
    """`made`: the names of the steps. `scene`: what shown() returns."""
    rows = error_rows(out, made, scene)
    return table(rows, ("quantity", "error"), "Errors are standard deviations unless the row names another measure")


def amount(part):
    sigma = f" ± {part['volume_sigma']:.6f}" if part.get("volume_sigma") is not None else ""
    return f"{part['volume']:.6f}{sigma} m³"


def changes(out, made):
    if "compare" not in made:
        return ""
    found = files.read_object(out / "scene.change.json")
    rows = [(name, amount(found[key]), f"{found[key]['area']:.4f} m²" if "area" in found[key] else "")
            for name, key in (("Came", "came"), ("Gone", "gone"), ("Net", "net")) if key in found]
    if "area_compared" in found:
        rows.append(("Compared", "", f"{found['area_compared']:.4f} m²"))
    return (table(rows, ("change", "volume ± standard deviation", "area")) +
            picture(out / "scene.change.jpg", "Significant changes"))
