// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the frames of a video that serve as photographs: sharp ones, with enough motion between
// them.
#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace axial::video {

// A similarity between two frames. The point z of the first frame is at turn * z + shift in the
// second frame. Points are complex numbers (right, down), measured from the centre of the picture
// in widths of the picture.
struct Motion {
  std::complex<double> turn = 1, shift = 0;
};

// The motion `first` followed by the motion `second`.
Motion then(const Motion& first, const Motion& second);

// The root mean square of the displacements of all points of the picture, in widths of the picture.
// `aspect`: height of the picture divided by its width.
double displacement(const Motion& motion, double aspect);

// What is measured in each frame.
struct FrameMeasure {
  double sharpness = 0;  // >= 0, in any unit that is the same for neighbouring frames
  // The motion from the frame before to this frame. Absent if there is no frame before, or if the
  // frames have too little in common to tell.
  std::optional<Motion> motion;
};

// How frames are chosen.
struct ChoiceRules {
  double share = 0.1;             // of the picture's width that it moves between chosen frames, > 0
  double frames_per_second = 30;  // > 0
  double aspect = 0.75;           // height of the picture divided by its width
};

// Returns the numbers of the chosen frames, ascending. `frames`: all frames of the clip in
// sequence. From one chosen frame to the next, the picture moves (displacement()) by
// 0.75 to 1.25 times `share`. Of all frames in this range, the one is chosen that is sharpest
// beside its neighbours: sharpness divided by the median sharpness of the frames within a quarter
// of a second. If the picture leaps over the range from one frame to the next, the frame after the
// leap is chosen. Motion that goes back and forth does not add up, so that of frames without motion
// only one is chosen. A frame without motion begins a new part of the clip, in which frames are
// chosen as in a clip of its own. No frame of a part of one frame is chosen.
std::vector<std::size_t> choose_frames(std::span<const FrameMeasure> frames,
                                       const ChoiceRules& rules);

}  // namespace axial::video
