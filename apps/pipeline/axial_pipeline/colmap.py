# SPDX-License-Identifier: GPL-3.0-or-later
"""COLMAP's commands, as lists of words, and the models that COLMAP writes."""

import shutil
import struct
import subprocess

from . import files
from .failure import Failure

# How versions of COLMAP call the options of features, of matches and of their verification.
EXTRACTION = ("SiftExtraction", "FeatureExtraction")
MATCHING = ("SiftMatching", "FeatureMatching")
VERIFICATION = ("SiftMatching", "TwoViewGeometry")


def check_installed():
    if not shutil.which("colmap"):
        raise Failure("colmap is not installed")


def help_of(command):
    shown = subprocess.run(["colmap", command, "--help"], capture_output=True, text=True)
    return shown.stdout + shown.stderr


def has_option(command, option):
    """Whether the installed version of COLMAP knows this option of a command."""
    return f"--{option} " in help_of(command)


def on_the_cpu(command, families, threads=None):
    """The options that keep a command of COLMAP off the graphics card and, if `threads` is given,
    limit its threads. `families`: the option names' first parts in all versions of COLMAP. Returns
    no options if the installed version knows none of them."""
    known = help_of(command)
    for family in families:
        if f"--{family}.use_gpu " in known:
            limit = [] if threads is None else [f"--{family}.num_threads", threads]
            return [f"--{family}.use_gpu", 0, *limit]
    return []


def features(database, images, camera_model, parameters=None, threads=None, masks=None, more=()):
    """Extracts features. All photographs share one camera. `parameters`: those that the camera
    starts with, in COLMAP's order. `masks`: a folder with COLMAP's masks (masks.py). `more`: further
    options."""
    start = ["--ImageReader.camera_params", parameters] if parameters else []
    start += ["--ImageReader.mask_path", masks] if masks else []
    return ["colmap", "feature_extractor", "--database_path", database, "--image_path", images,
            "--ImageReader.single_camera", 1, "--ImageReader.camera_model", camera_model, *start,
            *on_the_cpu("feature_extractor", EXTRACTION, threads), *more]


def of_extraction(option):
    """The name of an option of features in the installed version of COLMAP."""
    known = help_of("feature_extractor")
    family = next((family for family in EXTRACTION if f"--{family}.{option} " in known), EXTRACTION[0])
    return f"--{family}.{option}"


def weak_features(names, threshold):
    """The options for features with little contrast, of the photographs that the file `names` lists."""
    return ["--image_list_path", names, of_extraction("peak_threshold"), threshold]


def smaller(side):
    """The options for features of photographs whose longer side is at most `side` [px]. COLMAP states places and
    scales in pixels of the photographs as they are."""
    return [of_extraction("max_image_size"), side]


def matching_command(matcher):
    """The name of the command that matches the pairs of a matcher of matching.py."""
    return {"vocabulary": "vocab_tree_matcher", "cascade": "matches_importer"}.get(matcher, f"{matcher}_matcher")


def matches(database, matcher, threads=None, more=()):
    """Matches features. `matcher`: "exhaustive" for all pairs of images, "sequential", "spatial",
    "vocabulary" or, for a list of pairs, "cascade". `more`: further options of the command."""
    command = matching_command(matcher)
    return ["colmap", command, "--database_path", database, *more,
            *on_the_cpu(command, MATCHING, threads)]


def write_pairs(file, pairs):
    """Writes pairs of ids for listed_pairs(). COLMAP splits a line at its first blank, so that photographs, whose
    names may have blanks, must be named by their ids (database.name_by_ids)."""
    files.write(file, "".join(f"{one} {other}\n" for one, other in pairs))


def listed_pairs(file):
    """The option for the pairs of photographs that `file` lists, as write_pairs() writes them."""
    return ["--match_list_path", file]


def least_matches(count):
    """The option for the least number of verified matches of a pair."""
    known = help_of("matches_importer")
    family = next((family for family in VERIFICATION if f"--{family}.min_num_inliers " in known), VERIFICATION[0])
    return [f"--{family}.min_num_inliers", count]


def mapper(database, images, models, refine=None, threads=None, more=()):
    """Writes a numbered model into `models` for each group of images that COLMAP can join.
    `refine`: whether COLMAP refines the focal lengths and the distortion; if it is not given, COLMAP
    decides. `more`: further options."""
    limit = [] if threads is None else ["--Mapper.num_threads", threads]
    refined = [] if refine is None else [
        "--Mapper.ba_refine_focal_length", int(refine), "--Mapper.ba_refine_principal_point", 0,
        "--Mapper.ba_refine_extra_params", int(refine)]
    return ["colmap", "mapper", "--database_path", database, "--image_path", images,
            "--output_path", models, *limit, *refined, *more]


# What the mapper prints when it finds no poses.
NO_MODEL = "failed to create sparse model"


def database_files(database):
    """The files of a database, with those that a killed command leaves beside it."""
    return [database, *(database.with_name(database.name + end) for end in ("-wal", "-shm"))]


def is_model(folder):
    return any((folder / name).is_file() for name in ("images.bin", "images.txt"))


def images_in(model):
    """The ids of the images of a model, binary or text, by name. Empty if the file is damaged."""
    try:
        return images_in_binary(model) if (model / "images.bin").is_file() else images_in_text(model)
    except (struct.error, ValueError, LookupError):
        return {}


def images_in_text(model):
    lines = [line for line in (model / "images.txt").read_text().splitlines() if not line.startswith("#")]
    # Every image has two lines. The second line is empty if the image has no observations.
    fields = [line.split(" ", 9) for line in lines[::2] if line]
    return {one[9]: int(one[0]) for one in fields}


def images_in_binary(model):
    data, found, at = (model / "images.bin").read_bytes(), {}, 8
    for _ in range(struct.unpack_from("<Q", data)[0]):
        end = data.index(b"\0", at + 64)  # after the id, the pose and the id of the camera
        found[data[at + 64:end].decode(errors="replace")] = struct.unpack_from("<I", data, at)[0]
        at = end + 9 + 24 * struct.unpack_from("<Q", data, end + 1)[0]
    return found


def registered(model):
    """The number of images of a model, binary or text."""
    if (model / "images.bin").is_file():
        with open(model / "images.bin", "rb") as file:
            return struct.unpack("<Q", file.read(8))[0]
    return len(images_in(model))


def no_poses(log):
    return Failure(f"COLMAP found no poses: see {log}")


def best_first(folders, wanted=frozenset()):
    """The models in the folders of one or two runs of the mapper, each with its number of images: first the one
    with the most images, of two with equally many the one that has more of the images `wanted`."""
    found = [(registered(model), len(wanted & images_in(model).keys()), -number, model)
             for number, folder in enumerate(folders) if folder.is_dir()
             for model in sorted(folder.iterdir()) if is_model(model)]
    return [(model, count) for count, _, _, model in sorted(found, key=lambda one: one[:3], reverse=True)]
