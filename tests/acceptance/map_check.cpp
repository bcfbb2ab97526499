// SPDX-License-Identifier: GPL-3.0-or-later
// Compares maps of MapSurface with the true surface of SimulateUnderwater. Usage:
//
//     map_check PRESET SEED COARSENESS MAP PHOTOGRAPHS
//
// The scene was made by SimulateUnderwater --preset PRESET --seed SEED --coarseness COARSENESS, and
// the maps MAP.dem.tif, MAP.ortho.tif and MAP.sigma.tif by MapSurface with true poses and --up
// 0,0,1 from the folder PHOTOGRAPHS, taken under water through a flat port. Prints:
//   - the distances of the points of the height map to the true surface [mm]: RMS;
//   - the expected errors of these heights: the median of true error / expected error, times 1.48,
//     so that it is 1 for normally distributed errors as large as expected; then, for each fifth of
//     the pixels in the order of the expected error, the median expected error and 1.48 times the
//     median true error [mm];
//   - the PSNR of the orthomosaic against the true one [dB], which has the colours of the mean of
//     3 x 3 vertical rays in each pixel;
//   - the displacement of the orthomosaic: tiles of 64 x 64 pixels are matched with the true one by
//     phase correlation [px]: RMS of x and y together, and the number of tiles;
//   - the ground that no photograph sees, that one photograph sees, and the pixels without colour,
//     as shares of the ground inside the frames of two photographs; then where they differ;
//   - the edges at depth steps (map_edges.h) of the orthomosaic, and of three maps that show what
//   the
//     count finds: the mean of the orthomosaic and its copy, 5 px apart; a map from the nearest
//     photographs that see the true points, which has no doubled edges; and the same without
//     visibility, which has.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/order_statistics.h"
#include "check_program.h"
#include "geometry/surface.h"
#include "map/geotiff.h"
#include "map_edges.h"
#include "map_truth.h"
#include "simulate/presets/presets.h"

namespace {

using namespace axial;
using namespace map_check;

double rms_of(const std::vector<float>& errors) {
  if (errors.empty()) fail("no pixel has a height");
  double squares = 0;
  for (const float error : errors) squares += static_cast<double>(error) * error;
  return std::sqrt(squares / static_cast<double>(errors.size()));
}

void print_heights(const map::StoredMap& dem, const TrueMap& truth,
                   const simulate::TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> points;
  for (int y = 0; y < dem.pixels.rows; ++y)
    for (int x = 0; x < dem.pixels.cols; ++x) {
      const float height = dem.pixels.at<float>(y, x);
      if (height == map::kNoHeight || std::isnan(truth.heights(y, x))) continue;
      points.emplace_back(static_cast<float>(dem.grid.left + (x + 0.5) * dem.grid.pixel),
                          static_cast<float>(dem.grid.top - (y + 0.5) * dem.grid.pixel), height);
    }
  const geometry::Surface surface({mesh.vertices, {}, mesh.faces});
  std::cout << fmt::format("distances: RMS {:.3f} mm\n",
                           1000 * rms_of(geometry::distances_to(surface, points)));
}

void print_psnr(const cv::Mat4b& ortho, const TrueMap& truth) {
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

void print_displacement(const cv::Mat4b& ortho, const TrueMap& truth) {
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
  double squares = 0;
  int tiles = 0;
  for (int y = 0; y + kTile <= ortho.rows; y += kTile)
    for (int x = 0; x + kTile <= ortho.cols; x += kTile) {
      const cv::Rect at(x, y, kTile, kTile);
      if (cv::countNonZero(alpha(at)) < at.area() || cv::countNonZero(truth.known(at)) < at.area())
        continue;
      const cv::Point2d shift = cv::phaseCorrelate(true_grey(at), grey(at), window);
      squares += shift.dot(shift);
      ++tiles;
    }
  if (tiles == 0) fail("no tile of {} pixels is complete", kTile);
  std::cout << fmt::format("displacement: RMS {:.3f} px of {} tiles\n", std::sqrt(squares / tiles),
                           tiles);
}

// Errors of heights by their expectation: fifths of the pixels with growing expected error.
void print_expected_errors(const map::StoredMap& dem, const map::StoredMap& sigma,
                           const TrueMap& truth) {
  struct Error {
    float expected, seen;
  };
  std::vector<Error> errors;
  for (int y = 0; y < dem.pixels.rows; ++y)
    for (int x = 0; x < dem.pixels.cols; ++x) {
      const float expected = sigma.pixels.at<float>(y, x), height = dem.pixels.at<float>(y, x);
      if (expected == map::kNoHeight || height == map::kNoHeight || std::isnan(truth.heights(y, x)))
        continue;
      errors.push_back({expected, std::abs(height - truth.heights(y, x))});
    }
  if (errors.empty()) fail("no pixel has an expected error");
  std::ranges::stable_sort(errors, {}, &Error::expected);
  const auto median = [](std::vector<float> values) {
    return static_cast<double>(upper_median(std::move(values)));
  };
  std::vector<float> ratios;
  for (const Error& error : errors) ratios.push_back(error.seen / error.expected);
  constexpr double kToSigma = 1.4826;  // of normally distributed errors
  std::cout << fmt::format("expected errors: true ones are {:.3f} times as large; fifths:",
                           kToSigma * median(ratios));
  constexpr std::size_t kClasses = 5;
  for (std::size_t k = 0; k < kClasses; ++k) {
    std::vector<float> expected, seen;
    for (std::size_t i = k * errors.size() / kClasses; i < (k + 1) * errors.size() / kClasses; ++i)
      expected.push_back(errors[i].expected), seen.push_back(errors[i].seen);
    std::cout << fmt::format(" {:.3f} {:.3f}{}", 1000 * median(expected),
                             1000 * kToSigma * median(seen), k + 1 < kClasses ? "," : " mm\n");
  }
}

// Of the ground inside the frames of two photographs, because a mesh needs two.
void print_hidden_ground(const cv::Mat4b& ortho, const TrueMap& truth) {
  std::size_t ground = 0, painted[3] = {}, open[3] = {};  // by 0, 1 and more photographs
  for (int y = 0; y < ortho.rows; ++y)
    for (int x = 0; x < ortho.cols; ++x) {
      if (truth.frames(y, x) < 2) continue;
      ++ground;
      const std::size_t views = truth.views(y, x);
      ++(ortho(y, x)[3] == 0 ? open : painted)[views > 2 ? 2 : views];
    }
  const auto share = [&](std::size_t pixels) {
    return 100 * static_cast<double>(pixels) / static_cast<double>(ground);
  };
  std::cout << fmt::format(
      "ground: hidden {:.3f} seen once {:.3f} open {:.3f}; hidden but painted {:.3f} seen once and "
      "painted {:.3f} seen more often but open {:.3f} % of {} pixels\n",
      share(painted[0] + open[0]), share(painted[1] + open[1]), share(open[0] + open[1] + open[2]),
      share(painted[0]), share(painted[1]), share(open[2]), ground);
}

void print_edges(const char* name, const EdgeCounts& counts) {
  if (counts.lines == 0) fail("no depth step has contrast");
  const auto share = [&](std::size_t part) {
    return 100 * static_cast<double>(part) / static_cast<double>(counts.lines);
  };
  std::cout << fmt::format("edges {}: doubled {:.2f} % of {} lines\n", name, share(counts.doubled),
                           counts.lines);
}

void print_all_edges(const cv::Mat4b& ortho, const TrueMap& truth, const NearestMaps& nearest) {
  cv::Mat3b colors;
  cv::cvtColor(ortho, colors, cv::COLOR_RGBA2RGB);
  cv::Mat1b usable;
  cv::extractChannel(ortho, usable, 3);
  usable &= truth.known;
  const std::vector<Crossing> crossings = depth_steps(truth, usable, nearest.wrong);
  if (crossings.empty()) fail("the map has no depth step");
  const auto print = [&](const char* name, const cv::Mat3b& map) {
    print_edges(name, count_edges(map, truth.colors, crossings));
  };
  print("of the orthomosaic", colors);
  print("of the orthomosaic and its copy, 5 px apart", doubled(colors, 4, 3));
  print("of a map with true heights and visibility", nearest.visible);
  print("of a map without visibility", nearest.naive);
}

int run(int, char** argv) {
  simulate::PresetOptions options;
  options.name = argv[1];
  options.seed = static_cast<std::uint32_t>(std::stoul(argv[2]));
  options.coarseness = std::stod(argv[3]);
  SimulatedScene scene{simulate::make_preset(options), {}};
  scene.mesh = simulate::terrain_mesh(scene.preset.terrain);
  const std::string map = argv[4];
  const map::StoredMap dem = map::read_map(map + ".dem.tif");
  const map::StoredMap ortho = map::read_map(map + ".ortho.tif");
  const map::StoredMap sigma = map::read_map(map + ".sigma.tif");
  const TrueMap truth = true_map(scene, dem.grid);
  print_heights(dem, truth, scene.mesh);
  print_expected_errors(dem, sigma, truth);
  print_psnr(ortho.pixels, truth);
  print_displacement(ortho.pixels, truth);
  print_hidden_ground(ortho.pixels, truth);
  print_all_edges(ortho.pixels, truth, nearest_maps(scene, dem.grid, truth, argv[5]));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return axial::check_program(argc, argv, 5, 5, "map_check PRESET SEED COARSENESS MAP PHOTOGRAPHS",
                              run);
}
