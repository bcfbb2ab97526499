// SPDX-License-Identifier: GPL-3.0-or-later
// Compares photographs with the true colours of the surface. Usage:
//
//     color_check TRUTH PHOTOGRAPHS [TRUTH PHOTOGRAPHS ...]
//
// TRUTH is the folder "water" of SimulateUnderwater --water, with NAME.albedo.tiff,
// NAME.distance.tiff, NAME.normal.tiff and NAME.lit.tiff; PHOTOGRAPHS has NAME.jpg with values of
// sRGB. Compared are patches of 12 x 12 pixels whose distances differ by less than 3 %, whose
// normal is within 30 degrees of the vertical, which are not clipped, and on which there is no
// shadow: at most 1 % of the light is missing. White is known: each channel is multiplied by the
// median of albedo over light, over all patches of a folder. Prints one line of JSON:
//   - "delta_e": the median CIEDE2000 between patch and albedo;
//   - "angle_degrees": the median angle between them as vectors of linear R G B;
//   - "slopes": of log(light / albedo) by distance, R G B [1/m];
//   - "patches": their number;
//   - "position": the root mean square, over cells of the image (8 x 6), of the median of
//     log(luminance / true luminance) in the cell: rings of light.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/error.h"
#include "base/order_statistics.h"
#include "check_program.h"
#include "color/difference.h"
#include "color/transfer.h"
#include "io/images/image.h"

namespace {

using namespace axial;
namespace fs = std::filesystem;

struct Patch {
  cv::Vec3f light, albedo;  // linear R G B
  float distance;
  int cell;  // of the image
};

cv::Mat read_float(const fs::path& file) {
  cv::Mat image = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (image.empty() || image.depth() != CV_32F) fail_in(file, "is no float image");
  return image;
}

cv::Vec3f mean_of(const cv::Mat& image, const cv::Rect& part) {
  const cv::Scalar mean = cv::mean(image(part));
  return {static_cast<float>(mean[0]), static_cast<float>(mean[1]), static_cast<float>(mean[2])};
}

void add_patches(const fs::path& truth, const fs::path& photograph, std::vector<Patch>& patches) {
  constexpr int kSide = 12, kCellsX = 8, kCellsY = 6;
  const std::string name = (truth.parent_path() / truth.stem().stem()).string();
  // cv::imread() returns B G R.
  cv::Mat albedo, distance = read_float(name + ".distance.tiff"), normal, lit;
  if (fs::exists(name + ".lit.tiff")) lit = read_float(name + ".lit.tiff");
  cv::cvtColor(read_float(truth), albedo, cv::COLOR_BGR2RGB);
  cv::cvtColor(read_float(name + ".normal.tiff"), normal, cv::COLOR_BGR2RGB);
  cv::Mat3f light = color::light_of(io::read_photograph(photograph).pixels, 16, {});
  color::mark_unusable(light, {}, {});
  for (int y = 0; y + kSide <= light.rows; y += kSide)
    for (int x = 0; x + kSide <= light.cols; x += kSide) {
      const cv::Rect part(x, y, kSide, kSide);
      double near = 0, far = 0;
      cv::minMaxLoc(distance(part), &near, &far);
      if (!(near > 0) || far > 1.03 * near || mean_of(normal, part)[2] < 0.866f) continue;
      if (!lit.empty() && mean_of(lit, part)[0] < 0.99f) continue;
      const Patch patch{mean_of(light, part), mean_of(albedo, part), static_cast<float>(far),
                        y * kCellsY / light.rows * kCellsX + x * kCellsX / light.cols};
      const cv::Vec3f& l = patch.light;
      if (std::isfinite(l[0] + l[1] + l[2]) && l[0] > 0 && l[1] > 0 && l[2] > 0)
        patches.push_back(patch);
    }
}

double delta_e(const cv::Vec3f& first, const cv::Vec3f& second) {
  const auto lab = [](const cv::Vec3f& rgb) { return color::lab_of({rgb[0], rgb[1], rgb[2]}); };
  return color::ciede2000(lab(first), lab(second));
}

void use_white(std::vector<Patch>& patches) {
  for (int k = 0; k < 3; ++k) {
    std::vector<float> ratios;
    for (const Patch& patch : patches) ratios.push_back(patch.albedo[k] / patch.light[k]);
    const float gain = upper_median(std::move(ratios));
    for (Patch& patch : patches) patch.light[k] *= gain;
  }
}

// The slope of log(light / albedo) by distance, by the medians of the nearest and of the farthest
// third.
double slope(const std::vector<Patch>& patches, int k) {
  std::vector<Patch> sorted = patches;
  std::ranges::sort(sorted, {}, &Patch::distance);
  const std::size_t third = sorted.size() / 3;
  std::vector<double> near, far, near_at, far_at;
  for (std::size_t i = 0; i < third; ++i) {
    const auto add = [&](const Patch& patch, std::vector<double>& logs, std::vector<double>& at) {
      logs.push_back(std::log(patch.light[k] / std::max(patch.albedo[k], 1e-4f)));
      at.push_back(patch.distance);
    };
    add(sorted[i], near, near_at);
    add(sorted[sorted.size() - 1 - i], far, far_at);
  }
  return (upper_median(far) - upper_median(near)) / (upper_median(far_at) - upper_median(near_at));
}

double position_residual(const std::vector<Patch>& patches) {
  std::array<std::vector<double>, 48> cells;
  for (const Patch& patch : patches)
    cells[static_cast<std::size_t>(patch.cell)].push_back(
        std::log(patch.light.dot({0.2126f, 0.7152f, 0.0722f}) /
                 patch.albedo.dot({0.2126f, 0.7152f, 0.0722f})));
  double squares = 0;
  int count = 0;
  for (const auto& cell : cells) {
    if (cell.size() < 5) continue;
    const double level = upper_median(cell);
    squares += level * level;
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(squares / count);
}

int run(int argc, char** argv) {
  for (int i = 1; i + 1 < argc; i += 2) {
    std::vector<fs::path> truths;
    for (const auto& entry : fs::directory_iterator(argv[i]))
      if (entry.path().string().ends_with(".albedo.tiff")) truths.push_back(entry.path());
    std::ranges::sort(truths);
    std::vector<Patch> patches;
    for (const fs::path& truth : truths)
      add_patches(truth, fs::path(argv[i + 1]) / (truth.stem().stem().string() + ".jpg"), patches);
    if (patches.size() < 30) fail("{}: only {} patches can be compared", argv[i], patches.size());
    use_white(patches);
    std::vector<double> differences, angles;
    for (const Patch& patch : patches) {
      differences.push_back(delta_e(patch.light, patch.albedo));
      const double cosine =
          patch.light.dot(patch.albedo) / (cv::norm(patch.light) * cv::norm(patch.albedo));
      angles.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi);
    }
    std::cout << fmt::format(
        "{{\"delta_e\": {:.3f}, \"angle_degrees\": {:.3f}, \"slopes\": [{:.4f}, {:.4f}, {:.4f}], "
        "\"position\": {:.4f}, \"patches\": {}}}\n",
        upper_median(differences), upper_median(angles), slope(patches, 0), slope(patches, 1),
        slope(patches, 2), position_residual(patches), patches.size());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return check_program(argc, argv, 2, 1000, "color_check TRUTH PHOTOGRAPHS [TRUTH PHOTOGRAPHS ...]",
                       run);
}
