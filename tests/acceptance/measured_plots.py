# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots on noisy meshes of a surface with closed forms, measured by MeasureSurface: a slope, a mound on it, waves, and
a plate that hangs over the ground. One line a number: its largest and root mean square error in percent, its stated
standard deviation, and the share of the draws whose truth is within two of them.

    python3 tests/acceptance/measured_plots.py [--draws 20] [--noise 0.0004] [--base DIR]
"""

import argparse
import array
import csv
import json
import math
import pathlib
import random
import subprocess
import sys

sys.path[:0] = map(str, pathlib.Path(__file__).resolve().parents[:2])
from points import BASE, point  # noqa: E402
from support.runs import BIN  # noqa: E402

DRAWS, NOISE = 100, 0.0004   # [m]: a twenty-fifth of the distance of the vertices
WITHIN, COVERED = 1, 0.95    # [%], share
SPACING = 0.01               # [m]
SLOPE = 0.2, -0.1
MOUND = -0.5, -0.5, 0.35, 0.1         # x, y, radius, height of a paraboloid
WAVE, AMPLITUDE = 0.2, 0.015          # where x and y are above 0
PLATE = 0.5, -0.5, 0.15, 0.2          # x, y, half of the width, height over the ground
STEEP = math.sqrt(1 + SLOPE[0] ** 2 + SLOPE[1] ** 2)


def ground(x, y):
    mound = MOUND[3] * (1 - ((x - MOUND[0]) ** 2 + (y - MOUND[1]) ** 2) / MOUND[2] ** 2)
    k = 2 * math.pi / WAVE
    wave = AMPLITUDE * math.sin(k * x) * math.sin(k * y) if x > 0 and y > 0 else 0
    return SLOPE[0] * x + SLOPE[1] * y + max(0, mound) + wave


def area_over(left, low, right, high, steps=400):
    """The area of the ground over a box: the midpoint rule, with slopes by differences."""
    total, d = 0, 1e-6
    for i in range(steps):
        for j in range(steps):
            x, y = left + (i + 0.5) * (right - left) / steps, low + (j + 0.5) * (high - low) / steps
            total += math.sqrt(1 + ((ground(x + d, y) - ground(x - d, y)) / (2 * d)) ** 2
                               + ((ground(x, y + d) - ground(x, y - d)) / (2 * d)) ** 2)
    return total / steps ** 2 * (right - left) * (high - low)


def box(x, y, half):
    return [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)]


PLOTS = {"slope": box(-0.5, 0.5, 0.4), "mound": box(*MOUND[:2], 0.4), "waves": box(0.5, 0.5, 0.4),
         "plate": box(*PLATE[:2], 0.3)}


def truths():
    """The true numbers of each plot."""
    found = {}
    for name, corners in PLOTS.items():
        area = (corners[2][0] - corners[0][0]) ** 2
        seen = area * STEEP if name in ("slope", "plate") else area_over(*corners[0], *corners[2])
        found[name] = {"planar_m2": area, "seen_m2": seen, "rugosity": seen / area}
    plate = (2 * PLATE[2]) ** 2
    found["mound"]["volume_above_m3"] = math.pi / 2 * MOUND[2] ** 2 * MOUND[3]
    found["plate"]["volume_above_m3"] = plate * PLATE[3]
    found["plate"]["surface_m2"] = found["plate"]["seen_m2"] + 2 * plate * STEEP
    return found


def patch(left, low, width, height_at, is_up, noise, draw, vertices, faces):
    """Adds the noisy graph of a function over a square. Inner vertices are shifted in their cells."""
    steps, first = round(width / SPACING), len(vertices) // 3
    for j in range(steps + 1):
        for i in range(steps + 1):
            inner = 0 < i < steps and 0 < j < steps
            x, y = (start + (k + (draw.uniform(-0.25, 0.25) if inner else 0)) * SPACING
                    for start, k in ((left, i), (low, j)))
            vertices.extend((x, y, height_at(x, y) + STEEP * draw.gauss(0, noise)))
    for j in range(steps):
        for i in range(steps):
            a = first + j * (steps + 1) + i
            b, c, d = a + 1, a + steps + 2, a + steps + 1
            faces.extend([(a, b, c), (a, c, d)] if is_up else [(a, c, b), (a, d, c)])


def write_mesh(file, seed, noise):
    draw, vertices, faces = random.Random(seed), array.array("f"), []
    patch(-1, -1, 2, ground, True, noise, draw, vertices, faces)
    for is_up, lift in ((True, PLATE[3]), (False, PLATE[3] - 0.02)):
        patch(PLATE[0] - PLATE[2], PLATE[1] - PLATE[2], 2 * PLATE[2], lambda x, y, up=lift: ground(x, y) + up, is_up,
              noise, draw, vertices, faces)
    numbers = array.array("i", [corner for face in faces for corner in face]).tobytes()
    with open(file, "wb") as out:
        out.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices) // 3}\nproperty float x\n"
                  f"property float y\nproperty float z\nelement face {len(faces)}\n"
                  "property list uchar int vertex_indices\nend_header\n".encode())
        out.write(vertices.tobytes())
        out.write(b"".join(b"\3" + numbers[k:k + 12] for k in range(0, len(numbers), 12)))


def measured(programs, folder, seed, noise):
    """The rows of the table of one draw, by the name of the plot."""
    folder.mkdir(parents=True, exist_ok=True)
    mesh, plots, output = folder / "mesh.ply", folder / "plots.geojson", folder / "plots"
    write_mesh(mesh, seed, noise)
    plots.write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"name": name}, "geometry": {
            "type": "Polygon", "coordinates": [[*map(list, corners), list(corners[0])]]}}
        for name, corners in PLOTS.items()]}))
    subprocess.run([programs / "MeasureSurface", "-i", mesh, "--areas", plots, "-o", output, "-v", "0"], check=True)
    with open(output.with_suffix(".csv"), newline="") as table:
        return {row["name"]: row for row in csv.DictReader(table)}


def draws(programs, base, count, noise):
    """A line for each number, the largest error [%], and the share of all draws that are covered."""
    wanted, errors = truths(), {}
    for seed in range(1, count + 1):
        rows = measured(programs, base / "measured-plots", seed, noise)
        for plot, numbers in wanted.items():
            for name, truth in numbers.items():
                errors.setdefault((plot, name), []).append(
                    (float(rows[plot][name]) - truth, float(rows[plot]["sigma_" + name]), truth))
    lines, largest, least = [], 0, 1
    for (plot, name), found in errors.items():
        percent = [100 * error / truth for error, _, truth in found]
        # Vertices are floats, and the table has six digits.
        covered = sum(abs(error) <= 2 * sigma + 2e-6 for error, sigma, _ in found) / count
        sigma = 100 * sum(sigma / truth for _, sigma, truth in found) / count
        lines.append(f"| {plot} | {name} | {max(map(abs, percent)):.3f} | "
                     f"{math.sqrt(sum(value ** 2 for value in percent) / count):.3f} | {sigma:.3f} | "
                     f"{100 * covered:.0f} |")
        largest, least = max(largest, *map(abs, percent)), min(least, covered)
    return lines, largest, least


HEAD = ("| plot | number | largest error [%] | root mean square [%] | stated [%] | covered [%] |\n"
        "|---|---|---|---|---|---|")


@point(f"areas, rugosities and volumes of plots on noisy meshes, {DRAWS} draws: within {WITHIN} %, and within two "
       f"stated standard deviations in {100 * COVERED:.0f} % of the draws")
def measured_plots(work):
    lines, largest, least = draws(BIN, work, DRAWS, NOISE)
    return "\n".join([HEAD, *lines]), largest <= WITHIN and least >= COVERED


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=BIN)
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    parser.add_argument("--draws", type=int, default=20)
    parser.add_argument("--noise", type=float, default=NOISE)
    given = parser.parse_args()
    lines, largest, least = draws(given.bin, given.base, given.draws, given.noise)
    print(HEAD, *lines, sep="\n")
    print(f"largest error {largest:.2f} %, covered in {100 * least:.0f} % of the draws at least")


if __name__ == "__main__":
    main()
