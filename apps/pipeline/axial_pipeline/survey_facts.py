# SPDX-License-Identifier: GPL-3.0-or-later
"""What a survey is, as parts of report.html: its photographs, cameras, housing and maps."""

import array
import base64
import json
import re

from . import files, model_text
from .report_html import paragraph, picture, table, without_folders

MOST_PHOTOGRAPHS = 5  # with the largest errors, that a table names


def refined(out):
    return files.read_object(out / "refined" / "report.json")


def overview(given, out, scene):
    """`scene`: what shown() returns."""
    found = refined(out)
    used = [image for image in found.get("images", []) if image.get("observations")]
    rows = [("Photographs with a pose", len(used)), ("Sparse points", found.get("points_after")),
            ("Observations of sparse points", found.get("observations_after")),
            ("Reprojection error [px]", f"{found['rms_after_px']:.3f}" if "rms_after_px" in found else None)]
    rows += [("Points of the cloud", scene.get("all_points")), ("Date", given.date or None)]
    return table((name, value) for name, value in rows if value is not None)


def photographs(out, lines):
    images = [image for image in refined(out).get("images", []) if image.get("rms_after_px") is not None]
    worst = sorted(images, key=lambda image: (-image["rms_after_px"], image["name"]))[:MOST_PHOTOGRAPHS]
    return "".join(paragraph(without_folders(line)) for line in lines) + table(
        ((image["name"], image["observations"], f"{image['rms_after_px']:.3f}") for image in worst),
        ("photograph", "observations", "error [px]"), "The photographs with the largest reprojection errors (root "
        "mean square)")


def lens_rows(out):
    file = out / "refined" / "sparse" / "cameras.txt"
    for line in model_text.records(file) if file.is_file() else ():
        words = line.split()
        if len(words) > 4:
            numbers = ", ".join(f"{float(word):.7g}" for word in words[4:])
            yield words[0], words[1], f"{words[2]} x {words[3]}", numbers


# Numbers of a port: the field of the housing file, the name, the factor to the unit, and the unit.
NUMBERS = (("distance_m", "distance of the glass from the entrance pupil", 1e3, "mm"),
           ("inner_radius_m", "inner radius of the dome", 1e3, "mm"),
           ("thickness_m", "thickness of the glass", 1e3, "mm"),
           ("n_air", "refractive index of the air", 1, ""), ("n_glass", "refractive index of the glass", 1, ""),
           ("n_water", "refractive index of the water", 1, ""), ("normal", "normal of the port", 1, ""),
           ("center_m", "centre of the dome", 1e3, "mm"))


def text_of(value, factor, unit, digits=6):
    """One or several numbers, with this number of significant digits."""
    values = value if isinstance(value, list) else [value]
    return f"{', '.join(f'{factor * one:.{digits}g}' for one in values)} {unit}".strip()


def port_rows(name, port):
    yield f"{name}: kind", port.get("type", "not known"), ""
    sigmas = port.get("sigma", {})
    for field, words, factor, unit in NUMBERS:
        if field in port:
            sigma = sigmas.get(field)
            yield (f"{name}: {words}", text_of(port[field], factor, unit),
                   "" if sigma is None else text_of(sigma, factor, unit, 2))
    if "normal_degrees" in sigmas:
        yield f"{name}: direction of the normal", "see above", text_of(sigmas["normal_degrees"], 1, "degrees", 2)


def estimated_rows(found):
    for camera in found.get("cameras", []):
        for value in camera.get("free", []):
            number = lambda key: "not known" if value.get(key) is None else f"{value[key]:.6g}"
            sigma = lambda key: "not known" if value.get(key) is None else f"{value[key]:.2g}"
            yield (f"camera {camera['id']}: {value['name']}", value.get("unit") or "1",
                   f"{number('before')} ± {sigma('sigma_before')}", f"{number('value')} ± {sigma('sigma')}",
                   value.get("decided_by") or "not known")


def cameras(out):
    ports = files.read_object(out / "refined" / "housing.json").get("ports", {})
    return (table(lens_rows(out), ("camera", "lens model of COLMAP", "size [px]", "parameters (lengths in px)"),
                  "Lenses in air, as used for the results") +
            table((row for name, port in sorted(ports.items()) for row in port_rows(name, port)),
                  ("port", "value", "sigma"), "Housing, as used for the results. Sigma is one standard deviation; a "
                  "number that the photographs could change is below; a number in neither table was taken as stated") +
            table(estimated_rows(refined(out)), ("estimated number", "unit", "stated ± sigma", "found ± sigma",
                                                 "decided by the"), "Numbers that the photographs could change"))


def shown(out):
    """The description of the page of ViewScene; empty without one."""
    file = out / "page" / "data" / "scene.js"
    try:
        found = re.fullmatch(r"axialData\.scene\((.*)\);?\s*", file.read_text("utf-8"), re.DOTALL)
        scene = json.loads(found[1]) if found else {}
    except (OSError, ValueError):
        return {}
    return scene if isinstance(scene, dict) else {}


def coverage(out, heights):
    """The share of the places of the map that have a height. Zero means no height in the copy of the height map that
    the page has. None without this copy."""
    file = out / "page" / heights["file"]
    found = re.search(r'"heights",0,"([^"]*)"', file.read_text()) if file.is_file() else None
    if not found:
        return None
    values = array.array("H", base64.b64decode(found[1]))
    return 1 - values.count(0) / len(values) if values else None


def map_rows(out, scene):
    for layer in scene.get("map", {}).get("layers", []):
        if layer["id"] == "height":
            legend = layer["legend"]
            yield "Size of the map", f"{layer['place'][2]:.2f} m x {layer['place'][3]:.2f} m"
            yield "Heights (without the lowest and the highest 1 % of the map)", f"{legend['low']:.3f} m to {legend['high']:.3f} m"
    heights = scene.get("map", {}).get("heights")
    share = coverage(out, heights) if heights else None
    if share is not None:
        area = heights["place"][2] * heights["place"][3]
        yield "Coverage", (f"{100 * share:.1f} % of the rectangle of the map have a height: {share * area:.2f} m² in "
                           "the plane of the map")


def layer_pictures(out, scene):
    """The pictures of heights and their expected errors, with the values at the ends of the colours."""
    titles = {"height": "Heights with relief shading", "sigma": "Expected errors of the heights"}
    for layer in scene.get("map", {}).get("layers", []):
        if layer["id"] in titles:
            ends = "{low:.3f} m to {high:.3f} m".format(**layer["legend"])
            yield picture(out / "page" / layer["file"], f"{titles[layer['id']]}, from dark to light: {ends}")


def maps(given, out, made, scene):
    """`made`: the names of the steps."""
    if given.dates and not given.date:
        return paragraph("The maps are in the reports of the dates, dates/DATE/report.html.")
    if "map" not in made:
        return paragraph("This run made no map.")
    return (picture(out / "scene_map.jpg", "Orthomosaic") + table(map_rows(out, scene)) +
            "".join(layer_pictures(out, scene)))
