# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on the page of ViewScene: a page of 10 million points, and the way from raw photographs to
the page."""

import re
import shutil
import subprocess
import sys
import time

from points import densified, millimetres, point, truth_of
from refined import LIKE_TRUE_POSES
from support import colmap_text, runs
from support.runs import BIN, ROOT, Skipped, measured
from tiles import fused, survey_with_maps

sys.path.insert(0, str(ROOT / "tests" / "apps"))
from browser import CHROMIUM, Browser  # noqa: E402

POINTS_SHOWN = 10_000_000
FIRST, ALL, RATE, SIZE = 5, 20, 20, 300  # [s], [s], [1/s], [MB]
WIDTH, HEIGHT = 1280, 800  # of the window [CSS px]

# Turns the view for 6 s, by 3 px of a mouse movement for each picture. Returns the number of pictures
# for each of the last 5 seconds, the number of points in the last picture, and its height.
ORBIT = """new Promise(resolve => {
  const { view } = axial, start = performance.now(), after = view.drawn;
  let pictures = 0, begin = 0;
  view.drawn = () => { ++pictures; after(); };
  const next = () => {
    const now = performance.now();
    if (!begin && now - start > 1000) [pictures, begin] = [0, now];
    view.controls.turn(3, 0);
    if (!begin || now - begin < 5000) return requestAnimationFrame(next);
    view.drawAndWait(); // pictures that were begun are finished
    view.drawn = after;
    resolve([1000 * pictures / (performance.now() - begin), Math.min(view.moving, view.cloud.points),
             view.renderer.getContext().drawingBufferHeight]);
  };
  requestAnimationFrame(next);
})"""


def opened(page, **window):
    if not CHROMIUM:
        raise Skipped("Chromium is not installed")
    return Browser((page / "index.html").resolve().as_uri(), WIDTH, HEIGHT, **window)


def loading_times(browser, begin):
    """The seconds from `begin` to the first picture with points, and to the picture with all."""
    browser.wait_for("globalThis.axial && axial.view.cloud.points > 0 && axial.view.asked === null")
    first = time.monotonic() - begin
    browser.wait_for("axial.ready && axial.view.complete", 120)
    return first, time.monotonic() - begin


def large_page(work):
    _, folder = survey_with_maps(work)
    cloud, page = folder / "whole.ply", folder / "page"
    if not cloud.exists():
        fused(folder, "whole")
        (folder / "scene_dense.ply").rename(cloud)
    cost = measured(folder / "page.log", BIN / "ViewScene", "-i", folder / "scene.mvs", "-p", cloud,
                    "--report", page, "--max-points", POINTS_SHOWN)
    return page, cost


@point(f"page of {POINTS_SHOWN / 1e6:g} million points in Chromium without a graphics card: first "
       f"picture in {FIRST} s, all points in {ALL} s, at least {RATE} pictures a second at half "
       f"resolution while the view turns, folder at most {SIZE} MB")
def page_large(work):
    page, cost = large_page(work)
    megabytes = sum(file.stat().st_size for file in page.rglob("*") if file.is_file()) / 1e6
    begin = time.monotonic()
    browser = opened(page, scale=0.5)
    try:
        first, complete = loading_times(browser, begin)
        points = browser.value("axial.view.cloud.points")
        rate, moving, height = browser.value(ORBIT)
        errors = browser.errors
    finally:
        browser.close()
    return (f"{points:,} points; first picture {first:.1f} s, all {complete:.1f} s, {rate:.1f} pictures "
            f"a second of {moving:,.0f} points, {height} pixels high; folder {megabytes:.0f} MB; "
            f"ViewScene {cost['cpu']:.0f} CPU-s, {cost['memory'] / 1e6:.0f} MB; {len(errors)} messages "
            "on the console",
            0.95 * POINTS_SHOWN < points and first <= FIRST and complete <= ALL and rate >= RATE
            and megabytes <= SIZE and not errors)


def pipeline(truth, out):
    """The command line of apps/pipeline/reconstruct for the photographs under water. Of the poses,
    it gets only the true camera centres."""
    positions = out.with_name(f"{out.name}-positions.txt")
    positions.parent.mkdir(parents=True, exist_ok=True)
    positions.write_text(colmap_text.positions(truth.data / "sparse"))
    return [sys.executable, ROOT / "apps/pipeline/reconstruct", "--images", truth.data / "water",
            "--lens", truth.data / "sparse" / "cameras.txt", "--housing", truth.housing("water"),
            "--scale-from", f"positions:{positions}", "--truth", truth.mesh, "--programs", BIN,
            "-o", out]


def begun_after(text, step):
    """The step's headline and all that `reconstruct` printed after it; None if it has not begun."""
    found = re.search(rf"\] {step}\n.*", text, re.DOTALL)
    return found and found[0]


def killed_at(step, command, log):
    """Starts `command` and kills it, without its children, 2 s after the step began, or when the next
    step begins. Returns the number of steps that this run did not repeat. RuntimeError if the step
    never began."""
    with open(log, "w") as output:
        process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL)
    kill_at = None
    while process.poll() is None:
        said = begun_after(log.read_text(), step)
        kill_at = kill_at or (time.monotonic() + 2 if said else None)
        if kill_at and (time.monotonic() > kill_at or said.count("\n[") > 0):
            break
        time.sleep(0.02)
    process.kill()
    process.wait()
    text = log.read_text()
    if not begun_after(text, step):
        raise RuntimeError(f"reconstruct ended before its step {step}, see {log}")
    return text.count("done before")


STEPS = ("features", "matches", "poses", "refine", "import", "densify", "mesh", "refine-mesh",
         "texture", "map", "page", "evaluate")


@point("raw reef photographs to the page in one command, killed at every step and run again: each run "
       "repeats at most the step that was killed, the last one ends with exit 0, the cloud's mean is at most "
       f"{LIKE_TRUE_POSES} times that on true poses, and the page loads in Chromium without a message on the "
       "console")
def page_from_reef_photographs(work):
    out = work / "page-from-photographs"
    shutil.rmtree(out, ignore_errors=True)
    truth = truth_of("reef")
    command = pipeline(truth, out)
    begin = time.monotonic()
    kept = [killed_at(step, command, work / f"killed-at-{step}.log") for step in STEPS]
    last = work / "not-killed.log"
    measured(last, *command)
    kept.append(last.read_text().count("done before"))
    seconds = time.monotonic() - begin
    on_truth = work / "reef-defaults-water"
    densified(on_truth, truth.data / "sparse", truth.data / "water", truth.housing("water"))
    ours, true = (runs.evaluate(folder, truth, "water") for folder in (out, on_truth))
    browser = opened(out / "page")
    try:
        browser.wait_for("globalThis.axial && axial.ready")
        share, errors = browser.value("axial.view.drawnShare()"), browser.errors
    finally:
        browser.close()
    return (f"{len(STEPS)} runs killed, {seconds / 60:.1f} minutes in all; steps kept: "
            f"{', '.join(map(str, kept))} of {len(STEPS)}; {millimetres(ours)}, on true poses "
            f"{millimetres(true)}; the page shows something in "
            f"{100 * share:.0f} % of its pixels; {len(errors)} messages on the console",
            all(count >= number - 1 for number, count in enumerate(kept)) and share > 0.1
            and ours["mean"] <= LIKE_TRUE_POSES * true["mean"] and not errors)
