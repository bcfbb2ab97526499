# SPDX-License-Identifier: GPL-3.0-or-later
"""The error that every part of the package raises for the user."""

import os
import sys


class Failure(RuntimeError):
    """One line for the user, which names the option or file, and its value."""


def open_standard_streams():
    """Opens the standard streams that are closed. Otherwise a file would get the number of a closed
    stream, and printed text would go into the file."""
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)


def run_main(name, main, stopped):
    """Runs `main`. If `main` fails, ends the process with exit code 1 and one line, which begins with
    `name`. `stopped`: the text of this line if the user interrupts `main`."""
    open_standard_streams()
    if sys.stdout:
        sys.stdout.reconfigure(errors="backslashreplace")  # names of files may have any bytes
    try:
        main()
    except Failure as failure:
        sys.exit(f"{name}: {failure}")
    except OSError as error:  # for example a full disk
        file = f"{error.filename}: " if error.filename else ""
        sys.exit(f"{name}: {file}{error.strerror or error}")
    except KeyboardInterrupt:
        sys.exit(f"{name}: {stopped}")
