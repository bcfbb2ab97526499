// SPDX-License-Identifier: GPL-3.0-or-later
// The known positions of the images of a scene or model, from a file of labels and positions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/error.h"

namespace axial::io {

// Finds images by the labels that other programs give them. The time of a search does not depend on
// the number of images.
class ImageLabels {
 public:
  // `paths`: the paths or names of the images. They may change or end after the constructor.
  explicit ImageLabels(std::span<const std::string> paths);

  struct Match {
    std::vector<std::size_t> images;  // in ascending order
    int rank = 0;                     // of the rule by which they match; smaller is better
  };

  // The images to which the first of these rules leads:
  // 1. The label is the path of the image.
  // 2. The label is the end of the path, in whole folder and file names.
  // 3. The path is the end of the label.
  // 4. The label is an absolute path, as of another computer: the longest common end counts.
  // If none does, the same rules hold with both kinds of slashes, then without regard to small and
  // capital letters (of ASCII), then without the extension of the image and, if it is that of a
  // photograph, of the label, then without regard to both. An empty label belongs to no image.
  Match find(const std::string& label) const;

 private:
  struct Table {
    std::unordered_map<std::string, std::vector<std::size_t>> whole, ends;
  };
  static constexpr int kVariants = 4;
  std::array<Table, kVariants> tables_;
};

// A file of positions does not state their unit or order, and the cameras do not tell it.
class UnclearUnit : public Error {
 public:
  using Error::Error;
};

// The known position of one image.
struct ImagePosition {
  std::size_t image = 0;  // index into the paths
  int line = 0;           // of the file, from 1
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> sigma = {};  // standard deviations [m], if the file has them
};

struct ImagePositions {
  std::vector<ImagePosition> found;  // in the order of the lines
  std::vector<std::string> absent;   // a line of text for each label without an image
  std::vector<std::string> notes;    // as of read_positions(), each with the name of the file
};

// Reads a file of positions (position_file.h) and finds the image of each label. `paths`: the paths
// or names of the images. `whose`: the subject of the lines in `absent`, such as "the scene". If
// labels of different ranks belong to one image, the label with the best rank counts, and the
// others count as absent. Error that names the file and the line as for read_positions(), for a
// label that two images match equally well, and if an image occurs twice.
//
// `centres`: the camera centres of the images, in any frame and unit. If no line of the file states
// whether x and y are metres or degrees, and they can be either (PositionFile::as_degrees), all
// readings are tried. The reading counts whose positions fit the camera centres at least twice as
// well as those of every other reading, after a similarity; ten times with fewer than six images. A
// note says so. If no reading does, for example because the positions lie on one line, throws
// UnclearUnit, whose text shows a header line that states the unit. Positions of fewer than three
// images are metres. Lines whose x and y are 0 (a receiver without a fix) do not count for this
// choice. If the others are degrees, these lines are skipped, and a note states their number.
ImagePositions positions_of_images(const std::filesystem::path& file,
                                   std::span<const std::string> paths,
                                   std::span<const Eigen::Vector3d> centres,
                                   const std::string& whose);

}  // namespace axial::io
