# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that several tests need are rendered once and then copied. SimulateUnderwater writes the
same bytes for the same arguments. Rendering takes seconds, a copy a hundredth of a second."""

import fcntl
import hashlib
import os
import pickle
import shutil
import tempfile

# A folder in the build tree, set by CTest. Without it every call renders.
SCENES = os.environ.get("AXIAL_SCENES", "")


def content_hash(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()[:16]


def folder_of_program(program):
    """The folder of scenes that this binary rendered. Scenes of other binaries are deleted."""
    current = content_hash(program)
    os.makedirs(os.path.join(SCENES, current), exist_ok=True)
    for other in os.listdir(SCENES):
        if other != current:
            shutil.rmtree(os.path.join(SCENES, other), ignore_errors=True)
    return os.path.join(SCENES, current)


def can_be_shared(command):
    """Whether the command simulates into a new folder that its last argument names. Then the result
    depends on the other arguments only."""
    return (bool(SCENES) and os.path.basename(command[0]) == "SimulateUnderwater" and command[-2:-1] == ["-o"]
            and os.path.isabs(command[-1]) and not os.path.exists(command[-1]))


def rendered(command, render):
    """Writes the scene to the folder that is the last word of the command, and returns the finished
    process with its output. If the scene is not kept yet, `render` runs the command with another
    folder. A rendering that fails is not kept."""
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
