# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that several tests need, rendered once and copied. SimulateUnderwater makes the same bytes from
the same arguments; rendering takes seconds, and a copy a hundredth of one."""

import fcntl
import hashlib
import os
import pickle
import shutil
import tempfile

# A folder in the build tree, which CTest gives. Without it each call renders.
SCENES = os.environ.get("AXIAL_SCENES", "")


def content_hash(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()[:16]


def folder_of_program(program):
    """The folder of what this very program rendered; what other programs rendered goes."""
    current = content_hash(program)
    os.makedirs(os.path.join(SCENES, current), exist_ok=True)
    for other in os.listdir(SCENES):
        if other != current:
            shutil.rmtree(os.path.join(SCENES, other), ignore_errors=True)
    return os.path.join(SCENES, current)


def can_be_shared(command):
    """Whether the command makes a new folder from nothing but its arguments."""
    return (bool(SCENES) and os.path.basename(command[0]) == "SimulateUnderwater" and command[-2:-1] == ["-o"]
            and os.path.isabs(command[-1]) and not os.path.exists(command[-1]))


def rendered(command, render):
    """Fills the folder that the command's last argument names. Returns what `render` returns for a
    command that ends with a folder: what the program said. A render that fails is not kept."""
    *arguments, output = command
    folder = folder_of_program(command[0])
    kept = os.path.join(folder, hashlib.sha256("\0".join(arguments[1:]).encode()).hexdigest()[:16])
    with open(kept + ".lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not os.path.exists(kept):
            new = tempfile.mkdtemp(dir=folder)
            said = render([*arguments, os.path.join(new, "scene")])
            if said.returncode != 0:
                shutil.rmtree(new)
                return render(command)
            with open(os.path.join(new, "said"), "wb") as file:
                pickle.dump(said, file)
            os.rename(new, kept)
    shutil.copytree(os.path.join(kept, "scene"), output)
    with open(os.path.join(kept, "said"), "rb") as file:
        return pickle.load(file)
