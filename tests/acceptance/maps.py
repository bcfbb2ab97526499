# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on the maps of MapSurface, of a reef photographed through a port."""

import json
import re
import shutil
import subprocess
from xml.etree import ElementTree

from meshes import judged
from points import BASE, meshed, point
from support import runs
from support.runs import BIN, PROGRAMS, Skipped, measured

SEEDS = 41, 42, 43
HEIGHTS, PSNR, DISPLACEMENT = 1.2, 28, 0.5  # at most, of the mesh's RMS; [dB] at least; [px] at most
# At most: the difference between ground that fewer than two photographs see and open pixels, ground
# that is painted but hidden, and ground that is open but seen by two [% of the ground]; the lines
# across depth steps with a doubled edge, beyond those that a map with true heights and visibility
# seems to have, because of noise and the photographs' resolution [%].
OPEN, DOUBLED = 1, 3
CALIBRATION = 1.5  # at most, between expected and true errors, either way
CAP = 1000  # [MB]
COLUMNS, ROWS = 60_000, 20_000  # of the map in blocks [px]
MOST = 32_767  # pixels along a side of a picture that TagLab reads


def reef(work, seed):
    """The folder of a reef with scene_dense.mvs and mesh.ply, and its truth."""
    truth = runs.simulated(f"reef-{seed}", BASE, "--preset", "reef", "--views", 10, "--seed", seed,
                           tolerance=runs.TOLERANCES["reef"])
    folder = work / f"reef-{seed}-water-maps"
    meshed(folder, truth, "water", 1)
    return folder, truth


def mapped(folder, name, *options):
    """Makes the map `name` of a reef. Returns the cost, and the size of the map [px]."""
    log = folder / f"{name}.log"
    cost = measured(log, *PROGRAMS.map_surface(folder / "scene_dense.mvs", folder / "mesh.ply",
                                               folder / name, "--refractive", "--up", "0,0,1", *options))
    return cost, tuple(map(int, re.search(r"map of (\d+) x (\d+) pixels", log.read_text()).groups()))


def numbers_of(text, line):
    """The numbers in the line of map_check that begins with `line`."""
    found = re.search(rf"^{re.escape(line)}(.*)$", text, re.MULTILINE)[1]
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", found)]


def judged_map(folder, truth, seed, size, cost):
    """The text and the verdict of the map of one reef."""
    checked = folder / "check.log"
    measured(checked, BIN / "map_check", "reef", seed, 1, folder / "map", truth.data / "water")
    said = checked.read_text()
    heights, (psnr, *_) = numbers_of(said, "distances: ")[0], numbers_of(said, "colours: PSNR ")
    displacement = numbers_of(said, "displacement: ")[0]
    ratio, *fifths = numbers_of(said, "expected errors: ")
    hidden, once, is_open, painted, painted_once, seen_open, _ = numbers_of(said, "ground: ")
    doubled, lines = numbers_of(said, "edges of the orthomosaic: ")
    copy, visible, naive = (numbers_of(said, f"edges of {name}: ")[0] for name in (
        "the orthomosaic and its copy, 5 px apart", "a map with true heights and visibility",
        "a map without visibility"))
    mesh = 1000 * judged(folder, "mesh", truth, "water")["seen"]["accuracy"]["rms"]
    text = (f"seed {seed}: {size[0]} x {size[1]} pixels; heights {heights:.2f} mm RMS, mesh {mesh:.2f} "
            f"mm; PSNR {psnr:.1f} dB; displacement {displacement:.2f} px; hidden {hidden:.2f} %, seen "
            f"once {once:.2f} %, open {is_open:.2f} %, hidden but painted {painted:.2f} %, seen once "
            f"and painted {painted_once:.2f} %, seen more often but open {seen_open:.2f} %; doubled edges "
            f"{doubled:.1f} % of {lines:.0f} lines (true heights {visible:.1f} %, copy {copy:.1f} %, "
            f"without visibility {naive:.1f} %); "
            f"true errors {ratio:.2f} times the expected ones, fifths {fifths}; "
            f"{cost['cpu']:.0f} CPU-s, {cost['memory'] / 1e6:.0f} MB")
    return text, (heights <= HEIGHTS * mesh and psnr >= PSNR and displacement <= DISPLACEMENT
                  and abs(is_open - hidden - once) <= OPEN
                  # Errors of both kinds would cancel in this difference.
                  and max(painted, seen_open) <= OPEN
                  # The count finds the maps with doubled edges.
                  and doubled <= visible + DOUBLED < min(copy, naive)
                  and 1 / CALIBRATION <= ratio <= CALIBRATION
                  and fifths[1] < fifths[-1])  # the true errors of the first and the last fifth


@point(f"three seeds: RMS of the heights at most {HEIGHTS} times that of the mesh where views see it; "
       f"PSNR of the orthomosaic at least {PSNR} dB, its displacement at most {DISPLACEMENT} px; open "
       f"ground within {OPEN} % of what fewer than two photographs see, painted hidden ground and open "
       f"ground that two photographs see at most {OPEN} % each; doubled edges on at most {DOUBLED} "
       f"% more lines across depth steps than with true heights; expected errors right within a factor of "
       f"{CALIBRATION}")
def map_quality(work):
    texts, good = [], True
    for seed in SEEDS:
        folder, truth = reef(work, seed)
        cost, size = mapped(folder, "map")
        text, passed = judged_map(folder, truth, seed, size, cost)
        texts.append(text)
        good &= passed
    return " / ".join(texts), good


@point(f"a map of 900 million pixels with --max-memory {CAP}: at most 10 % above the cap")
def map_memory_cap(work):
    folder, _ = reef(work, SEEDS[0])
    cost, size = mapped(folder, "large", "--gsd", 0.00014, "--max-memory", CAP)
    for file in folder.glob("large.*"):
        if file.suffix != ".log":
            file.unlink()
    peak = cost["memory"] / 1e6
    return (f"{size[0]} x {size[1]} pixels: {peak:.0f} MB, {cost['wall']:.0f} s",
            size[0] * size[1] > 8e8 and peak <= 1.1 * CAP)


def extent_of(folder, name):
    """West, east, south and north of a map of mapped() with `--preset archive`."""
    root = ElementTree.parse(folder / f"{name}.archive.xml").getroot()
    return [float(root.findtext(f"extent/{side}")) for side in ("west", "east", "south", "north")]


def put_shape(file, kind, coordinates):
    """A GeoJSON with one feature in coordinates of a map without a reference system."""
    feature = {"type": "Feature", "properties": {"name": "a"}, "geometry": {"type": kind, "coordinates": coordinates}}
    file.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))


def mapped_in_blocks(folder, columns, rows):
    """The cost and the copies for TagLab of a map with this size, of the middle of the reef."""
    mapped(folder, "coarse", "--gsd", 0.02, "--preset", "archive")
    west, east, south, north = extent_of(folder, "coarse")
    width = (east - west) / 2
    left, bottom = west + width / 2, (south + north - width * rows / columns) / 2
    right, top = left + width, bottom + width * rows / columns
    put_shape(folder / "plot.geojson", "Polygon",
              [[[left, bottom], [right, bottom], [right, top], [left, top], [left, bottom]]])
    cost, size = mapped(folder, "blocks", "--boundary", folder / "plot.geojson", "--gsd", width / columns,
                        "--preset", "taglab", "--max-memory", CAP)
    return cost, size, sorted(file.name for file in folder.glob("blocks.taglab.*.tif"))


@point(f"a map of {COLUMNS} x {ROWS} pixels in blocks for TagLab with --max-memory {CAP}: at most 10 % above the cap, "
       f"two blocks of heights and two of colours")
def map_blocks_memory_cap(work):
    folder, _ = reef(work, SEEDS[0])
    cost, size, copies = mapped_in_blocks(folder, COLUMNS, ROWS)
    for file in folder.glob("blocks.*"):
        if file.suffix != ".log":
            file.unlink()
    peak = cost["memory"] / 1e6
    # The border of the polygon is rounded outwards to whole pixels.
    good = abs(size[0] - COLUMNS) <= 2 and abs(size[1] - ROWS) <= 2 and peak <= 1.1 * CAP
    return (f"{size[0]} x {size[1]} pixels: {peak:.0f} MB, {cost['wall']:.0f} s; {', '.join(copies)}",
            good and len(copies) == 2 * -(-COLUMNS // MOST))


def read_by_others(folder):
    """Whether other programs read copies, profiles and contours, by file. Programs that are not installed are left
    out."""
    rasters = [file for kind in ("taglab.*", "archive.*", "*_400") for file in folder.glob(f"copies.{kind}.tif")]
    vectors = [*folder.glob("copies.*.gpkg"), *folder.glob("copies.*.dxf")]
    commands = [("gdalinfo", rasters, ("-json", "-checksum")), ("ogrinfo", vectors, ("-al", "-so")),
                ("qgis_process", vectors, ("run", "native:extenttolayer", "--OUTPUT=TEMPORARY_OUTPUT"))]
    said = {}
    for program, files, options in commands:
        if shutil.which(program) is None:
            continue
        for file in files:
            named = f"--INPUT={file}" if program == "qgis_process" else file
            done = subprocess.run([program, *options, named], capture_output=True, text=True)
            said[f"{program} {file.name}"] = done.returncode == 0 and "ERROR" not in done.stderr
    return said


@point("copies for TagLab and archives, copies of other widths, profiles and contours are read by gdalinfo, ogrinfo "
       "and qgis_process, as far as they are installed")
def map_copies_are_read(work):
    folder, _ = reef(work, SEEDS[0])
    mapped(folder, "coarse", "--gsd", 0.02, "--preset", "archive")
    west, east, south, north = extent_of(folder, "coarse")
    put_shape(folder / "line.geojson", "LineString", [[0.7 * west + 0.3 * east, 0.7 * south + 0.3 * north],
                                                      [0.3 * west + 0.7 * east, 0.3 * south + 0.7 * north]])
    said = {}
    for preset in ("taglab", "archive", "gis"):
        mapped(folder, "copies", "--gsd", 0.005, "--preset", preset, "--widths", 400, "--contours", 0.1,
               "--profiles", folder / "line.geojson")
        said |= {f"{preset}: {name}": good for name, good in read_by_others(folder).items()}
    if not said:
        raise Skipped("neither gdalinfo nor ogrinfo nor qgis_process is installed")
    return f"{sum(said.values())} of {len(said)} files are read", all(said.values())
