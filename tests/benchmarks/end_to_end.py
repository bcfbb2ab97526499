#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost and quality of DensifyPointCloud as a whole program, beside the cost of COLMAP's feature
extraction (SIFT) on the same images. The programs run in turn, so that changes in the machine's
speed affect all alike. Prints medians, and for ratios the median and the range over the rounds.

    end_to_end.py [--runs N] [--json FILE] SCENE [OPTION OF DensifyPointCloud...]

SCENE: fountain, scene-v6       against SIFT, on real photographs
       closeup, reef            in air and refractive, against SIFT and the truth
       threads                  matching stage of fountain, with one thread and with two, in pairs
       memory                   peak memory against the number of images, 12 to 200 of 640 x 480,
                                with one sweep per level and one geometric pass. The options
                                --iters 1 --geometric-iters 1 save time and do not affect the
                                memory; do not give them again.
"""

import argparse
import json
import pathlib
import re
import shutil
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import runs  # noqa: E402

WORK = runs.ROOT / "build" / "benchmarks"
FOUNTAIN = ("--resolution-level", "2")
SCENE_V6 = ("--resolution-level", "0")


def alternated(programs, times):
    """Runs every program `times` times, in turn. Returns {name: [result, ...]}."""
    results = {name: [] for name in programs}
    for number in range(times):
        for name, program in programs.items():
            results[name].append(program())
            print(f"  {number + 1}/{times} {name}: {results[name][-1]['cpu']:.2f} CPU-s",
                  file=sys.stderr, flush=True)
    return results


def medians(results):
    return {key: statistics.median(result[key] for result in results) for key in results[0]}


# Programs.

def sift(work, images, *options):
    """COLMAP's feature extraction on the CPU, into a new database."""
    database = work / "sift" / "database.db"

    def run():
        database.parent.mkdir(parents=True, exist_ok=True)
        database.unlink(missing_ok=True)
        return runs.measured(work / "sift.log", "colmap", "feature_extractor", "--database_path",
                             database, "--image_path", images, "--ImageReader.single_camera", 1,
                             *options, "--SiftExtraction.use_gpu", 0)
    return run


PINHOLE = ("--ImageReader.camera_model", "PINHOLE")


def fountain_scene(work):
    folder = work / "fountain"
    runs.import_scene(folder, runs.shared("fountain-P11", "sparse"),
                      runs.shared("fountain-P11", "images"))
    return folder


def fountain(work, options=()):
    folder = fountain_scene(work)
    return {"DensifyPointCloud": lambda: runs.densify(folder, *FOUNTAIN, *options),
            "SIFT": sift(work, runs.shared("fountain-P11", "images"), *PINHOLE)}


def scene_v6(work, options=()):
    source, folder = runs.shared("openmvs-files"), work / "scene-v6"
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(source / "scene_v6.mvs", folder / "scene.mvs")
    if not (folder / "images").exists():
        (folder / "images").symlink_to(source / "images")
    return {"DensifyPointCloud": lambda: runs.densify(folder, *SCENE_V6, *options),
            "SIFT": sift(work, source / "images")}


def with_truth(work, name, options=()):
    """Runs in air and refractive, with true poses. Quality is the same in all runs and is measured
    once."""
    truth, programs = runs.synthetic(name, work), {}
    for medium in ("air", "water"):
        folder = work / f"{name}-{medium}"
        runs.import_scene(folder, truth.data / "sparse", truth.data / medium, truth.housing(medium))
        programs[medium] = evaluated_once(folder, truth, medium, options)
    return programs | {"SIFT": sift(work, truth.data / "air", *PINHOLE)}


def evaluated_once(folder, truth, medium, options):
    quality = {}

    def run():
        refractive = ["--refractive"] if medium == "water" else []
        cost = runs.densify(folder, *refractive, *options)
        quality.update(quality or runs.evaluate(folder, truth, medium))
        return cost | {"f": quality["f"], "mean": quality["mean"]}
    return run


# Reports.

HEADINGS = ("program", "CPU-s", "of SIFT", "range", "Mpx/CPU-s", "peak MiB", "points", "F", "mean mm")


def row(name, result):
    def cell(key, form, scale=1.0):
        return format(result[key] * scale, form) if key in result else ""
    speed = f"{result['megapixels'] / result['cpu']:.4f}" if "megapixels" in result else ""
    return (name, cell("cpu", ".2f"), cell("of_sift", ".3f"), spread(result), speed,
            cell("memory", ".0f", 2**-20), cell("points", ",.0f"), cell("f", ".4f"),
            cell("mean", ".4f", 1e3))


def spread(result):
    return f"{result['of_sift_least']:.3f} to {result['of_sift_most']:.3f}"


def markdown(headings, rows):
    line = lambda cells: "| " + " | ".join(str(cell) for cell in cells) + " |"
    return "\n".join([line(headings), "|" + "---|" * len(headings), *map(line, rows)])


def beside_sift(results, sift_results):
    """Median and range of the ratios of CPU time to that of SIFT. Each ratio compares runs of the
    same round, in which the machine was about equally fast."""
    ratios = [ours["cpu"] / sift["cpu"] for ours, sift in zip(results, sift_results)]
    return {"of_sift": statistics.median(ratios), "of_sift_least": min(ratios),
            "of_sift_most": max(ratios)}


def compared(programs, times):
    """The medians of all programs for the table."""
    rounds = alternated(programs, times)
    return {name: medians(results) | beside_sift(results, rounds["SIFT"])
            for name, results in rounds.items()}


def print_table(result):
    print(markdown(HEADINGS, [row(name, r) for name, r in result.items()]))


# Threads.

MATCHING = re.compile(r"(?:Estimated depth maps|Geometric-consistency pass \d+) "
                      r"\d+/\d+ \(100%, ([\d.]+)s\)")


def matching_seconds(log):
    """Wall time of the matching stage [s], read from the program's log."""
    times = [float(seconds) for seconds in MATCHING.findall(log.read_text())]
    if not times:
        raise RuntimeError(f"{log}: does not say how long matching took")
    return sum(times)


def threads(work, times, options=()):
    """Computes depth maps with one and with two threads, in turn. Returns the medians of the ratios
    of the pairs."""
    folder = fountain_scene(work)

    def on(count):
        def run():
            cost = runs.densify(folder, *FOUNTAIN, "--fusion-mode", 1, "--postprocess-dmaps", 0,
                                "--max-threads", count, *options)
            return cost | {"matching": matching_seconds(folder / "densify.log")}
        return run
    results = alternated({"1": on(1), "2": on(2)}, times)
    pairs = list(zip(results["1"], results["2"]))
    return {"speedup": statistics.median(a["matching"] / b["matching"] for a, b in pairs),
            "cpu": statistics.median(b["cpu"] / a["cpu"] for a, b in pairs),
            "seconds": [(a["matching"], b["matching"]) for a, b in pairs]}


# Memory.

def memory(work, counts=(12, 48, 100, 200), options=()):
    """Peak memory of runs on more and more images of the same size. Caches keep at most 48 images:
    memory grows up to 48 images and must not grow beyond."""
    rows = []
    for count in counts:
        model, images = runs.survey(count, work)
        folder = work / f"memory-{count}"
        runs.import_scene(folder, model, images)
        cost = runs.densify(folder, *runs.ONE_SWEEP, *options)
        rows.append({"images": count} | cost)
        print(f"  {count} images: {cost['memory'] / 2**20:.0f} MiB", file=sys.stderr, flush=True)
    return rows


def run_scene(scene, times, options):
    work = WORK / "end-to-end"
    if scene == "threads":
        result = threads(work, times, options)
        print(f"two threads: {result['speedup']:.3f} times faster (median of {times} pairs), "
              f"{result['cpu']:.3f} times the CPU time; pairs [s]: {result['seconds']}")
        return result
    if scene == "memory":
        result = memory(work, options=options)
        print(markdown(("images", "Mpx", "peak MiB", "points"),
                       [(r["images"], f"{r['megapixels']:.2f}", f"{r['memory'] / 2**20:.0f}",
                         f"{r['points']:,}") for r in result]))
        return result
    if scene in ("closeup", "reef"):
        programs = with_truth(work, scene, options)
    else:
        programs = {"fountain": fountain, "scene-v6": scene_v6}[scene](work, options)
    result = compared(programs, times)
    print_table(result)
    return result


def main():
    scenes = ("fountain", "scene-v6", "closeup", "reef", "threads", "memory")
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", choices=scenes)
    parser.add_argument("--runs", type=int, help="of each program (5; threads: 7 pairs)")
    parser.add_argument("--json", type=pathlib.Path, help="all medians")
    arguments, options = parser.parse_known_args()
    times = arguments.runs or (7 if arguments.scene == "threads" else 5)
    try:
        result = run_scene(arguments.scene, times, options)
    except (runs.Skipped, RuntimeError) as error:
        sys.exit(str(error))
    if arguments.json:
        arguments.json.write_text(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
