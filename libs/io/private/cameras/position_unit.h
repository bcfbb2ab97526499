// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: which reading of positions is right, if their file does not state the unit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/cameras/position_file.h"
#include "private/only_for_io.h"

namespace axial::io {

// The right reading.
struct ChosenUnit {
  std::optional<std::size_t> as_degrees;  // index into PositionFile::as_degrees; nothing: metres
  std::string note;                       // how the unit was found
};

// Chooses between the positions of `read` as metres and PositionFile::as_degrees, which are not
// empty. A reading is better, the smaller the residual of the similarity is (robust_similarity())
// that maps the camera centres to the positions, as a part of the extent of the positions. The best
// reading is right if its residual is at most half of every other one, or a tenth with fewer than
// six images. Otherwise UnclearUnit that begins with `file` and says how the user states the unit.
// `centres`: of the images that have positions, in any frame and unit. `rows`: the indices of their
// positions. With fewer than three, no similarity is determined, and the positions are metres.
ChosenUnit choose_unit(const PositionFile& read, std::span<const std::size_t> rows,
                       std::span<const Eigen::Vector3d> centres, const std::string& file);

}  // namespace axial::io
