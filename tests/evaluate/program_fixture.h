// SPDX-License-Identifier: GPL-3.0-or-later
// The scene of the tests that run EvaluateReconstruction and AlignModel.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "evaluate/shapes.h"
#include "geometry/sampling.h"
#include "io/bytes/json.h"
#include "io/colmap/colmap.h"
#include "io/ply/ply.h"
#include "support/program_run.h"

namespace axial::evaluate {

using test::Outcome;

class Programs : public test::ProgramTest {
 protected:
  Outcome run(const std::string& program, const std::string& arguments) const {
    return run_program(program, arguments);
  }

  void refuses(const std::string& expected, const std::string& arguments,
               const std::string& program = "EvaluateReconstruction") const {
    expect_refusal(program, arguments, expected);
  }

  nlohmann::json read_json(const std::string& name) const { return io::read_json(folder_ / name); }

  // A rippled seabed seen from above by four cameras, and a cloud 2 mm above the whole of it.
  void write_scene() const {
    Mesh truth = height_field(60, 2, ripples);
    io::write_mesh_ply(folder_ / "truth.ply", truth);
    io::write_colmap_text(folder_ / "true", model());
    PointCloud cloud;
    cloud.positions = geometry::sample_surface(truth, 20000, 3);
    for (auto& x : cloud.positions) x.z() += 0.002f;
    io::write_cloud_ply(folder_ / "cloud.ply", cloud);
  }

  io::ColmapModel model() const {
    std::filesystem::create_directories(folder_ / "true");
    io::ColmapModel result;
    result.cameras.push_back({1, "PINHOLE", 320, 240, {300, 300, 160, 120}});
    for (unsigned i = 0; i < 4; ++i) {
      io::ColmapImage image;
      image.id = i + 1;
      image.camera = 1;
      image.name = fmt::format("{:04}.jpg", i);
      image.pose.rotation << 1, 0, 0, 0, -1, 0, 0, 0, -1;
      image.pose.centre = {0.3 * (i % 2), 0.3 * (i / 2), 1.5 + 0.1 * i};
      result.images.push_back(image);
    }
    return result;
  }
};

}  // namespace axial::evaluate
