// SPDX-License-Identifier: GPL-3.0-or-later
// Text files of positions by image name, and lists of names, as users write them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace axial::io {

// Tells whether `name` is the name of an image.
using IsImage = std::function<bool(const std::string& name)>;

// One line of a file of positions.
struct NamedPosition {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // as in the file
  int line = 0;                                        // its number in the file, from 1
  bool known = false;                                  // the result of `is_image` for the name
};

// Reads a file with lines "NAME X Y Z", in UTF-8 with or without a byte order mark. Returns the
// positions in the order of the lines. Names that are no images or occur twice are returned too.
// The numbers are read from the end of the line, so that a name may contain blanks. A comment
// starts with '#' at the beginning of the line or after a blank. Exception: a '#' does not start a
// comment if `is_image` returns true for a name that contains this '#'. A name in double quotes is
// taken literally, and "" between the quotes stands for one quote. Empty lines are skipped. Error
// for a file that cannot be read. Error that names the file and the line for a line of another form
// and for numbers that are not finite.
std::vector<NamedPosition> read_positions(const std::filesystem::path& file,
                                          const IsImage& is_image);

// Splits a list at its commas and returns the fields. Blanks are kept, and an empty text gives one
// empty field. A field in double quotes may contain commas, and "" between the quotes stands for
// one quote. Error that starts with `where` if a quote is not closed.
std::vector<std::string> split_list(std::string_view text, const std::string& where);

}  // namespace axial::io
