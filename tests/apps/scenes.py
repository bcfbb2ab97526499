# SPDX-License-Identifier: GPL-3.0-or-later
"""Folders that several tests need are made once and then copied: scenes of SimulateUnderwater, and scenes
that further programs processed. The programs write the same bytes for the same arguments. Making a scene
takes seconds, a copy a hundredth of a second."""

import fcntl
import glob
import hashlib
import os
import pickle
import shutil
import tempfile

# A folder in the build tree, set by CTest. Without it every call makes its scene.
SCENES = os.environ.get("AXIAL_SCENES", "")


def hashed(data):
    return hashlib.sha256(data).hexdigest()[:16]


def content_hash(path):
    with open(path, "rb") as file:
        return hashed(file.read())


def kept(words, programs, make):
    """The folder that `make(folder)` filled for these words and programs. A folder that these programs
    did not make is deleted. If `make` raises an exception, nothing is kept."""
    name = os.path.join(SCENES, hashed("\0".join(map(str, words)).encode()))
    folder = f"{name}-{hashed(''.join(map(content_hash, programs)).encode())}"
    os.makedirs(SCENES, exist_ok=True)
    with open(name + ".lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not os.path.exists(folder):
            for other in glob.glob(name + "-*"):
                shutil.rmtree(other)
            new = tempfile.mkdtemp(dir=SCENES)
            try:
                make(new)
                os.rename(new, folder)
            finally:
                shutil.rmtree(new, ignore_errors=True)
    return folder


def made(words, programs, target, make):
    """Fills the folder `target` with what `make(folder)` writes. `words` tell apart what is made, and
    `programs` are the paths of the programs that `make` runs."""
    if SCENES:
        shutil.copytree(kept(words, programs, make), target, dirs_exist_ok=True)
    else:
        make(target)


def can_be_shared(command):
    """Whether the command simulates into a new folder that its last argument names. Then the result
    depends on the other arguments only."""
    return (bool(SCENES) and os.path.basename(command[0]) == "SimulateUnderwater" and command[-2:-1] == ["-o"]
            and os.path.isabs(command[-1]) and not os.path.exists(command[-1]))


class Failed(Exception):
    pass


def rendered(command, render):
    """Writes the scene to the folder that is the last word of the command, and returns the finished
    process with its output. If the scene is not kept yet, `render` runs the command with another
    folder. A rendering that fails is not kept."""
    *arguments, output = command

    def make(folder):
        said = render([*arguments, os.path.join(folder, "scene")])
        if said.returncode != 0:
            raise Failed
        with open(os.path.join(folder, "said"), "wb") as file:
            pickle.dump(said, file)

    try:
        folder = kept(arguments[1:], command[:1], make)
    except Failed:
        return render(command)
    shutil.copytree(os.path.join(folder, "scene"), output)
    with open(os.path.join(folder, "said"), "rb") as file:
        return pickle.load(file)
