# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints a page of HTML as PDF with Chromium."""

import os
import shutil
import tempfile

from . import files
from .running import ending, exit_code_of

PROGRAM, PACKAGE = "chromium", "chromium"  # the command, and the package of Debian that has it
MOST_SECONDS = 120


def browser():
    """The path of the browser; None if there is none."""
    return shutil.which(PROGRAM)


def command(page, pdf, profile):
    """The words of the command that prints `page`. Chromium cannot use its sandbox as root or in many containers; the
    page is our own and has no script. The command may not go to the network."""
    return ["timeout", "--foreground", "--kill-after=5", str(MOST_SECONDS), browser(), "--headless=new", "--no-sandbox",
            "--disable-gpu", "--disable-dev-shm-usage", "--disable-breakpad", "--disable-extensions",
            "--disable-background-networking", "--disable-component-update", "--no-first-run",
            "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={profile}", "--no-pdf-header-footer",
            f"--print-to-pdf={pdf}", page.as_uri()]


def is_whole(pdf):
    """Whether a file is a PDF with its end."""
    if not pdf.is_file():
        return False
    content = pdf.read_bytes()
    return content.startswith(b"%PDF-") and b"%%EOF" in content[-32:]


def print_page(page, pdf, log):
    """Writes the file `page` as `pdf`. Returns why there is none, or an empty text. A browser that fails or takes too
    long does not end the run."""
    if not browser():
        return f"{PROGRAM} is not installed (Debian's package {PACKAGE})"
    temporary = pdf.with_name(pdf.name + ".tmp")
    log.parent.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="axial_report_", ignore_cleanup_errors=True) as profile:
        code = exit_code_of(command(page, temporary, profile), log)
    if code == 0 and is_whole(temporary):
        os.replace(temporary, pdf)
        return ""
    files.clear(temporary)
    how = f"took more than {MOST_SECONDS} s" if code in (124, 137) else ending(code) if code else "wrote no PDF"
    return f"{PROGRAM}: {how}, its output is in {log}"
