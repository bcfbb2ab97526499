// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/refine_poses.h"

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "io/cameras/housing.h"
#include "pose/adjust.h"
#include "pose/refine.h"

namespace axial::pose {

void RefinePoses::SetUp() {
  ProgramTest::SetUp();
  write_input();
  io::write_housing(folder_ / "housing.json", testing::housing());
}

void RefinePoses::write_input() {
  Bundle absorbed = truth_;
  for (BundleCamera& camera : absorbed.cameras) camera.measured.port.reset();
  AdjustOptions options;
  options.free[kFocalNumber] = true;
  options.loss_sigmas = 10;
  adjust(absorbed, options);
  scale_places(absorbed, 7.3);
  write("sparse", testing::model_of(absorbed));
  io::ColmapModel lens;
  lens.cameras = {testing::kLens};
  write("lens", lens);
}

void RefinePoses::write(const std::string& name, const io::ColmapModel& model) {
  make_folder(folder_ / name);
  io::write_colmap_text(folder_ / name, model);
}

test::Outcome RefinePoses::run(const std::string& arguments) const {
  return run_program("RefinePoses", arguments);
}

std::string RefinePoses::baseline() const {
  return fmt::format("images:image0.jpg,image11.jpg,{}",
                     (truth_.images[0].pose.centre - truth_.images[11].pose.centre).norm());
}

}  // namespace axial::pose
