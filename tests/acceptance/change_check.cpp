// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the maps of CompareSurveys with the true change of SimulateUnderwater. Usage:
//
//     change_check SEED CHANGE
//
// Both surveys were made by SimulateUnderwater --preset reef --seed SEED, the second one also with
// --changed. The map CHANGE.change.significant.tif was made by CompareSurveys with --up 0,0,1 and
// true poses. A pixel has changed if one of 3 x 3 vertical rays meets the highest surfaces of both
// surveys at heights that differ by more than 0.1 mm. Prints:
//   - the volumes between both true surfaces at the pixels that are compared [m^3]: came, gone; and
//     at the other pixels of the map;
//   - the areas [m^2]: compared; of them changed; falsely found.
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <opencv2/core.hpp>
#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "check_program.h"
#include "compare/changes.h"
#include "map/geotiff.h"
#include "simulate/presets/presets.h"
#include "simulate/ray_scene.h"

namespace {

using namespace axial;

simulate::TriangleMesh survey(const std::string& seed, bool changed) {
  simulate::PresetOptions options;
  options.seed = static_cast<std::uint32_t>(std::stoul(seed));
  options.changed = changed;
  return simulate::terrain_mesh(simulate::make_preset(options).terrain);
}

struct Truth {
  cv::Mat1b changed;     // 255: changed
  cv::Mat1d came, gone;  // volume of each pixel [m^3]
};

Truth true_change(const std::string& seed, const map::MapGrid& grid) {
  const simulate::RayScene before(survey(seed, false)), after(survey(seed, true));
  constexpr double kAbove = 100, kLeast = 1e-4;  // [m]
  constexpr int kSide = 3;
  const double area = grid.pixel * grid.pixel / (kSide * kSide);
  Truth truth{cv::Mat1b(grid.rows, grid.columns, std::uint8_t{0}),
              cv::Mat1d(grid.rows, grid.columns, 0.0), cv::Mat1d(grid.rows, grid.columns, 0.0)};
  parallel_for(static_cast<std::size_t>(grid.rows), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < grid.columns; ++x)
      for (int i = 0; i < kSide * kSide; ++i) {
        const Eigen::Vector3d from(grid.left + (x + (i % kSide + 0.5) / kSide) * grid.pixel,
                                   grid.top - (y + (i / kSide + 0.5) / kSide) * grid.pixel, kAbove);
        const auto high = before.first_hit(from, -Eigen::Vector3d::UnitZ());
        const auto low = after.first_hit(from, -Eigen::Vector3d::UnitZ());
        if (!high || !low) fail("the map is larger than the scene");
        const double rise = high->distance - low->distance;
        if (std::abs(rise) > kLeast) truth.changed(y, x) = 255;
        (rise > 0 ? truth.came : truth.gone)(y, x) += area * std::abs(rise);
      }
  });
  return truth;
}

void print_volumes(const cv::Mat1b& classes, const Truth& truth) {
  cv::Mat1b others;
  cv::compare(classes, compare::kNotCompared, others, cv::CMP_EQ);
  cv::Mat1b compared;
  cv::bitwise_not(others, compared);
  const auto sum = [](const cv::Mat1d& volumes, const cv::Mat1b& mask) {
    cv::Mat1d part(volumes.size(), 0.0);
    volumes.copyTo(part, mask);
    return cv::sum(part)[0];
  };
  std::cout << fmt::format("volumes: came {:.6f} gone {:.6f} others: came {:.6f} gone {:.6f}\n",
                           sum(truth.came, compared), sum(truth.gone, compared),
                           sum(truth.came, others), sum(truth.gone, others));
}

void print_areas(const cv::Mat1b& classes, const Truth& truth, double pixel_area) {
  int compared = 0, changed = 0, wrong = 0;
  for (int y = 0; y < classes.rows; ++y)
    for (int x = 0; x < classes.cols; ++x) {
      if (classes(y, x) == compare::kNotCompared) continue;
      const bool found = classes(y, x) != compare::kUnchanged, real = truth.changed(y, x) > 0;
      ++compared;
      changed += real ? 1 : 0;
      wrong += found && !real ? 1 : 0;
    }
  std::cout << fmt::format("areas: compared {:.4f} changed {:.4f} false {:.4f}\n",
                           compared * pixel_area, changed * pixel_area, wrong * pixel_area);
}

int run(int, char** argv) {
  const std::string change = argv[2];
  const map::StoredMap significant = map::read_map(change + ".change.significant.tif");
  const cv::Mat1b classes = significant.pixels;
  const map::MapGrid& grid = significant.grid;
  const Truth truth = true_change(argv[1], grid);
  print_volumes(classes, truth);
  print_areas(classes, truth, grid.pixel * grid.pixel);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return axial::check_program(argc, argv, 2, 2, "change_check SEED CHANGE", run);
}
