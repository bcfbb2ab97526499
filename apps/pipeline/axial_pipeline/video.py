# SPDX-License-Identifier: GPL-3.0-or-later
"""The option --video: photographs from videos. ExtractFrames chooses sharp frames with enough motion between
them and writes them below the output folder, each clip into a subfolder of its own. The run goes on with
this folder as if it were that of --images."""

import pathlib

from . import files
from .failure import Failure
from .programs import Programs, require, words_of
from .run_file import warnings_of
from .steps import Records, Report, Step, is_done

NAME = "frames"           # of the step
FOLDER = "frames"         # of the photographs, below the output folder
LIST = "frames.json"      # numbers, times, sharpness and motion of the frames


def check(given):
    """Checks the options, and makes the paths of the clips absolute. `given.images` becomes the folder that
    the frames will be in. `given.output` is absolute."""
    if given.frames and not given.videos:
        raise Failure(f"--frames {given.frames}: is only for --video")
    if not given.videos and not given.images:
        raise Failure("--images is missing: the folder of the photographs; or give --video")
    if not given.videos:
        return
    require(given.programs, ["ExtractFrames"])
    folder = pathlib.Path(given.output) / FOLDER
    for number, clip in enumerate(given.videos):
        path = pathlib.Path(files.existing("--video", clip))
        if not path.is_file():
            raise Failure(f"--video {clip}: is not a file")
        if path.is_relative_to(folder):
            raise Failure(f"--video {clip}: lies in the folder that this run writes; move it")
        given.videos[number] = str(path)
    given.images = str(folder)


def step(given, out):
    clips = [pathlib.Path(clip) for clip in given.videos]
    return Step(NAME, Programs(given.programs).extract_frames(clips, out / FOLDER, out / LIST,
                                                              *words_of("frames", given)),
                makes=Report(out / LIST), reads=clips, anew=[out / FOLDER, out / LIST])


def are_there(given, out):
    """Whether a run has made the frames of these clips before."""
    one = step(given, out)
    return is_done(one, [one.command, one.fingerprint()], Records(out))


def rows(given):
    """What --check can say before the frames are there: pairs of a word and a text."""
    for clip in given.videos:
        yield "video", f"{clip}: a run first chooses its frames, and then checks them as photographs"


def lines_about(out):
    """Lines for the console and the report: how many frames were chosen, and the warnings of ExtractFrames."""
    for clip in files.read_object(out / LIST).get("clips", []):
        yield f"{clip['clip']}: {len(clip['frames'])} of {clip['frame_count']} frames are used as photographs"
    for warning in warnings_of([out / "logs" / f"{NAME}.log"]):
        yield f"warning: {warning['text']}"
