# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs of several dates (--dates): poses are computed for all of them together, clouds, meshes and maps for
each date."""

import collections
import copy
import datetime
import fnmatch
import json
import os
import pathlib
import shutil

from . import files, model_text
from .failure import Failure

EXIF = "exif"        # the value of --dates for the dates in the Exif data
FOLDER = "dates"     # below the output folder: a folder for each date
RECORD = "dates.json"  # in FOLDER: shows that a run made it
LEAST = 3            # photographs of a date that is reconstructed


def add_options(parser):
    parser.add_argument("--dates", default="", help="the photographs are of several dates: exif, or a file of lines "
                        "PHOTOGRAPHS,DATE (docs/dates.md). The poses of all photographs are computed together; cloud, "
                        "mesh and maps are made for each date, and each date is compared with the first")
    parser.set_defaults(date="", joint="")  # of the run for one date


def check(given):
    """Refuses options that contradict --dates, and makes the path of the file absolute."""
    if not given.dates:
        return
    if given.dates != EXIF:
        given.dates = files.existing("--dates", given.dates, is_file=True)
    for name in ("cluster", "truth"):
        if getattr(given, name):
            raise Failure(f"--{name} {getattr(given, name)}: contradicts --dates {given.dates}")


def is_date(text):
    try:
        return datetime.date.fromisoformat(text).isoformat() == text
    except ValueError:
        return False


def rows_of(file):
    """Pairs of a pattern and a date, from a file of lines PHOTOGRAPHS,DATE."""
    rows = []
    try:
        lines = pathlib.Path(file).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise Failure(f"--dates {file}: cannot be read ({error})") from None
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        pattern, _, date = (word.strip() for word in line.replace("\t", ",").rpartition(","))
        if not pattern:
            raise Failure(f"{file}:{number}: must be PHOTOGRAPHS,DATE")
        if not is_date(date):
            raise Failure(f"{file}:{number}: '{date}' is no date of the form 2024-05-31")
        rows.append((pattern, date))
    return rows


def covers(pattern, name):
    """Whether a pattern of the file means a photograph: its name, a folder above it, or a pattern with * and ?."""
    return name == pattern or name.startswith(pattern.rstrip("/") + "/") or fnmatch.fnmatchcase(name, pattern)


def dates_in_file(file, names):
    rows = rows_of(file)
    for pattern, _ in rows:
        if not any(covers(pattern, name) for name in names):
            raise Failure(f"--dates {file}: '{pattern}' is no photograph and no folder of photographs")
    found = {}
    for name in names:
        dates = {date for pattern, date in rows if covers(pattern, name)}
        if len(dates) > 1:
            raise Failure(f"--dates {file}: {name} has {len(dates)} dates: {', '.join(sorted(dates))}")
        found[name] = dates.pop() if dates else ""
    return found


def assign(given, images, names):
    """The date of each photograph. `images`: Image by name (photographs.py); `names`: of those that are used."""
    if not given.dates:
        return {}
    found = ({name: images[name].exif.date for name in names} if given.dates == EXIF
             else dates_in_file(given.dates, names))
    without = [name for name in names if not found[name]]
    if without:
        raise Failure(f"--dates {given.dates}: {len(without)} photographs have no date: {files.few(without)}")
    if len(set(found.values())) < 2:
        raise Failure(f"--dates {given.dates}: all photographs are of {found[names[0]]}")
    return found


def in_words(dates):
    """How many photographs each date has."""
    counts = collections.Counter(dates.values())
    return ", ".join(f"{date} ({counts[date]} photographs)" for date in sorted(counts))


def of_images(report, names, model):
    """The report of RefinePoses about the photographs `names`, which `model` has."""
    images = [image for image in report["images"] if image["name"] in names]
    points = [line.split() for line in model_text.records(model / "points3D.txt") if line]
    return {**report, "images": images, "points_after": len(points),
            "observations_after": sum(len(words[8:]) // 2 for words in points)}


def write_model(refined, target, names):
    """The part of the result of RefinePoses that the photographs `names` are."""
    others = [name for name in model_text.image_numbers(refined / "sparse") if name not in names]
    model_text.copy(refined / "sparse", target / "sparse", without=others)
    shutil.copyfile(refined / "housing.json", target / "housing.json")
    report = of_images(files.read_object(refined / "report.json"), names, target / "sparse")
    (target / "report.json").write_text(json.dumps(report, indent=1))


def replace(source, target):
    """Moves the files of the folder `source` to `target`. Files with the same content keep their times, so that later
    steps are not done again."""
    for file in filter(pathlib.Path.is_file, files.below(source)):
        other = target / file.relative_to(source)
        other.parent.mkdir(parents=True, exist_ok=True)
        if not other.exists() or other.read_bytes() != file.read_bytes():
            os.replace(file, other)
    files.clear(source)


def claim(out):
    """Fails if the folder of the dates is there and no run made it."""
    folder = out / FOLDER
    if folder.is_dir() and any(folder.iterdir()) and not (folder / RECORD).exists():
        raise Failure(f"--output {out}: has a folder {FOLDER}/ that no run made; remove it, or give another --output")


def split(out, dates):
    """Writes the refined model of each date into `out`/dates/DATE/refined. Returns the names of the photographs with
    poses, by date. Dates of which too few photographs have poses are left out, with a warning."""
    registered = set(model_text.image_numbers(out / "refined" / "sparse"))
    found = {}
    for date in sorted(set(dates.values())):
        names = {name for name, one in dates.items() if one == date and name in registered}
        if len(names) < LEAST:
            print(f"warning: {date} is left out: {len(names)} of its photographs have poses, at least {LEAST} are "
                  "needed", flush=True)
            continue
        found[date] = names
    folder = out / FOLDER
    folder.mkdir(exist_ok=True)
    files.write(folder / RECORD, json.dumps({date: sorted(names) for date, names in found.items()}, indent=1))
    for date, names in found.items():
        made = folder / date / "refined.new"
        files.clear(made)
        (made / "sparse").mkdir(parents=True)
        write_model(out / "refined", made, names)
        replace(made, folder / date / "refined")
    return found


def runs_of(given, out, found, mesh_of):
    """The options of the run for each date. `mesh_of(given, folder)`: the mesh of such a run. The first date is
    compared with the survey of --earlier, the others with the first."""
    first = None
    for date in found:
        one = copy.copy(given)
        one.date, one.joint, one.output = date, str(out), str(out / FOLDER / date)
        if first is not None and given.until not in ("poses", "cloud"):
            one.earlier = str(first)
        first = first or mesh_of(one, pathlib.Path(one.output))
        yield one


def lines_of(found, out):
    """The table of the dates, for the report."""
    yield from ("", "| date | photographs | result |", "|---|---|---|")
    for date, names in found.items():
        yield f"| {date} | {len(names)} | {pathlib.Path(FOLDER) / date / 'report.md'} |"
