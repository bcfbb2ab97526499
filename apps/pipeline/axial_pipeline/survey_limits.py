# SPDX-License-Identifier: GPL-3.0-or-later
"""What a reader must know besides the numbers, as parts of report.html: warnings, what was not done, versions and
commands."""

import shlex

from .report_html import bullets, code, paragraph, table, word_without_folders, without_folders
from .run_file import command_of
from .step_kinds import KINDS, OF_RESTORING

# Options without which a run lacks something, and what it lacks then.
NOT_ASKED = (("scale_from", "known lengths or positions (--scale-from)"),
             ("targets", "coded targets (--targets)"), ("bars", "scale bars (--bars)"),
             ("control", "control points (--control)"), ("checks", "check points (--checks)"),
             ("masks", "masks (--masks)"), ("boundary", "a boundary of the maps (--boundary)"),
             ("epsg", "a coordinate reference system (--epsg)"),
             ("restore_colors", "colours without water (--restore-colors)"),
             ("earlier", "a comparison with an earlier survey (--earlier)"),
             ("truth", "a comparison with a true mesh (--truth)"), ("las", "the cloud as LAS (--las)"))
def warnings(given, entries):
    lines = [f"{entry['name']}: {one['text']}" + (f" ({one['times']} times)" if one["times"] > 1 else "")
             for entry in entries for one in entry["warnings"]]
    lines = map(without_folders, lines)
    joint = paragraph("Warnings about the poses are in the report of all dates.") if given.date else ""
    return joint + (bullets(lines) or paragraph("No step warned."))


def skipped_steps(given, made):
    """The steps that this run did not make although a run of its kind may have them."""
    left_out = given.without.split(",") if given.without else []
    for name, kind in KINDS.items():
        if name in left_out:
            yield f"The step {name} was left out by --without."
        elif kind.result and name not in made and name not in (*OF_RESTORING, "compare", "las"):
            yield f"The step {name} was not made: the run ended with --until {given.until}."


def not_done(given, entries):
    made = [entry["name"] for entry in entries]
    lines = list(skipped_steps(given, made)) if not given.dates or given.date else []
    lines += ["Lens and port were not estimated (--refine none)."] if given.refine == "none" else []
    asked = {**vars(given), "boundary": given.boundary or given.boundary_targets}
    lacking = [words for name, words in NOT_ASKED if not asked.get(name)]
    lines += [f"Not asked for: {', '.join(lacking)}."] if lacking else []
    return bullets(lines) or paragraph("Nothing was left out.")


def versions(given, entries):
    """The line of each program, and the commands, by which a reader can repeat the run."""
    seen = {}
    for entry in entries:
        seen.setdefault(entry["version"] or "version not stated", []).append(entry["name"])
    rows = ((", ".join(names), version) for version, names in seen.items())
    commands = "".join(code(shlex.join(map(word_without_folders, entry["command"]))) for entry in entries)
    return (table(rows, ("steps", "version of the program")) +
            paragraph("The command, with paths shortened to their last names:") +
            code(shlex.join(map(word_without_folders, command_of(given)))) +
            paragraph("The commands of the steps:") + commands)
