# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a run for a reader who was not there, such as the reviewer of a paper: report.html, and the same as
report.pdf. All numbers come from files that the steps wrote."""

import time

from . import files, report_html, report_pdf, survey_facts, survey_limits, survey_quality
from .failure import Failure
from .run_file import entry_of
from .steps import Files, Records, Step, digest, is_done

NAME = "report"  # in --without
PAGE, PDF = "report.html", "report.pdf"


def page_of(given, out, todo, lines):
    """The text of report.html about the steps `todo`, which are done. It has no times, so that the same run gives the
    same bytes. `lines`: what the first checks and the poses say."""
    entries = [entry_of(step, todo, out) for step in todo]
    made = [entry["name"] for entry in entries]
    scene = survey_facts.shown(out) if "page" in made else {}  # a page without this step is of an earlier run
    name = f"Survey {out.name}" if not given.date else f"Survey {out.parent.parent.name}, {given.date}"
    return report_html.page(name, [
        ("Survey", survey_facts.overview(given, out, scene)),
        ("Photographs", survey_facts.photographs(out, lines)),
        ("Cameras, lenses and housing", survey_facts.cameras(out)),
        ("Map", survey_facts.maps(given, out, made, scene)),
        ("Scale and control", survey_quality.scale(given, out)),
        ("Expected errors", survey_quality.errors(out, made, scene)),
        ("Changes since the earlier survey", survey_quality.changes(out, made)),
        ("Warnings of the run", survey_limits.warnings(given, entries)),
        ("What was not done", survey_limits.not_done(given, entries)),
        ("Versions and commands", survey_limits.versions(given, entries))])


def write(given, out, todo, lines):
    """Writes report.html, and prints it as report.pdf if the page is new. Says why there is no report.pdf."""
    page, pdf = out / PAGE, out / PDF
    try:
        text = page_of(given, out, todo, lines)
    except (LookupError, TypeError, ValueError, AttributeError):
        raise Failure(f"{PAGE} was not made: a file of a step in {out} is damaged, or of another version") from None
    step, chain = Step(NAME, [], Files(page, pdf)), [text]
    records = Records(out)
    if is_done(step, chain, records) and page.read_bytes() == text.encode():
        return
    records.write(step, "begun", {"chain": digest(chain), "makes": step.writes})
    records.forget([NAME])
    files.clear(pdf)
    files.write(page, text)
    why = report_pdf.print_page(page, pdf, out / "logs" / f"{NAME}.log")
    if why:
        print(f"{PDF} was not made, {PAGE} was: {why}", flush=True)
    else:
        records.write(step, "done", {"chain": digest(chain), "makes": step.writes, "seconds": 0,
                                     "ended": time.time()})
