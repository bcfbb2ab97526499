// SPDX-License-Identifier: GPL-3.0-or-later
// Files of targets, control points and scale bars.
#include <array>

#include "control/read_control.h"
#include "control/target_places.h"
#include "control/write_control.h"
#include "reader.h"

namespace axial::fuzz {
namespace {

control::Control read_checked(const fs::path& file) {
  control::Control read = control::read_control(file, {});
  for (const control::ControlPoint& point : read.points) {
    require(point.metres.allFinite() && !point.label.empty(), "a point is not possible");
    require((point.sigma.array() > 0).all(), "a standard deviation is not possible");
  }
  for (const control::Bar& bar : read.bars)
    require(bar.metres > 0 && bar.sigma > 0, "a bar is not possible");
  for (const control::TargetImage& image : read.images)
    require(image.pixel.allFinite() && image.sigma >= 0, "a place in a photograph is not possible");
  return read;
}

// JSON holds everything that the other formats state, if its texts are UTF-8.
void read_file_of_control(const fs::path& file) {
  const control::Control read = read_checked(file);
  const fs::path copy = copy_of(file).replace_extension(".json");
  try {
    control::write_control_json(copy, read);
  } catch (const Error&) {
    return;
  }
  const control::Control again = without_error([&] { return control::read_control(copy, {}); });
  require(again.points.size() == read.points.size() && again.bars.size() == read.bars.size() &&
              again.images.size() == read.images.size(),
          "the copy of a file is read as another value");
}

control::Control some_control() {
  control::Control control;
  control.crs = "EPSG:32617";
  control::ControlPoint point;
  point.label = "target 1";
  point.metres = {500000.5, 2500000.25, -3.5};
  point.sigma = {0.01, 0.02, 0.03};
  control.points.push_back(point);
  point.label = "target 2";
  point.check = true;
  control.points.push_back(point);
  control.bars.push_back({"target 1", "target 2", 0.5, 0.001, false, {}});
  control::TargetImage image;
  image.label = "target 1";
  image.image = "a.jpg";
  image.pixel = {12.5, 7.25};
  control.images.push_back(image);
  return control;
}

bool write_json_seed(const fs::path& file, int variant) {
  if (variant == 0) control::write_control_json(file, some_control());
  if (variant == 1)
    write_atomically(file,
                     R"({"points": [{"label": "a", "longitude": -81, "latitude": 24, "depth": 3}],
                         "bars": [{"targets": ["a", "b"], "length": 1, "check": true}]})");
  return variant < 2;
}

bool write_gcp_seed(const fs::path& file, int variant) {
  if (variant == 0) control::write_gcp_list(file, some_control());
  if (variant == 1)
    write_atomically(file, "WGS84 UTM 16S\n1 2 nan 3 4 a.jpg\n1 2 3 4 5 b.jpg p x\n");
  return variant < 2;
}

bool write_xml_seed(const fs::path& file, int variant) {
  control::write_metashape_markers(file, some_control());
  return variant < 1;
}

bool write_table_seed(const fs::path& file, int variant) {
  if (variant == 0) control::write_reefshape_bars(file, some_control());
  if (variant == 1) control::write_reefshape_control(file, some_control());
  if (variant == 2) control::write_metashape_reference(file, some_control());
  return variant < 3;
}

void read_file_of_places(const fs::path& file) {
  const control::TargetPlaces read = control::read_target_places(file);
  const fs::path copy = copy_of(file);
  try {
    control::write_target_places(copy, read);
  } catch (const Error&) {
    return;
  }
  const control::TargetPlaces again =
      without_error([&] { return control::read_target_places(copy); });
  require(again.targets.size() == read.targets.size() && again.covariance == read.covariance,
          "the copy of a file is read as another value");
  require(control::common_targets(read, again).size() <= read.targets.size(),
          "a target is counted twice");
}

bool write_places_seed(const fs::path& file, int variant) {
  control::TargetPlaces places;
  if (variant == 1) {
    places.targets = {{"target 7", {1, 2, 3}, 4}, {"a", {-1, 0.5, 1e6}, 2}};
    places.covariance = Eigen::MatrixXd::Identity(6, 6);
    places.covariance(5, 5) = control::kNotKnown;
  }
  if (variant < 2) control::write_target_places(file, places);
  return variant < 2;
}

}  // namespace

std::span<const Reader> control_readers() {
  static constexpr std::array kReaders{
      Reader{"control-json", "control.json", read_file_of_control, write_json_seed},
      Reader{"control-gcp", "gcp_list.txt", read_file_of_control, write_gcp_seed},
      Reader{"control-xml", "markers.xml", read_file_of_control, write_xml_seed},
      Reader{"control-table", "control.csv", read_file_of_control, write_table_seed},
      Reader{"control-places", "places.json", read_file_of_places, write_places_seed}};
  return kReaders;
}

}  // namespace axial::fuzz
