// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the rigs of a bundle from a file of rigs: which photographs belong to which camera, and
// which were taken at the same time.
#pragma once

#include <string>
#include <vector>

#include "io/cameras/photograph_numbers.h"
#include "io/colmap/colmap.h"
#include "io/colmap/rigs.h"
#include "pose/bundle/rig.h"

namespace axial::pose {

struct RigOptions {
  // stated: poses of the file have their standard deviations, and cameras without a pose are free.
  // fixed: poses of the file are exact. free: poses of the file are not used.
  RigCamera::Known poses = RigCamera::Known::stated;
  // A regular expression (ECMAScript). Photographs in whose names its first group matches the same
  // text belong to one frame. Empty: see make_rigs().
  std::string frames = {};
  io::PhotographNumbers times = {};  // empty: not known
  double interval = 0;               // between two frames [s]; 0: not known
};

// Makes the rigs of a bundle. The images of the bundle are those of `images`, in their order. A
// photograph belongs to the camera with the longest image_prefix with which its name begins, or
// with the files rigs and frames to the camera and the frame that they state. With image_prefix,
// the first rule that applies puts photographs into frames:
// - RigOptions::frames.
// - With RigOptions::times, each photograph belongs to the photograph of the reference camera that
//   is nearest in time, within half of the median interval between those photographs.
// - Photographs whose names are the same behind the prefix belong together.
//
// Frames are in the order of their times. Without RigOptions::times, the order is that of the names
// of their first photographs, with numbers in names by their values. RigFrame::time then follows
// from RigOptions::interval and from the last numbers in these names, if all names have one and
// they rise, so that frames without poses leave gaps; otherwise from the count of frames. Frames of
// a single photograph stay, because they tell the velocity of the rig.
//
// Error for a regular expression that is not valid or has no group, two photographs of one camera
// in one frame, a photograph of a rig without a time in RigOptions::times, an image of a frame that
// is not in `images`, a fixed camera whose file states no pose, and if no frame has two
// photographs. Messages begin with `file`, the name of the file of rigs.
std::vector<Rig> make_rigs(const io::RigFile& rigs, const std::vector<io::ColmapImage>& images,
                           const RigOptions& options, const std::string& file);

}  // namespace axial::pose
