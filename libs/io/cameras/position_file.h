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

// Positions whose first two coordinates are read in one of several ways.
struct PositionReading {
  std::string unit;                        // of the first two coordinates, in words
  std::string note;                        // the line about their conversion
  std::vector<Eigen::Vector3d> positions;  // in metres
};

struct PositionFile {
  std::vector<NamedPosition> positions;  // in the order of the lines
  // Readings of the same positions as degrees. Empty, or, if no line states the unit of x and y,
  // and they can be metres or degrees: one reading for each possible order of longitude and
  // latitude. `positions` are then those of the reading as metres. Positions without an image, and
  // those whose x and y are 0 (a receiver without a fix), are the same in all readings.
  std::vector<PositionReading> as_degrees;
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
//    or with eight and more numbers, the fourth and fifth or the seventh and eighth are the
//    standard deviations of the plane coordinates and of the height. Other numbers are ignored.
// 3. Fields separated by semicolons, tabs or commas, with or without double quotes. The decimal
//    mark may be a comma, except between commas. Lines whose three coordinates are empty are
//    skipped.
//
// Lines before the first position may name the columns and the system of the coordinates
// (read_layout_line() lists the forms). Without them, x, y and z follow the name.
// `depth` is a height with the opposite sign if one depth of the file is positive. Longitude and
// latitude in degrees become metres in the UTM zone of their mean on the ellipsoid WGS 84, if a
// line states that they are degrees. If no line states the unit, the positions of images whose x
// and y are not both 0 count. These can be degrees if there are three or more that lie within 0.1
// of each other, more than 1 from zero, and within the ranges of longitude and latitude:
// positions_of_images() (image_positions.h) decides.
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
