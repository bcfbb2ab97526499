// SPDX-License-Identifier: GPL-3.0-or-later
// The fixture of the tests of RefinePoses on files.
#pragma once

#include <fmt/format.h>

#include <string>

#include "base/atomic_file.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "pose/adjust.h"
#include "pose/colmap_survey.h"
#include "pose/refine.h"
#include "pose/survey.h"
#include "support/program_run.h"

namespace axial::pose {

// A survey behind a flat port in the files from which RefinePoses starts: a COLMAP model whose
// poses absorbed refraction, the lens, and the housing.
class RefinePoses : public test::ProgramTest {
 protected:
  Bundle truth_ = testing::survey(testing::camera_behind(testing::flat_port(2)), {.noise = 0.2});

  void SetUp() override {
    ProgramTest::SetUp();
    write_input();
    io::write_housing(folder_ / "housing.json", testing::housing());
  }

  // Writes the survey as a COLMAP model, and the lens.
  void write_input() {
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

  void write(const std::string& name, const io::ColmapModel& model) {
    make_folder(folder_ / name);
    io::write_colmap_text(folder_ / name, model);
  }

  test::Outcome run(const std::string& arguments) const {
    return run_program("RefinePoses", arguments);
  }

  std::string baseline() const {
    return fmt::format("images:image0.jpg,image11.jpg,{}",
                       (truth_.images[0].pose.centre - truth_.images[11].pose.centre).norm());
  }
};

// The options for the files of the fixture.
inline const std::string kInput = "-i . --lens lens/cameras.txt --housing housing.json ";

}  // namespace axial::pose
