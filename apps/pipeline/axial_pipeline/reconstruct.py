# SPDX-License-Identifier: GPL-3.0-or-later
"""From photographs taken under water to a dense cloud, a textured mesh, maps and a page to look at
them, in one command:

    reconstruct --images DIR --lens cameras.txt --housing housing.json -o OUT

With --video, ExtractFrames first makes photographs of videos. COLMAP computes poses with a lens that it
calibrates itself. RefinePoses turns them into refractive poses. DensifyPointCloud computes the cloud.
ReconstructMesh, RefineMesh and TextureMesh turn the cloud into a textured mesh, and MapSurface maps it. With
--earlier, CompareSurveys finds what changed since an earlier survey. ViewScene writes a page for the browser
that shows the results. The command of every step is printed and can be typed by hand. A killed run that is
started again with the same options continues with the step that was killed; with other options, it continues
with the first step that differs. A second run in the same folder is refused until the first run ends. With
--cluster, a workflow of Snakemake runs the same commands, and several nodes of a cluster compute the depth
maps (docs/cluster.md). With --dates, the poses of photographs of several dates are computed together, and the
steps after the poses run for each date.
"""

import fcntl
import pathlib

from . import cluster, control, dates, files, ownership, poses, still_features, survey_report, video
from .failure import Failure, run_main
from .reconstruct_options import check_options, check_photographs, options, skipped, wanted_steps
from .reconstruct_steps import RESTORED, best_mesh, final_cloud, las_of, steps
from .step_kinds import ORDER
from .steps import run_all


def lines_of_poses(refined):
    """The lines of the report about the result of RefinePoses, `refined`."""
    yield (f"- reprojection error: {refined['rms_before_px']:.3f} px before, "
           f"{refined['rms_after_px']:.3f} px after refining")
    yield (f"- {refined['observations_after']} observations of {refined['points_after']} points "
           f"in {sum(i['observations'] > 0 for i in refined['images'])} images")
    sigma = refined["scale_sigma"]
    if sigma is None:
        yield "- the scale is not known"
    elif sigma != 0:  # 0: the poses were known
        yield f"- the scale is known to {100 * sigma:.2g} % (one standard deviation)"
    shape = refined["shape_sigma"]
    if shape is None:
        yield "- the shape is not known"
    elif shape != 0:
        yield f"- the shape is known to {100 * shape:.2g} % of the distance of the points (one standard deviation)"
    depth = refined["depth_sigma"]
    if depth is None:
        yield "- the distances of the points from the cameras are not known"
    elif depth != 0:
        yield f"- the distances of the points from the cameras are known to {100 * depth:.2g} % (one standard deviation)"
    for camera in refined["cameras"]:
        for value in camera["free"]:
            yield f"- camera {camera['id']}, {value['name']}: {line_of_value(value)}"
    if "control" in refined:
        yield from control.lines_of(refined["control"])


def line_of_value(value):
    """An estimated value of lens or port, its stated value, and what decided."""
    sigma = "not known" if value["sigma"] is None else f"+- {value['sigma']:.2g}"
    found = f"{value['value']:.6g} {value['unit']}, {sigma}"
    if value["sigma_before"] is None:
        return f"{found} (before: {value['before']:.6g})"
    return (f"{found} (stated: {value['before']:.6g} +- {value['sigma_before']:.2g}; decided by the "
            f"{value['decided_by']})")


def lines_of_accuracy(evaluation):
    accuracy = evaluation["accuracy"]
    yield (f"- mean distance to the truth {1e3 * accuracy['mean']:.3f} mm, median "
           f"{1e3 * accuracy['median']:.3f} mm, {accuracy['count']} points")


def lines_of_colors(found):
    light = {"sun": "daylight", "lamp": "lamps"}[found["light"]]
    yield (f"- colours: {light}; the light of a point differs between photographs by {100 * found['spread_after']:.1f} "
           f"%, by {100 * found['spread_before']:.1f} % before")


def lines_from(file, lines_of):
    """The lines that `lines_of` makes of the JSON object in `file`."""
    try:
        return list(lines_of(files.read_object(file)))
    except (LookupError, TypeError, ValueError, AttributeError):
        raise Failure(f"{file}: is damaged, or of another version; remove it, and the same command makes "
                      "it again") from None


def report(out, seconds, more=()):
    """The text of report.md. `seconds`: the time of each step. `more`: further lines."""
    lines = ["# Reconstruction", "", *lines_from(out / "refined" / "report.json", lines_of_poses)]
    if "evaluate" in seconds:
        lines += lines_from(out / "evaluation.json", lines_of_accuracy)
    if "colors" in seconds:
        lines += lines_from(out / RESTORED / "colors.json", lines_of_colors)
    lines += [f"- warning: {line}" for line in still_features.lines_about(out)]
    lines += [f"- {line}" for line in [*more, *poses.lines_about(out)]]
    lines += ["", "| step | seconds |", "|---|---|"]
    lines += [f"| {name} | {time} |" for name, time in seconds.items()]
    return "\n".join(lines) + "\n"


def only_run_in(out):
    """Refuses other runs in the folder `out` until the returned file is closed. The commands of steps
    do not inherit the file, so that the refusal ends with this process. With --cluster, snakemake
    inherits the file, so that the refusal ends when both processes have ended."""
    lock = open(out / "lock", "a")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise Failure(f"--output {out}: another run uses this folder") from None
    except OSError as error:
        print(f"--output {out}: cannot be locked ({error.strerror}): make sure that no other run "
              "uses this folder", flush=True)
    return lock


def results_of(given, out):
    """The line that names the results."""
    if given.dates and not given.date:
        return f"Poses: {out / 'refined'}   Dates: {out / dates.FOLDER}   Report: {out / 'report.md'}"
    wanted = wanted_steps(given)
    textured = f"scene_textured.tile*-{given.tiles}.glb" if given.tiles > 1 else "scene_textured.glb"
    found = [("Cloud", final_cloud(given, out)) if "densify" in wanted else ("Poses", out / "refined")]
    if "las" in wanted:
        found.append(("LAS", las_of(given, out)))
    if "mesh" in wanted:
        found.append(("Mesh", out / textured if "texture" in wanted else best_mesh(given, out)))
    if "colors" in wanted:
        found.append(("Photographs without water", out / RESTORED))
    if "map" in wanted:
        found.append(("Maps", out / "scene_map.*"))
    if "compare" in wanted:
        found.append(("Changes", out / "scene.change.*"))
    if "page" in wanted:
        found.append(("Page", out / "page" / "index.html"))
    found.append(("Report", out / ("report.md" if survey_report.NAME in skipped(given) else survey_report.PAGE)))
    return "   ".join(f"{name}: {path}" for name, path in found)


def make_frames(given, out):
    """Chooses the frames of --video. The steps of the run depend on the sizes of the photographs, so that this
    step runs before the others are known."""
    step = video.step(given, out)
    ownership.check(out, [step.name])
    out.mkdir(parents=True, exist_ok=True)
    with only_run_in(out):
        run_all([step], out, ORDER)


def run_dates(given, out):
    """The runs of all dates, after the poses. Returns the lines of the report about them."""
    found = dates.split(out, given.dated)
    for one in dates.runs_of(given, out, found, best_mesh):
        print(f"--- {one.date}", flush=True)
        run_steps(one, pathlib.Path(one.output))
        print(results_of(one, pathlib.Path(one.output)), flush=True)
    return dates.lines_of(found, out)


def names_of(given, todo):
    """The names of the steps `todo`, and of the report unless it is left out."""
    return [*(step.name for step in todo), *({survey_report.NAME} - {*skipped(given)})]


def run_steps(given, out):
    """Runs the steps of one folder, and writes its reports."""
    todo = list(steps(given, out))
    ownership.check(out, names_of(given, todo), bool(given.cluster))
    out.mkdir(parents=True, exist_ok=True)
    with only_run_in(out) as lock:
        seconds = (cluster.run_all(todo, given, out, lock) if given.cluster
                   else run_all(todo, out, ORDER))
        text = report(out, seconds, given.lines if not given.date else [f"date: {given.date}"])
        if given.dates and not given.date:
            text += "\n".join(run_dates(given, out)) + "\n"
        files.write(out / "report.md", text)
        if survey_report.NAME in names_of(given, todo):
            survey_report.write(given, out, todo, [*(given.lines if not given.date else ()), *poses.lines_about(out)])
    left_over = ownership.left_over(out, names_of(given, todo))
    if left_over:
        print(f"Of an earlier run, not of this one: {files.few(left_over, ownership.MOST_NAMED)}")


def say_found(found):
    print(*(f"{word:12} {text}" for word, text in found), "No fault was found.", sep="\n")


def reconstruct(given):
    lens_lines = check_options(given)
    out = pathlib.Path(given.output)
    if given.videos and not video.are_there(given, out):
        if given.check:
            say_found([*video.rows(given), *(("lens", line) for line in lens_lines)])
            return
        make_frames(given, out)
    for line in video.lines_about(out) if given.videos else ():
        print(line, flush=True)
    found = check_photographs(given, lens_lines)
    if given.dates:
        dates.claim(out)
    if given.check:
        ownership.check(out, names_of(given, steps(given, out)), bool(given.cluster))
        say_found(found)
        return
    run_steps(given, out)
    for line in still_features.lines_about(out):
        print(f"warning: {line}")
    print(results_of(given, out))


def main(script_folder):
    """`script_folder`: the folder of the command that the user typed."""
    description = __doc__.split(":\n\n")[0] + "."
    run_main("reconstruct", lambda: reconstruct(options(script_folder, description)),
             "stopped; the same command continues from here")
