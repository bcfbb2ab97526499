// SPDX-License-Identifier: GPL-3.0-or-later
// Where the targets of a survey are, for later surveys of the same targets: target_places.json
// (docs/formats.md, "Places of targets").
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace axial::control {

struct TargetPlace {
  std::string label;
  Eigen::Vector3d world = Eigen::Vector3d::Zero();  // the centre [m], in the world of the poses
  std::size_t photographs = 0;                      // that show the target
};

struct TargetPlaces {
  std::vector<TargetPlace> targets;
  // Covariance [m^2] of all coordinates, three rows and columns for each target. Infinite where
  // nothing determines a coordinate.
  Eigen::MatrixXd covariance;
  std::string crs = {};  // of the world, as Control::crs; empty: not stated
};

// The file in the output folder of RefinePoses.
inline constexpr const char* kTargetPlaces = "target_places.json";

// The file of places that belongs to a mesh: in the folder of the mesh, or in the folder refined/
// of the poses there. Empty: none. Error that names both files if both are there. `option`: by
// which the user states the file, for the message.
std::filesystem::path places_beside(const std::filesystem::path& mesh, const std::string& option);

// Reads a file that write_target_places() wrote. Error of one line, which names the file and the
// entry, for a file that cannot be read, an entry that is missing or is no finite number, two
// targets with the same label, and a matrix that has another size than the list, is not symmetric
// or has a variance below 0.
TargetPlaces read_target_places(const std::filesystem::path& file);

// Writes the file completely or not at all. Precondition: `covariance` has three rows and columns
// for each target. Error that names a file that cannot be written.
void write_target_places(const std::filesystem::path& file, const TargetPlaces& places);

// The targets of the same label (same_label()) all of whose coordinates are determined in both
// surveys: pairs of an index in `first` and one in `second`, in the order of `first`.
std::vector<std::pair<std::size_t, std::size_t>> common_targets(const TargetPlaces& first,
                                                                const TargetPlaces& second);

}  // namespace axial::control
