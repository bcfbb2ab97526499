# SPDX-License-Identifier: GPL-3.0-or-later
"""`reconstruct --video`: the photographs are frames of videos."""

import argparse
import json
import os
import shutil

from pipeline_folder import InFolder
from programs import BIN, main
from small_clip import moving_clip
from stand_ins import StandIns

from axial_pipeline import run_file

STAND_IN = """#!/bin/sh
case "$*" in *--help) exit ;; esac
[ "$1" = --version ] && { echo "ExtractFrames 7.8"; exit; }
echo "ExtractFrames $*" >> commands
echo "11:02:03 [ExtractFrames] warning: dive.avi: moves by 3 pixels"
mkdir -p out/frames/dive
for number in 0 1 2; do cp images/$number.png out/frames/dive/frame_00000$((number + 1)).png; done
echo '{"clips": [{"clip": "dive.avi", "frame_count": 90, "frames": [{}, {}, {}]}]}' > out/frames.json
"""
COMMAND = "ExtractFrames -i {0}/dive.avi -o {0}/out/frames --json {0}/out/frames.json"


class WithVideo(StandIns):
    source = ("--video", "dive.avi")

    def setUp(self):
        super().setUp()
        self.program = self.folder / "ExtractFrames"
        self.put_program(STAND_IN)
        (self.folder / "dive.avi").write_bytes(b"a video")

    def put_program(self, text):
        self.program.unlink(missing_ok=True)
        self.write("ExtractFrames", text).chmod(0o755)

    def new_commands(self):
        """The commands since the last call."""
        lines = self.commands()
        (self.folder / "commands").unlink(missing_ok=True)
        return lines

    def refuses(self, expected, *more):
        self.assertIn(expected, self.refused(*more))

    def stops_in_the_step(self, expected, *more):
        result = self.ended(*more)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn(expected, result.stderr)
        self.assertRegex(result.stderr.splitlines()[-1], "^reconstruct: frames: ")
        self.assertFalse((self.folder / "out" / "features.db").exists())


class Runs(WithVideo):
    def test_frames_are_the_photographs_of_the_run(self):
        said = self.succeeds("--until", "poses", "--frames=--motion 0.2")
        lines = self.new_commands()
        self.assertEqual(lines[0], f"{COMMAND} --motion 0.2".format(self.folder))
        self.assertIn(f"--image_path {self.folder}/out/frames", lines[1])
        for place in (said, (self.folder / "out" / "report.md").read_text()):
            self.assertIn("dive.avi: 3 of 90 frames are used as photographs", place)
            self.assertIn("warning: dive.avi: moves by 3 pixels", place)

    def test_a_second_run_does_not_choose_again(self):
        self.succeeds("--until", "poses")
        self.new_commands()
        said = self.succeeds("--until", "poses")
        self.assertIn("frames: done before", said)
        self.assertIn("3 of 90 frames", said)
        self.assertEqual(self.new_commands(), [])

    def test_another_clip_or_option_is_a_new_beginning(self):
        self.succeeds("--until", "poses")
        old = self.folder / "out" / "frames" / "dive" / "frame_000009.png"
        for change in (lambda: (self.folder / "dive.avi").write_bytes(b"another"), lambda: None):
            shutil.copy(self.folder / "images" / "0.png", old)
            self.new_commands()
            change()
            self.succeeds("--until", "poses", "--frames=--png")
            self.assertEqual([line.split()[0] for line in self.new_commands()][:2], ["ExtractFrames", "colmap"])
            self.assertFalse(old.exists())
            self.succeeds("--until", "poses", "--frames=")
            self.assertEqual(self.new_commands()[0], COMMAND.format(self.folder))

    def test_a_killed_run_continues(self):
        self.put_program(STAND_IN.replace("\necho '{", "\n[ -e go ] || kill -9 $$\necho '{"))
        self.stops_in_the_step("frames: signal 9", "--until", "poses")
        (self.folder / "go").touch()
        self.succeeds("--until", "poses")

    def test_the_record_names_the_frames(self):
        self.succeeds("--until", "poses")
        begun = json.loads((self.folder / "out" / "steps" / "frames.begun.json").read_text())
        self.assertEqual(begun["makes"], ["frames", "frames.json"])


class RunFile(InFolder):
    def test_the_page_names_the_clips_and_no_folder_of_images(self):
        given = argparse.Namespace(videos=["a.avi", "b.avi"], images="out/frames", lenses=["lens"], frames="--png")
        run_file.write_run(self.folder / "run.json", given, [], self.folder)
        command = json.loads((self.folder / "run.json").read_text())["command"]
        self.assertEqual(sorted(command), sorted(["reconstruct", "--video=a.avi", "--video=b.avi", "--lens=lens",
                                                  "--frames=--png"]))


class Refused(WithVideo):
    def test_files_of_others_are_kept(self):
        own = self.folder / "out" / "frames" / "mine.png"
        own.parent.mkdir(parents=True)
        own.touch()
        self.refuses("frames: no record of an earlier run names this file")
        self.assertTrue(own.exists())
        self.assertEqual(self.new_commands(), [])

    def test_wrong_clips_and_options(self):
        self.refuses("--video no.avi: not found", "--video", "no.avi")
        self.refuses("--video images: is not a file", "--video", "images")
        ended = self.ended("--scale-from", "images:a,b")  # after the frames were chosen
        self.assertEqual((ended.returncode, ended.stderr.count("\n")), (1, 1), ended.stderr)
        self.assertIn("--scale-from images:a,b: must give two ends", ended.stderr)
        shutil.rmtree(self.folder / "out")
        self.program.unlink()
        self.refuses("ExtractFrames not found; build the programs first")

    def test_a_clip_in_the_folder_that_the_run_clears(self):
        self.succeeds("--until", "poses")
        clip = self.folder / "out" / "frames" / "a.avi"
        clip.touch()
        self.refuses("lies in the folder that this run writes; move it", "--video", str(clip))

    def test_check_writes_nothing_and_says_what_it_does_not_know(self):
        said = self.succeeds("--check")
        self.assertIn(f"{self.folder}/dive.avi: a run first chooses its frames", said)
        self.assertIn("No fault was found.", said)
        self.assertFalse((self.folder / "out").exists())
        self.succeeds("--until", "poses")
        self.assertIn("photographs", self.succeeds("--check"))

    def test_an_error_of_the_program_is_that_of_the_run(self):
        self.put_program(STAND_IN.replace(
            "\nmkdir", "\necho 'ExtractFrames: dive.avi: is not a video' >&2; exit 1\nmkdir"))
        self.stops_in_the_step("dive.avi: is not a video")


class WithImages(StandIns):
    def test_video_and_its_options_contradict_images(self):
        self.assertIn("not allowed with argument --images", self.ended("--video", "x").stderr)
        self.assertIn("--frames --png: is only for --video", self.ended("--frames=--png").stderr)


class WithNeither(StandIns):
    source = ()

    def test_photographs_or_a_video_are_needed(self):
        result = self.ended()
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr, "reconstruct: --images is missing: the folder of the photographs; or give "
                         "--video\n")


class RealFrames(WithVideo):
    """With ExtractFrames itself."""

    def setUp(self):
        super().setUp()
        self.program.unlink()
        self.program.symlink_to(os.path.join(BIN, "ExtractFrames"))
        (self.folder / "dive.avi").write_bytes(moving_clip())

    def test_clips_give_folders_of_photographs(self):
        (self.folder / "more.avi").write_bytes(moving_clip(seed=2))
        said = self.succeeds("--until", "poses", "--video", "more.avi")
        self.assertIn("of 24 frames are used as photographs", said)
        frames = self.folder / "out" / "frames"
        for name in ("dive", "more"):
            photographs = sorted(path.name for path in (frames / name).iterdir())
            self.assertRegex(photographs[0], r"^frame_00000[0-4]\.jpg$")
            self.assertGreaterEqual(len(photographs), 5)


if __name__ == "__main__":
    main()
