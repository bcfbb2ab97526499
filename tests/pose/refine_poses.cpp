// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/refine_poses.h"

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "io/cameras/housing.h"

namespace axial::pose {

void RefinePoses::SetUp() {
  ProgramTest::SetUp();
  write_input();
  io::write_housing(folder_ / "housing.json", testing::housing());
}

void RefinePoses::write_input() {
  write("sparse", testing::model_of(testing::absorbed(truth_, 7.3)));
  io::ColmapModel lens;
  lens.cameras = {testing::kLens};
  write("lens", lens);
}

void RefinePoses::write(const std::string& name, const io::ColmapModel& model) {
  make_folder(folder_ / name);
  io::write_colmap_text(folder_ / name, model);
}

std::string RefinePoses::succeed(const std::string& arguments) const {
  return succeed_in("RefinePoses", arguments);
}

Bundle RefinePoses::found_poses(const io::ColmapModel& refined) const {
  Bundle found = truth_;
  for (std::size_t i = 0; i < found.images.size(); ++i)
    found.images[i].pose = refined.images.at(i).pose;
  return found;
}

std::string RefinePoses::baseline() const {
  return fmt::format("images:image0.jpg,image11.jpg,{}", testing::known_length(truth_).metres);
}

}  // namespace axial::pose
