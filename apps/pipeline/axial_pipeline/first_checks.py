# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of a run's inputs before hours of work: the programs read the lens and the housing and parse the options
that they will get; names and values of --scale-from and --refine are compared with the photographs and ports."""

import collections
import math
import pathlib
import re
import tempfile

from . import cameras, colmap, estimates, files, lenses
from .failure import Failure
from .position_rows import split_fields
from .programs import Programs, words_of
from .running import answer_of

# What --refine of RefinePoses takes, and the kind of port that a value needs.
REFINED = {"normal": "flat", "distance": "flat", "centre": "dome", "thickness": "", "index": "", "focal": ""}
ALONE = (["auto"], ["none"])  # other values of --refine
KINDS = ("flat", "dome", "unknown")  # values of --housing instead of a file
PREFIX = "axial_first_check_"  # of a folder that exists only during the checks


def said_by(command):
    """Exit code and output of a command. The output is standard error if the command fails."""
    ended = answer_of(command)
    return ended.returncode, ended.stderr.strip() if ended.returncode else f"{ended.stdout}{ended.stderr}"


def reason_in(said, program):
    """The last line that a failed program said, without its name."""
    lines = [line for line in said.splitlines() if line.strip()] or ["ended without a message"]
    return lines[-1].strip().removeprefix(f"{program}: ").removeprefix("ERROR: ")


def lens_behind_port(given, lens, housing, folder):
    """Lets RefinePoses read a lens and a housing as the run will. Returns its lines about the lens behind the
    port."""
    code, said = said_by(Programs(given.programs).effective_lens(lens, housing, folder / "lens.txt"))
    if code != 0:
        raise Failure(reason_in(said, "RefinePoses"))
    return re.findall(r"Camera \d+: .*", said)


def check_lens_and_housing(given):
    """Checks the contents of --lens and --housing. Returns lines about the lens behind the port."""
    with tempfile.TemporaryDirectory(prefix=PREFIX) as folder:
        return [line for text in given.lenses for line in
                lens_behind_port(given, lenses.given_as(text).file, given.housing, pathlib.Path(folder))]


def check_cameras(given):
    """As check_lens_and_housing(), for the lenses and the housing of several cameras."""
    with tempfile.TemporaryDirectory(prefix=PREFIX) as folder:
        out = pathlib.Path(folder)
        cameras.write(given, out)
        return lens_behind_port(given, cameras.lens_file(given, out), cameras.housing_file(given, out), out)


ONE_POINT = """ply
format ascii 1.0
element vertex 1
property float x
property float y
property float z
end_header
0 0 0
"""


def check_system(given):
    """Lets TransformScene read the code of --epsg as the run will: MapSurface and RefinePoses would refuse a wrong
    one after hours."""
    if not given.epsg:
        return
    with tempfile.TemporaryDirectory(prefix=PREFIX) as folder:
        cloud = pathlib.Path(folder) / "cloud.ply"
        cloud.write_text(ONE_POINT)
        code, said = said_by(Programs(given.programs).write_as_las(cloud, cloud.with_suffix(".las"), "--epsg",
                                                                   given.epsg))
        if code != 0:
            raise Failure(reason_in(said, "TransformScene"))


COMMANDS = {"features": ["colmap", "feature_extractor"], "poses": ["colmap", "mapper"]}


def command_of(name, given):
    """The program that gets the words of the option --`name`."""
    if name == "matches":
        return ["colmap", colmap.matching_command(given.matcher)]
    return COMMANDS.get(name)


def check_options_of_programs(given, programs_by_option):
    """Lets the programs parse the options that they will get. `programs_by_option`: as step_kinds.OPTIONS."""
    for name, program in programs_by_option.items():
        words = words_of(name, given)
        command = command_of(name, given) or [pathlib.Path(given.programs) / program]
        if not words:
            continue
        code, said = said_by([*command, *words, "--help"])
        if code != 0 or said.startswith("ERROR"):
            raise Failure(f"--{name} {getattr(given, name.replace('-', '_'))}: "
                          f"{reason_in(said, pathlib.Path(command[0]).name)}")


def ports_in(housing):
    """The ports in a housing file, by name; empty if they are not known here."""
    ports = files.read_object(pathlib.Path(housing)).get("ports")
    return {name: port for name, port in ports.items() if isinstance(port, dict)} if isinstance(ports, dict) else {}


def kinds_of_ports(housing):
    """The kinds of ports in a housing file, or of the word in its place; empty if they are not known here."""
    return {housing} - {"unknown"} if housing in KINDS else {port.get("type") for port in ports_in(housing).values()}


def check_refine(given):
    words, kinds = [word for word in given.refine.split(",") if given.refine], kinds_of_ports(given.housing)
    for word in words:
        if word not in REFINED and words not in ALONE:
            raise Failure(f"--refine {given.refine}: '{word}' is not one of {', '.join(REFINED)}")
        needed = REFINED.get(word)
        if needed and kinds and needed not in kinds:
            raise Failure(f"--refine {given.refine}: {word} belongs to a {needed} port, and --housing {given.housing} "
                          "has none")


def name_pairs(fields):
    """The pairs of names that a list of names with commas can mean."""
    return [(",".join(fields[:i]), ",".join(fields[i:-1])) for i in range(1, len(fields) - 1)]


def check_scale(given, photographs):
    """Checks --scale-from images: and points:. positions.py checks a file of positions. `photographs`: the names
    of the photographs that have a lens."""
    text = given.scale_from
    kind, colon, rest = text.partition(":")
    if not text or kind == "positions" and colon:
        return
    if kind not in ("images", "points") or not colon:
        raise Failure(f"--scale-from {text}: must begin with images:, points: or positions:")
    where = f"--scale-from {text}"
    fields = split_fields(rest, ",")
    if not fields:
        raise Failure(f"{where}: a double quote is not closed")
    if len(fields) < 3 or kind == "points" and len(fields) > 3:
        raise Failure(f"{where}: must give two ends and the distance between them in metres")
    check_length(fields[-1], where)
    if kind == "points":
        return
    pairs = name_pairs(fields)
    if not any(set(pair) <= set(photographs) for pair in pairs):
        missing = next(name for name in pairs[0] if name not in photographs)
        last = lambda name: pathlib.PurePath(name).name.lower()
        near = next((one for one in photographs if last(one) == last(missing)), "")
        hint = f"; there is {near}" if near else ""
        raise Failure(f"{where}: {given.images} has no photograph '{missing}'{hint}")
    if len(pairs) == 1 and pairs[0][0] == pairs[0][1]:
        raise Failure(f"{where}: both ends are the same")


def check_length(text, where):
    try:
        length = float(text)
    except ValueError:
        raise Failure(f"{where}: '{text}' is not a number") from None
    if not (length > 0 and math.isfinite(length)):
        raise Failure(f"{where}: {text} m is not a distance")


def ports_in_words(housing):
    if housing in KINDS:
        yield f"{housing}: usual numbers, which the photographs correct"
        return
    ports = ports_in(housing)
    for name, port in ports.items():
        numbers = ", ".join(f"{key} {value}" for key, value in port.items()
                            if key in ("distance_m", "inner_radius_m", "n_water"))
        yield f"{name}: {port['type']}, {numbers}"
    if not ports:
        yield housing


def sizes_in_words(images):
    counts = collections.Counter(image.size for image in images.values())
    return ", ".join(f"{count} of {size[0]} x {size[1]} pixels" if size else f"{count} of unknown size"
                     for size, count in counts.most_common())


def rows(given, images, lens_lines, needs):
    """What was found, for --check: pairs of a word and a text. `images`: Image by name (photographs.py)."""
    yield "photographs", f"{given.images}: {sizes_in_words(images)}"
    yield from (("lens", line) for line in lens_lines)
    yield from (("housing", line) for line in ports_in_words(given.housing))
    control = [f"--{name} {getattr(given, name)}" for name in ("bars", "control", "rig") if getattr(given, name)]
    yield "scale", (given.scale_from or ", ".join(control)
                    or "by refraction alone, which is weak: give --scale-from if a length is known")
    yield from estimates.lines_about(needs, pathlib.Path(given.output))
