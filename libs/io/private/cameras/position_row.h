// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: one line of a file of positions.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "io/cameras/position_file.h"
#include "private/cameras/position_layout.h"
#include "private/only_for_io.h"

namespace axial::io {

// The values of one line, in the order and the units of the file.
struct PositionRow {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> sigma = {};
  bool known = false;             // the result of `is_image` for the name
  bool is_depth = false;          // the third coordinate is positive downwards
  bool sigma_guessed = false;     // no header says that these numbers are accuracies
  bool without_position = false;  // the fields of the coordinates are empty
};

// Reads a line in one of the forms of read_positions(). Nothing for an empty line and a comment.
// Error that begins with `where` for a line of another form and for numbers that are not finite.
std::optional<PositionRow> read_position_row(std::string_view text, const PositionLayout& layout,
                                             const IsImage& is_image, const std::string& where);

}  // namespace axial::io
