// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_scaling.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "base/first_error.h"
#include "base/parallel.h"
#include "base/same_file.h"
#include "io/colmap/colmap_export.h"
#include "io/images/image.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

cv::Size shrunk(const cv::Size& size, unsigned max_resolution) {
  const double factor =
      static_cast<double>(max_resolution) / static_cast<double>(std::max(size.width, size.height));
  const auto side = [&](int length) { return std::max(1, cvRound(length * factor)); };
  return {side(size.width), side(size.height)};
}

// The size and the path of the smaller image in the scene.
void replace_by(const SmallImage& small, const fs::path& folder, SceneImage& image) {
  image.path = (folder / small.name).string();
  image.camera = image.camera.resized(small.size.width, small.size.height);
}

void shrink(const SmallImage& image, const fs::path& target) {
  constexpr int kQuality = 95;
  const cv::Mat pixels = io::read_photograph(image.source).pixels;
  cv::Mat small;
  cv::resize(pixels, small, image.size, 0, 0, cv::INTER_AREA);
  if (is_jpeg_name(target))
    io::write_jpeg(target, small, kQuality);
  else
    io::write_png(target, small);
}

}  // namespace

std::vector<SmallImage> find_large_images(unsigned max_resolution, const fs::path& folder,
                                          Scene& scene) {
  const fs::path common = io::common_image_folder(scene);
  std::vector<SmallImage> found;
  std::vector<std::size_t> large;
  std::vector<fs::path> photographs, targets;
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const SceneImage& image = scene.images[i];
    photographs.emplace_back(image.path);
    if (!image.calibrated) continue;
    const io::ImageHeader header = io::read_image_header(image.path);
    if (std::cmp_less_equal(std::max(header.size.width, header.size.height), max_resolution))
      continue;
    if (header.alpha) fail_in(image.path, "not built yet: it has transparent pixels");
    fs::path name = fs::path(image.path).lexically_normal().lexically_relative(common);
    if (!(is_jpeg_name(name) && header.bits == 8) && name.extension() != ".png") name += ".png";
    found.push_back({image.path, name, shrunk(header.size, max_resolution)});
    large.push_back(i);
    targets.push_back(folder / name);
  }
  require_no_inputs(targets, photographs, "--max-resolution");
  if (std::set(targets.begin(), targets.end()).size() < targets.size())
    fail("--max-resolution: two images would become the same file below {}", folder.string());
  for (std::size_t k = 0; k < found.size(); ++k)
    replace_by(found[k], folder, scene.images[large[k]]);
  return found;
}

void write_small_images(const std::vector<SmallImage>& images, const fs::path& folder) {
  if (images.empty()) return;
  write_folder(folder, [&](const fs::path& staging) {
    for (const SmallImage& image : images) make_folder((staging / image.name).parent_path());
    FirstError error;
    for_each_in_flight(images.size(), thread_count(), [&](std::size_t k) {
      error.run(k, [&] { shrink(images[k], staging / images[k].name); });
    });
    error.rethrow();
  });
}

}  // namespace axial::apps
