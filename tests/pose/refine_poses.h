// SPDX-License-Identifier: GPL-3.0-or-later
// The fixture of the tests that run the program RefinePoses.
#pragma once

#include <string>

#include "io/colmap/colmap.h"
#include "pose/colmap_survey.h"
#include "pose/survey.h"
#include "support/program_run.h"

namespace axial::pose {

// Writes the input files of RefinePoses for a survey behind a flat port: the housing, the lens, and
// a COLMAP model whose poses have absorbed refraction.
class RefinePoses : public test::ProgramTest {
 protected:
  Bundle truth_ = testing::survey(testing::camera_behind(testing::flat_port(2)), {.noise = 0.2});

  void SetUp() override;

  // Writes the survey as a COLMAP model, and the lens.
  void write_input();

  void write(const std::string& name, const io::ColmapModel& model);

  // Runs the program, which must succeed, and returns what it says.
  std::string succeed(const std::string& arguments) const;

  // The survey with the poses of `refined`, which has all images in their order.
  Bundle found_poses(const io::ColmapModel& refined) const;

  // Returns the option --scale-from with the true distance of two images.
  std::string baseline() const;
};

// The options that name the files of the fixture.
inline const std::string kInput = "-i . --lens lens/cameras.txt --housing housing.json ";

}  // namespace axial::pose
