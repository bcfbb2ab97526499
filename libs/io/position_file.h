// SPDX-License-Identifier: GPL-3.0-or-later
// Files of positions by image name, and lists of names: what users type.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace axial::io {

using IsImage = std::function<bool(const std::string& name)>;

struct NamedPosition {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  int line = 0;
  bool known = false;  // `is_image` says so
};

// The lines "NAME X Y Z" of a file, in UTF-8 with or without a byte order mark. The numbers are
// read from the line's end: a name may hold blanks. A comment begins with '#', at the line's
// beginning or behind a blank, unless `is_image` knows a name with that '#' in it. A name in double
// quotes is taken as it stands, with "" for a quote in it. Error that names file and line for
// anything else, and for numbers that are not finite.
std::vector<NamedPosition> read_positions(const std::filesystem::path& file,
                                          const IsImage& is_image);

// The fields of a list with commas between them. A field in double quotes may hold commas, and ""
// for a quote. Error that starts with `where` for a quote that is not closed.
std::vector<std::string> split_list(std::string_view text, const std::string& where);

}  // namespace axial::io
