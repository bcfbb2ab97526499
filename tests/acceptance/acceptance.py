# SPDX-License-Identifier: GPL-3.0-or-later
"""The slow acceptance points. tests/acceptance.sh runs this script and explains its use."""

import hashlib
import importlib
import json
import pathlib
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support.runs import ROOT, Skipped  # noqa: E402
from points import BASE, POINTS  # noqa: E402

# Each module registers its points. The order of the modules is that of the points in the table.
for module in ("clouds", "photographs", "times", "quality", "meshes", "unseen", "maps", "surveys",
               "whole_programs", "memory", "tiles", "survey_page", "still", "false_alarms", "dives",
               "random_dives", "lawnmower", "boards", "pair_costs", "control_draws", "control_strip", "target_surveys",
               "rig_surveys", "target_detection", "no_targets", "colors", "own_water", "color_controls",
               "measured_plots", "packages"):
    importlib.import_module(module)


def source_state():
    """The commit, for the reader of the table, and a hash of all files except documentation.
    Results are kept under the hash."""
    git = lambda *arguments: subprocess.run(["git", *arguments], cwd=ROOT, check=True,
                                            capture_output=True, text=True).stdout
    names = git("ls-files", "--cached", "--others", "--exclude-standard", "--deduplicate")
    state = hashlib.sha1()
    for name in sorted(names.splitlines()):
        if name.endswith(".md") or name.startswith("docs/") or not (ROOT / name).is_file():
            continue
        state.update(name.encode() + b"\0" + (ROOT / name).read_bytes())
    return git("rev-parse", "--short=12", "HEAD").strip(), state.hexdigest()[:12]


def run_point(name, state):
    function, wanted = POINTS[name]
    file = BASE / state / "results" / f"{name}.json"
    if file.exists():
        return json.loads(file.read_text())
    print(f"=== {name}: {wanted}", flush=True)
    begin = time.monotonic()
    try:
        seen, good = function(BASE / state)
        verdict = {None: "reported", True: "pass", False: "FAIL"}[good]
    except Skipped as reason:
        seen, verdict = str(reason), "skipped"
    except (RuntimeError, OSError, KeyError, TypeError, subprocess.SubprocessError) as error:
        seen, verdict = str(error), "FAIL"
    result = {"point": name, "wanted": wanted, "seen": seen, "verdict": verdict,
              "minutes": round((time.monotonic() - begin) / 60, 1)}
    print(f"    {verdict}: {seen}", flush=True)
    if verdict in ("pass", "reported"):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(result, indent=1))
    return result


def main():
    names = [a for a in sys.argv[1:] if a != "--list"] or list(POINTS)
    unknown = [name for name in names if name not in POINTS]
    if unknown:
        sys.exit(f"no such point: {' '.join(unknown)}; there are: {' '.join(POINTS)}")
    if "--list" in sys.argv:
        for name, (_, wanted) in POINTS.items():
            print(f"{name:28} {wanted}")
        return
    commit, state = source_state()
    rows = ["| point | wanted | seen | verdict | minutes |", "|---|---|---|---|---|"]
    failed = False
    for name in names:
        result = run_point(name, state)
        failed |= result["verdict"] == "FAIL"
        rows.append("| {point} | {wanted} | {seen} | {verdict} | {minutes} |".format(**result))
    table = f"Commit: {commit}, source: {state}\n\n" + "\n".join(rows) + "\n"
    BASE.mkdir(parents=True, exist_ok=True)
    (BASE / "table.md").write_text(table)
    print("\n" + table)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
