# SPDX-License-Identifier: GPL-3.0-or-later
"""RefinePoses on COLMAP's poses of raw underwater photographs: how close the refined poses are to
the truth, and how they affect the dense cloud."""

import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import runs  # noqa: E402
from points import densified  # noqa: E402
from support.colmap_text import baseline, images_of, records  # noqa: E402
from support.runs import PROGRAMS, measured  # noqa: E402
from axial_pipeline.colmap_model import colmap_model  # noqa: E402
from axial_pipeline.truth import self_calibrated_lens  # noqa: E402

# None: the scene is in git. Otherwise: SimulateUnderwater's options for it. The dome is decentred
# by 5 mm, along all three axes.
SCENES = {
    "reef": None,
    "closeup": None,  # 0.5 to 0.9 m away
    "reef-tilted": ["--tilt-degrees", 3],
    "reef-far-port": ["--port-distance", 0.1],
    "reef-dome": ["--dome-radius", 0.06, "--dome-x", 0.003, "--dome-y", 0.0023, "--dome-z", 0.0033],
}
# The required accuracy. On some scenes COLMAP's own centres are within a millimetre; therefore the
# refined centres must also be closer to the truth than COLMAP's.
RMS, TURN = 1.0, 0.02  # [mm], [degrees]
LIKE_TRUE_POSES = 1.1
# Of the observations that true poses keep. With fewer, errors could be small by omission.
KEPT = 0.95
LESS_F = 0.02
WANTED = (f"COLMAP's poses of raw photographs, refined: centres within {RMS} mm RMS and nearer than "
          f"COLMAP's, rotations within {TURN} degrees, errors at most {LIKE_TRUE_POSES} times those "
          f"under true poses on at least {KEPT:.0%} of their observations")
WANTED_CLOUD = (f"dense cloud on refined poses: mean at most {LIKE_TRUE_POSES} times that on true "
                f"poses, F at most {LESS_F} lower")


def truth_of(scene, base):
    options = SCENES[scene]
    if options is None:
        return runs.synthetic(scene, base)
    return runs.simulated(scene, base, "--preset", "reef", "--medium", "water", "--truth", 0,
                          *options, tolerance=0.005)


def raw_model(truth, base):
    """COLMAP's model of the photographs under water, with a lens that COLMAP calibrates itself. It
    is kept as long as the photographs: for good if they are in git, else in the scene's folder."""
    in_git = SCENES[truth.name] is None
    work = base / "colmap" / f"{truth.name}-water-1" if in_git else truth.data / "colmap"
    colmap_model(truth.data / "water", work, self_calibrated_lens(truth.data))
    return work / "model"


def refine(truth, model, output, *options):
    """Runs RefinePoses. Returns the RMS reprojection error [px] and the number of observations."""
    measured(output.parent / f"{output.name}.log", *PROGRAMS.refine_poses(
        model, truth.data / "sparse", truth.data / "housing.json", output, *options))
    report = json.loads((output / "report.json").read_text())
    return report["rms_after_px"], report["observations_after"]


def align(model, reference, output):
    """Runs AlignModel. Returns the scale, the RMS distance of the centres [mm] and the largest
    rotation error [degrees]."""
    log = output.parent / f"{output.name}.log"
    measured(log, *PROGRAMS.align(model, reference, output))
    text = log.read_text()
    return [float(re.search(pattern, text)[1]) for pattern in
            (r"scale ([\d.]+)", r"RMS ([\d.]+) mm", r"largest ([\d.]+) degrees")]


def at_true_poses(model, truth, output):
    """Writes the text model `model` to `output` with its tracks and the true poses."""
    poses = images_of(truth.data / "sparse")
    output.mkdir(parents=True, exist_ok=True)
    for name in ("cameras.txt", "points3D.txt"):
        (output / name).write_text((model / name).read_text())
    lines = records(model / "images.txt")
    for i in range(0, len(lines) - 1, 2):
        fields = lines[i].split()
        lines[i] = " ".join([fields[0], *poses[fields[9]], *fields[8:]])
    (output / "images.txt").write_text("\n".join(lines))


def refined(scene, base, work):
    """Refines COLMAP's poses and writes the model, aligned to the truth, to `work`/aligned. Returns
    align() of COLMAP's and of the refined poses, refine() of the refined and of the true poses."""
    truth = truth_of(scene, base)
    work.mkdir(parents=True, exist_ok=True)
    raw = raw_model(truth, base)
    colmaps = align(raw, truth.data / "sparse", work / "raw")
    ours = refine(truth, raw, work / "refined", "--refine", "none", "--scale-from",
                  baseline(truth.data / "sparse"))
    off = align(work / "refined", truth.data / "sparse", work / "aligned")
    at_true_poses(work / "raw", truth, work / "true")
    true = refine(truth, work / "true", work / "placed", "--poses", "known")
    return colmaps, off, ours, true


def poses(scene, base, work):
    colmaps, (scale, centres, turn), (rms, count), (true_rms, true_count) = refined(scene, base, work)
    seen = (f"centres {centres:.3f} mm RMS (COLMAP's {colmaps[1]:.3f}), largest turn {turn:.4f} degrees "
            f"(COLMAP's {colmaps[2]:.4f}), scale off by {abs(1 - scale):.2%}; errors {rms:.3f} px of "
            f"{count:,} observations, under true poses {true_rms:.3f} px of {true_count:,}: "
            f"{rms / true_rms:.3f}")
    return seen, (centres <= min(RMS, colmaps[1]) and turn <= TURN
                  and rms <= LIKE_TRUE_POSES * true_rms and count >= KEPT * true_count)


def cloud(scene, base, work):
    truth = truth_of(scene, base)
    if not (work / "aligned" / "images.txt").exists():
        refined(scene, base, work)
    means = {}
    for name, model in (("refined", work / "aligned"), ("true", truth.data / "sparse")):
        folder = work / f"cloud-{name}"
        densified(folder, model, truth.data / "water", truth.data / "housing.json")
        means[name] = runs.evaluate(folder, truth, "water")
    ratio = means["refined"]["mean"] / means["true"]["mean"]
    seen = "; ".join(f"{name} mean {1e3 * m['mean']:.3f} mm F {m['f']:.3f}"
                     for name, m in means.items())
    less = means["true"]["f"] - means["refined"]["f"]
    return f"{seen}; ratio {ratio:.3f}", ratio <= LIKE_TRUE_POSES and less <= LESS_F
