# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs commands. A command and all of its children end when this process ends, even if this process
is killed: otherwise they would go on writing while the next run begins."""

import contextlib
import ctypes
import os
import pathlib
import shlex
import signal
import subprocess
import sys
import threading

from .failure import Failure

LIBC = ctypes.CDLL(None)
PR_SET_PDEATHSIG = 1  # of <sys/prctl.h>
MOST_SECONDS = 120  # of a short command
LINES_SHOWN = 20  # of the log of a command that failed


def die_with(parent, by=signal.SIGKILL):
    """To be called in a child process: the kernel sends the signal `by` to the child when its parent
    ends."""
    LIBC.prctl(PR_SET_PDEATHSIG, ctypes.c_ulong(by))
    if os.getppid() != parent:  # the parent ended before prctl(), which then has no effect
        os._exit(1)


def kill_group_at_end_of(pipe):
    os.read(pipe, 1)
    os.killpg(0, signal.SIGKILL)


def keep(command, log, pipe):
    """Runs `command` in a new process group, in a process that exists only for this command. Never
    returns. The whole group, including children of a wrapper script, is killed when the other end
    of `pipe` closes. That end closes when the calling process ends, for whatever reason."""
    try:
        os.setsid()
        for descriptor in map(int, os.listdir("/proc/self/fd")):
            if descriptor > 2 and descriptor != pipe:
                with contextlib.suppress(OSError):
                    os.close(descriptor)
        threading.Thread(target=kill_group_at_end_of, args=[pipe], daemon=True).start()
        keeper = os.getpid()
        with open(log, "w") as file:
            try:
                code = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT,
                                      stdin=subprocess.DEVNULL,
                                      preexec_fn=lambda: die_with(keeper)).returncode
            except OSError as error:
                file.write(f"{command[0]}: cannot be started: {error.strerror}\n")
                code = 127
        os._exit(code if code >= 0 else 128 - code)
    finally:
        os._exit(126)


def exit_code_of(command, log):
    """Runs `command` and writes its output to the file `log`. The exit code is 128 + N if the
    signal N ended the command."""
    command = [str(word) for word in command]
    pipe, held = os.pipe()
    keeper = os.fork()
    if keeper == 0:
        keep(command, log, pipe)
    try:
        return os.waitstatus_to_exitcode(os.waitpid(keeper, 0)[1])
    except BaseException:
        with contextlib.suppress(OSError):
            os.killpg(keeper, signal.SIGKILL)
        raise
    finally:
        os.close(pipe)
        os.close(held)


def ending(code):
    """How a command ended, in words."""
    if code < 0:  # the process that keeps the command was killed itself
        return f"signal {-code}"
    is_signal = 128 < code <= 128 + signal.SIGRTMAX
    return f"signal {code - 128}" if is_signal else f"exit code {code}"


def answer_of(command, seconds=MOST_SECONDS):
    """A short command that has ended, with its output as text. The exit code is 127, and standard error says why, if
    the command cannot be started or takes longer."""
    words = [str(word) for word in command]
    try:
        return subprocess.run(words, capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL,
                              timeout=seconds)
    except (OSError, subprocess.TimeoutExpired) as error:
        return subprocess.CompletedProcess(words, 127, "", str(error))


def tell(line):
    """Prints a line about the step that runs."""
    print(f"    {line}", flush=True)


def name_of(command):
    return pathlib.Path(str(command[0])).name


def told(command):
    """The words of a command, which are printed."""
    words = [str(word) for word in command]
    tell(shlex.join(words))
    return words


def logged(command, log, name=None, excuse=None):
    """Runs `command` and writes its output to the file `log`. If the command fails, prints the last
    lines of `log` and raises a Failure. `name`: of the command in the Failure. `excuse`: a text by
    which the command says that it found nothing. Returns False if the command ends with exit code 1
    and this text is in `log`, otherwise True."""
    code = exit_code_of(command, log)
    if code == 0:
        return True
    text = log.read_text(errors="replace")
    if code == 1 and excuse and excuse in text:
        return False
    for line in text.strip().splitlines()[-LINES_SHOWN:]:
        print(line, file=sys.stderr)
    raise Failure(f"{name or name_of(command)}: {ending(code)}, its output is in {log}")


def shown(command, output=None):
    """Runs `command` with its output on the screen or, if given, in the open file `output`."""
    sys.stdout.flush()
    code = subprocess.run([str(word) for word in command], stdout=output).returncode
    if code != 0:
        raise Failure(f"{name_of(command)}: {ending(code if code > 0 else 128 - code)}")
