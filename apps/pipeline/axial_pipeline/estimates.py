# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough estimates of time, memory and disk space of a run up to the cloud, from number and size of the
photographs. Measured with COLMAP 3.8 on a Zen 4 (docs/performance.md)."""

import dataclasses
import os
import shutil

COLMAP_SIDE = 3200        # COLMAP makes larger photographs smaller before it looks for features [px]
MOST_FEATURES = 8192      # of a photograph, COLMAP's default
FEATURES_OF_PIXEL = 0.02  # on a seabed
OF_FEATURE = 160          # bytes in a database, with the descriptor
FEATURE_MEMORY = 240      # bytes a pixel, for each thread
FEATURE_SECONDS = 0.8     # CPU time of a megapixel
PAIR_SECONDS = (0.1, 1e-4)  # CPU time of a pair, and for each feature of a photograph
POSE_SECONDS = 4          # CPU time of a photograph, for COLMAP's mapper and RefinePoses
DEPTH_SECONDS = 1 / 0.22  # CPU time of a megapixel of a depth map
DEPTH_BYTES, CLOUD_BYTES = 20, 13  # a pixel of a depth map
DEPTH_MEMORY = (150 << 20, 450)    # bytes, and a pixel of a depth map
LEAST_SIDE, MOST_SIDE = 640, 2560  # of a depth map, with the default options [px]
NEIGHBOURS = {"sequential": 16, "cascade": 8, "spatial": 30, "vocabulary": 100}  # pairs of a photograph, at most
AFTER_THE_CLOUD = 1.5     # disk space with mesh, textures and page
RESTORED_BYTES = 1        # a pixel of a photograph without water, as JPEG


@dataclasses.dataclass
class Needs:
    seconds: dict    # CPU time by step
    memory: float    # bytes
    disk: float      # bytes
    cores: int


def shrunk(size, side):
    """The size of a photograph whose longer side is at most `side`, in pixels."""
    return size[0] * size[1] * min(1, side / max(size)) ** 2


def depth_pixels(size):
    """The pixels of a depth map: halved once if LEAST_SIDE is left, and at most MOST_SIDE."""
    side = max(size)
    return shrunk(size, min(MOST_SIDE, side / 2 if side / 2 >= LEAST_SIDE else side))


def pairs_of(matcher, count):
    """The pairs of photographs that are matched."""
    return min(count * (count - 1) / 2, NEIGHBOURS.get(matcher, count) * count)


def needs_of(given, sizes):
    """The Needs of a run. `sizes`: of the photographs [px]."""
    count, cores = len(sizes), len(os.sched_getaffinity(0))
    seen = [shrunk(size, COLMAP_SIDE) for size in sizes]
    depth = [depth_pixels(size) for size in sizes] if given.until != "poses" else [0]
    features = [min(MOST_FEATURES, FEATURES_OF_PIXEL * pixels) for pixels in seen]
    fixed, each = PAIR_SECONDS
    seconds = {"features": FEATURE_SECONDS * sum(seen) / 1e6,
               "matches": pairs_of(given.matcher, count) * (fixed + each * sum(features) / count),
               "poses": POSE_SECONDS * count,
               "depth maps": DEPTH_SECONDS * sum(depth) / 1e6}
    if given.match_restored:
        seconds["depth maps without water"] = seconds["depth maps"]
    memory = max(min(cores, count) * FEATURE_MEMORY * max(seen), DEPTH_MEMORY[0] + DEPTH_MEMORY[1] * max(depth))
    disk = 2 * OF_FEATURE * sum(features) + (DEPTH_BYTES + CLOUD_BYTES) * sum(depth)
    disk *= 1 if given.until in ("poses", "cloud") else AFTER_THE_CLOUD
    if given.restore_colors:
        disk += RESTORED_BYTES * sum(width * height for width, height in sizes) + CLOUD_BYTES * sum(depth)
    return Needs(seconds, memory, disk, cores)


def free_disk(out):
    """Free bytes where the folder `out` will be."""
    there = next(folder for folder in (out, *out.parents) if folder.is_dir())
    return shutil.disk_usage(there).free


def memory_of_machine():
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def in_words(size):
    return f"{size / 1e9:.1f} GB" if size >= 1e8 else f"{size / 1e6:.0f} MB"


def time_in_words(seconds):
    if seconds < 90:
        return f"{round(seconds, -1):.0f} s" if seconds >= 5 else "some seconds"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def warnings_about(needs, out):
    """Lines about memory and disk space that are too small."""
    free, memory = free_disk(out), memory_of_machine()
    if free < needs.disk:
        yield f"--output {out}: {in_words(free)} are free on this disk, and about {in_words(needs.disk)} are needed"
    if memory < needs.memory:
        yield (f"this machine has {in_words(memory)} of memory, and COLMAP needs about {in_words(needs.memory)} for "
               f"features on {needs.cores} processors: --features='--SiftExtraction.num_threads 1' needs less")


def lines_about(needs, out):
    """What and how much, for --check."""
    total = sum(needs.seconds.values()) / needs.cores
    parts = ", ".join(f"{name} {time_in_words(seconds / needs.cores)}" for name, seconds in needs.seconds.items())
    yield "time", f"about {time_in_words(total)} up to the cloud on {needs.cores} processors ({parts})"
    yield "memory", f"about {in_words(needs.memory)} of {in_words(memory_of_machine())}"
    yield "disk", f"about {in_words(needs.disk)}; {in_words(free_disk(out))} are free"
