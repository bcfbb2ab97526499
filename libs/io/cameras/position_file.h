// SPDX-License-Identifier: GPL-3.0-or-later
// Text files of positions by image name, and lists of names, as users and other programs write
// them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axial::io {

// Tells whether `name` is the name of an image.
using IsImage = std::function<bool(const std::string& name)>;

// One line of a file of positions.
struct NamedPosition {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // x, y and height, in metres
  int line = 0;                                        // its number in the file, from 1
  bool known = false;                                  // the result of `is_image` for the name
  std::optional<Eigen::Vector3d> sigma = {};  // standard deviations [m], if the file has them
};

struct PositionFile {
  std::vector<NamedPosition> positions;  // in the order of the lines
  // How the file was understood, a line for each decision that its user should know: degrees that
  // were converted, columns that were taken as accuracies, depths, lines without coordinates.
  std::vector<std::string> notes;
};

// Reads a file with a line for each image, in UTF-8 with or without a byte order mark. Names that
// are no images or occur twice are returned, too. The line ends may be those of any system. Lines
// have one of these forms:
//
// 1. NAME X Y Z, separated by blanks. The numbers are read from the end of the line, so that a name
//    may contain blanks. A comment starts with '#' at the beginning of the line or after a blank.
//    Exception: a '#' does not start a comment if `is_image` returns true for a name that contains
//    this '#'. A name in double quotes is taken literally, and "" between the quotes stands for one
//    quote. Empty lines are skipped.
// 2. The same with more numbers behind, as in OpenDroneMap's geo.txt and Pix4D's files. With five
// or
//    with eight and more numbers, the fourth and fifth or the seventh and eighth are the standard
//    deviations of the plane coordinates and of the height. Other numbers are ignored.
// 3. Fields separated by semicolons, tabs or commas, with or without double quotes. The decimal
// mark
//    may be a comma, except between commas. Lines whose three coordinates are empty are skipped.
//
// Lines before the first position may name the columns and the system of the coordinates
// (private/cameras/position_layout.h lists the forms). Without them, x, y and z follow the name.
// `depth` is a height with the opposite sign if one depth of the file is positive. Longitude and
// latitude in degrees become metres in the UTM zone of their mean on the ellipsoid WGS 84. They are
// recognised by a line that states them, or if three or more positions lie within a hundredth of a
// unit, at a distance of more than one unit from zero.
//
// Error for a file that cannot be read. Error that names the file and, if possible, the line, for a
// line of another form, numbers that are not finite, degrees whose order is not known or that
// belong to another datum, lengths that are not in metres, and COLMAP's images.txt.
PositionFile read_positions(const std::filesystem::path& file, const IsImage& is_image);

// Splits a list at its commas and returns the fields. Blanks are kept, and an empty text gives one
// empty field. A field in double quotes may contain commas, and "" between the quotes stands for
// one quote. Error that starts with `where` if a quote is not closed.
std::vector<std::string> split_list(std::string_view text, const std::string& where);

}  // namespace axial::io
