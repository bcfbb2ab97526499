# SPDX-License-Identifier: GPL-3.0-or-later
"""Which photographs have poses, and why others have none."""

import json
import struct

from . import colmap, database, files, lenses
from .files import few
from .running import logged, tell

RECORD = "registered.json"
FREE = "free_lens"          # folder of the models with a lens that COLMAP calibrated
FOCAL = (0.7, 1.5)          # the focal length that COLMAP may find, in focal lengths of the start
FEW_FEATURES, FEW_MATCHES = 300, 30
LEFT_OUT = "{}, and left out"


def focal_lengths(model):
    """The focal lengths of the cameras of a binary model, by id. Empty if the file is damaged."""
    return {lens.number: lens.parameters[0] for lens in lenses.in_file(model / "cameras.bin")}


def starts(file):
    """The focal lengths with which COLMAP started, by id of the camera."""
    rows = database.rows_of(file, "SELECT camera_id, params FROM cameras WHERE params IS NOT NULL") or []
    return {camera: struct.unpack_from("<d", params)[0] for camera, params in rows if len(params) >= 8}


def has_sane_lens(model, file):
    """Whether the focal lengths of a model are near those of the start in the database `file`. Says so if
    they are not."""
    begun = starts(file)
    for camera, focal in focal_lengths(model).items():
        if camera in begun and not FOCAL[0] * begun[camera] <= focal <= FOCAL[1] * begun[camera]:
            tell(f"a model of {colmap.registered(model)} photographs is refused: its focal length ran from "
                 f"{begun[camera]:.0f} to {focal:.0f} px")
            return False
    return True


def scale_names(given):
    """The photographs that --scale-from images: may name."""
    kind, _, words = given.scale_from.partition(":")
    return set(words.replace('"', "").split(",")) if kind == "images" else set()


def try_free_lens(file, given, models, options, log):
    """Runs the mapper again, with a lens that it calibrates itself. Models whose lens ran away are removed."""
    free = models / FREE
    free.mkdir()
    logged(colmap.mapper(file, given.images, free, more=options), log, "poses", excuse=colmap.NO_MODEL)
    for model in list(free.iterdir()):
        if colmap.is_model(model) and not has_sane_lens(model, file):
            files.clear(model)


def take_best(file, given, out, options):
    """Renames the best model to colmap/best in the folder `out`. If COLMAP's lens was fixed and photographs
    have no pose, tries a free lens first. Writes and prints which photographs have no pose."""
    names, models = database.names(file), out / "colmap"
    photographs = sorted(names.values()) if names else []
    before = {name: LEFT_OUT.format(reason) for name, reason in database.left_out(file).items()}
    first = colmap.best_first([models], scale_names(given))
    if not given.lens_model and (not first or first[0][1] < len(photographs)):
        count = f"{first[0][1]} of {len(photographs)} photographs have" if first else "no photograph has"
        tell(f"{count} poses with the lens behind the port; COLMAP tries to calibrate a lens")
        try_free_lens(file, given, models, options, out / "logs" / "poses-free.log")
    found = colmap.best_first([models, models / FREE], scale_names(given))
    if not found:
        raise colmap.no_poses(out / "logs" / "poses.log")
    best, count = found[0]
    left_out = reasons(file, colmap.images_in(best), [(model, n) for model, n in found[1:]
                                                     if model.parent == best.parent])
    left_out |= before
    record = {"photographs": (len(photographs) or count) + len(before), "registered": count, "left_out": left_out}
    for line in lines_of(record):
        tell(line)
    others = [str(n) for model, n in found[1:] if model.parent == best.parent]
    if others:
        tell(f"COLMAP could not join all images: {len(others)} more models, of {', '.join(others)} images, "
              f"remain in {best.parent}")
    best.rename(models / "best")
    files.write(models / RECORD, json.dumps(record))


def reasons(file, registered, others):
    """Why photographs have no pose, by name. `others`: further models and their numbers of photographs."""
    if not registered:
        return {}
    found, matches = database.features(file) or {}, database.verified_matches(file)
    why = {}
    for name, one in found.items():
        if name in registered:
            continue
        model = next((n for model, n in others if name in colmap.images_in(model)), 0)
        why[name] = (f"in another model, of {model} photographs" if model
                     else f"{one.count} features" if one.count < FEW_FEATURES
                     else f"at most {matches[name]} matches with another photograph" if matches[name] < FEW_MATCHES
                     else "too few matches with points that have a place")
    return why


def after_refining(record, refined):
    """The record after RefinePoses gave poses to photographs that COLMAP left out. `refined`: its report."""
    found = refined.get("registered", {})
    given, reasons_now = found.get("photographs", []), {one["name"]: one["reason"] for one in found.get("left_out", [])}
    left_out = {name: reasons_now.get(name, reason) for name, reason in record["left_out"].items()
                if name not in given}
    return {**record, "registered": record["registered"] + len(record["left_out"]) - len(left_out),
            "left_out": left_out}


def lines_of(record):
    """How many photographs have poses, and why the others have none."""
    by_reason = {}
    for name, reason in record["left_out"].items():
        by_reason.setdefault(reason, []).append(name)
    yield f"{record['registered']} of {record['photographs']} photographs have poses"
    if by_reason:
        yield f"warning: {record['photographs'] - record['registered']} photographs have no pose"
    for reason, names in by_reason.items():
        yield f"no pose: {few(names)}: {reason}"


def lines_about(out):
    """lines_of() the refined model in the folder `out`, for the report. None without a record."""
    record = files.read_object(out / "colmap" / RECORD)
    return list(lines_of(after_refining(record, files.read_object(out / "refined" / "report.json")))) if record else []


def print_changes(out):
    """Prints lines_about(), if RefinePoses gave poses to photographs that COLMAP left out."""
    if files.read_object(out / "refined" / "report.json").get("registered", {}).get("photographs"):
        for line in lines_about(out):
            tell(line)
