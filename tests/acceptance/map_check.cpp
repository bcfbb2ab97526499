// SPDX-License-Identifier: GPL-3.0-or-later
// Compares maps of MapSurface with the true surface of SimulateUnderwater. Usage:
//
//     map_check PRESET SEED COARSENESS MAP
//
// The scene was made by SimulateUnderwater --preset PRESET --seed SEED --coarseness COARSENESS, and
// the maps MAP.dem.tif and MAP.ortho.tif by MapSurface with true poses and --up 0,0,1. Prints:
//   - the distances of the points of the height map to the true surface [mm]: RMS and median;
//   - the differences of heights from the highest point of the true surface [mm]: RMS and median;
//   - the PSNR of the orthomosaic against the true one [dB], which has the colours of the mean of 3
//   x
//     3 vertical rays in each pixel;
//   - the displacement of the orthomosaic: tiles of 64 x 64 pixels are matched with the true one by
//     phase correlation [px]: RMS of x and y together, mean x, mean y, and the number of tiles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "evaluate/surface.h"
#include "map/geotiff.h"
#include "simulate/presets.h"

namespace {

using namespace axial;

struct Truth {
  cv::Mat1f heights;  // NaN: no surface
  cv::Mat3b colors;   // R G B
  cv::Mat1b known;    // all rays of the pixel meet the surface
};

Truth true_map(const simulate::TriangleMesh& mesh, const simulate::Preset& preset,
               const map::MapGrid& grid) {
  const simulate::RayScene scene(mesh);
  const simulate::Shader shader = simulate::seabed_shader(mesh, scene, preset.texture);
  Truth truth{cv::Mat1f(grid.rows, grid.columns, std::nanf("")),
              cv::Mat3b(grid.rows, grid.columns, cv::Vec3b(0, 0, 0)),
              cv::Mat1b(grid.rows, grid.columns, std::uint8_t{0})};
  constexpr double kAbove = 100;  // [m]
  constexpr int kSide = 3;
  parallel_for(static_cast<std::size_t>(grid.rows), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < grid.columns; ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      int hits = 0;
      for (int i = 0; i < kSide * kSide; ++i) {
        const Eigen::Vector3d from(grid.left + (x + (i % kSide + 0.5) / kSide) * grid.pixel,
                                   grid.top - (y + (i / kSide + 0.5) / kSide) * grid.pixel, kAbove);
        const auto hit = scene.first_hit(from, -Eigen::Vector3d::UnitZ());
        if (!hit) continue;
        ++hits;
        const double height = kAbove - hit->distance;
        if (i == kSide * kSide / 2) truth.heights(y, x) = static_cast<float>(height);
        sum += shader({{from.x(), from.y(), height}, *hit, grid.pixel});
      }
      if (hits < kSide * kSide) continue;
      truth.known(y, x) = 255;
      for (int k = 0; k < 3; ++k)
        truth.colors(y, x)[k] = cv::saturate_cast<std::uint8_t>(255 * sum[k] / (kSide * kSide));
    }
  });
  return truth;
}

struct Spread {
  double rms = 0, median = 0;
};

Spread spread_of(std::vector<float> errors) {
  if (errors.empty()) fail("no pixel has a height");
  double squares = 0;
  for (float& error : errors) {
    error = std::abs(error);
    squares += static_cast<double>(error) * error;
  }
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return {std::sqrt(squares / static_cast<double>(errors.size())), *middle};
}

void print_heights(const map::StoredMap& dem, const Truth& truth,
                   const simulate::TriangleMesh& mesh) {
  std::vector<float> differences;
  std::vector<Eigen::Vector3f> points;
  for (int y = 0; y < dem.pixels.rows; ++y)
    for (int x = 0; x < dem.pixels.cols; ++x) {
      const float height = dem.pixels.at<float>(y, x);
      if (height == map::kNoHeight || std::isnan(truth.heights(y, x))) continue;
      differences.push_back(height - truth.heights(y, x));
      points.emplace_back(static_cast<float>(dem.grid.left + (x + 0.5) * dem.grid.pixel),
                          static_cast<float>(dem.grid.top - (y + 0.5) * dem.grid.pixel), height);
    }
  const evaluate::Surface surface({mesh.vertices, {}, mesh.faces});
  const Spread near = spread_of(evaluate::distances_to(surface, points));
  const Spread vertical = spread_of(differences);
  std::cout << fmt::format("distances: RMS {:.3f} median {:.3f} mm\n", 1000 * near.rms,
                           1000 * near.median);
  std::cout << fmt::format("heights: RMS {:.3f} median {:.3f} mm\n", 1000 * vertical.rms,
                           1000 * vertical.median);
}

void print_psnr(const cv::Mat4b& ortho, const Truth& truth) {
  double squares = 0;
  std::size_t pixels = 0;
  for (int y = 0; y < ortho.rows; ++y)
    for (int x = 0; x < ortho.cols; ++x) {
      if (ortho(y, x)[3] == 0 || truth.known(y, x) == 0) continue;
      ++pixels;
      for (int k = 0; k < 3; ++k)
        squares += std::pow(double{1} * ortho(y, x)[k] - truth.colors(y, x)[k], 2);
    }
  std::cout << fmt::format("colours: PSNR {:.2f} dB of {} pixels\n",
                           10 * std::log10(255.0 * 255 * 3 * static_cast<double>(pixels) / squares),
                           pixels);
}

void print_displacement(const cv::Mat4b& ortho, const Truth& truth) {
  constexpr int kTile = 64;
  cv::Mat3b colors;
  cv::cvtColor(ortho, colors, cv::COLOR_RGBA2RGB);
  cv::Mat1b alpha;
  cv::extractChannel(ortho, alpha, 3);
  cv::Mat1f grey, true_grey, window;
  cv::Mat one, two;
  cv::cvtColor(colors, one, cv::COLOR_RGB2GRAY);
  cv::cvtColor(truth.colors, two, cv::COLOR_RGB2GRAY);
  one.convertTo(grey, CV_32F), two.convertTo(true_grey, CV_32F);
  cv::createHanningWindow(window, {kTile, kTile}, CV_32F);
  double squares = 0, sum_x = 0, sum_y = 0;
  int tiles = 0;
  for (int y = 0; y + kTile <= ortho.rows; y += kTile)
    for (int x = 0; x + kTile <= ortho.cols; x += kTile) {
      const cv::Rect at(x, y, kTile, kTile);
      if (cv::countNonZero(alpha(at)) < at.area() || cv::countNonZero(truth.known(at)) < at.area())
        continue;
      const cv::Point2d shift = cv::phaseCorrelate(true_grey(at), grey(at), window);
      squares += shift.dot(shift), sum_x += shift.x, sum_y += shift.y;
      ++tiles;
    }
  if (tiles == 0) fail("no tile of {} pixels is complete", kTile);
  const double n = tiles;
  std::cout << fmt::format("displacement: RMS {:.3f} mean {:.3f} {:.3f} px of {} tiles\n",
                           std::sqrt(squares / n), sum_x / n, sum_y / n, tiles);
}

int run(char** argv) {
  simulate::PresetOptions options;
  options.name = argv[1];
  options.seed = static_cast<std::uint32_t>(std::stoul(argv[2]));
  options.coarseness = std::stod(argv[3]);
  const simulate::Preset preset = simulate::make_preset(options);
  const simulate::TriangleMesh mesh = simulate::terrain_mesh(preset.terrain);
  const map::StoredMap dem = map::read_map(std::string(argv[4]) + ".dem.tif");
  const map::StoredMap ortho = map::read_map(std::string(argv[4]) + ".ortho.tif");
  const Truth truth = true_map(mesh, preset, dem.grid);
  print_heights(dem, truth, mesh);
  print_psnr(ortho.pixels, truth);
  print_displacement(ortho.pixels, truth);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: map_check PRESET SEED COARSENESS MAP\n";
    return 1;
  }
  try {
    return run(argv);
  } catch (const std::exception& error) {
    std::cerr << "map_check: " << error.what() << "\n";
    return 1;
  }
}
