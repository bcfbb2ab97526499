# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs of simulated seabeds without plates: the labels that FindTargets finds, of each family.

    python3 tests/acceptance/no_targets.py [--seeds 61 62 63 64 65] [--views 100] [--base DIR]
"""

import argparse
import pathlib
import sys

sys.path[:0] = map(str, pathlib.Path(__file__).resolve().parents[:2])
from points import BASE, point  # noqa: E402
from support import runs  # noqa: E402
from support.runs import BIN  # noqa: E402
from target_detection import FAMILIES, PRESETS, find  # noqa: E402

FRESH_SEEDS, VIEWS = (61, 62, 63, 64, 65), 100  # 1,000 photographs


def measure(preset, seed, views, base):
    """The labels that are found, by family."""
    folder = runs.simulated(f"no-targets-{preset}-{seed}", base, "--preset", preset, "--seed", seed, "--views", views,
                            "--medium", "water", "--truth", 0, "--coarseness", 2, "--samples", 2).data
    return {family: len(find(BIN, folder, family)) for family in FAMILIES}


HEAD = f"| scene | seed | photographs | {' | '.join(FAMILIES)} |\n|---|---|---|{'---|' * len(FAMILIES)}"


def row_of(preset, seed, views, found):
    return f"| {preset} | {seed} | {views} | {' | '.join(map(str, found.values()))} |"


@point("no false label in 1,000 photographs of simulated seabeds without plates")
def no_targets(work):
    lines, good = [HEAD], True
    for preset in PRESETS:
        for seed in FRESH_SEEDS:
            found = measure(preset, seed, VIEWS, work)
            lines.append(row_of(preset, seed, VIEWS, found))
            good &= not any(found.values())
    return "\n".join(lines), good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[60])
    parser.add_argument("--views", type=int, default=VIEWS)
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    given = parser.parse_args()
    print(HEAD)
    for preset in PRESETS:
        for seed in given.seeds:
            print(row_of(preset, seed, given.views, measure(preset, seed, given.views, given.base)), flush=True)


if __name__ == "__main__":
    main()
