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
#include "base/log.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/same_file.h"
#include "io/colmap/colmap_export.h"
#include "io/images/image.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

struct Job {
  std::size_t image = 0;
  fs::path name;  // relative to the folder of the outputs
  cv::Size size;
};

cv::Size shrunk(const cv::Size& size, unsigned max_resolution) {
  const double factor =
      static_cast<double>(max_resolution) / static_cast<double>(std::max(size.width, size.height));
  const auto side = [&](int length) { return std::max(1, cvRound(length * factor)); };
  return {side(size.width), side(size.height)};
}

std::vector<Job> jobs_of(const Scene& scene, unsigned max_resolution, const fs::path& folder) {
  const fs::path common = io::common_image_folder(scene);
  std::vector<Job> jobs;
  std::vector<fs::path> photographs, targets;
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const SceneImage& image = scene.images[i];
    photographs.emplace_back(image.path);
    if (!image.calibrated) continue;
    const io::ImageHeader header = io::read_image_header(image.path);
    if (std::cmp_less_equal(std::max(header.size.width, header.size.height), max_resolution))
      continue;
    if (header.alpha) fail("{}: not built yet: it has transparent pixels", image.path);
    fs::path name = fs::path(image.path).lexically_normal().lexically_relative(common);
    if (!(is_jpeg_name(name) && header.bits == 8) && name.extension() != ".png") name += ".png";
    jobs.push_back({i, name, shrunk(header.size, max_resolution)});
    targets.push_back(folder / name);
  }
  require_no_inputs(targets, photographs, "--max-resolution");
  if (std::set(targets.begin(), targets.end()).size() < targets.size())
    fail("--max-resolution: two images would become the same file below {}", folder.string());
  return jobs;
}

void shrink(const Job& job, const std::string& source, const fs::path& target) {
  constexpr int kQuality = 95;
  const cv::Mat pixels = io::read_photograph(source).pixels;
  cv::Mat small;
  cv::resize(pixels, small, job.size, 0, 0, cv::INTER_AREA);
  if (is_jpeg_name(target))
    io::write_jpeg(target, small, kQuality);
  else
    io::write_png(target, small);
}

void write_images(const std::vector<Job>& jobs, const fs::path& folder, const Scene& scene) {
  for (const Job& job : jobs) make_folder((folder / job.name).parent_path());
  FirstError error;
  for_each_in_flight(jobs.size(), thread_count(), [&](std::size_t k) {
    error.run(k, [&] { shrink(jobs[k], scene.images[jobs[k].image].path, folder / jobs[k].name); });
  });
  error.rethrow();
}

}  // namespace

void shrink_images(unsigned max_resolution, const fs::path& folder, Scene& scene) {
  const std::vector<Job> jobs = jobs_of(scene, max_resolution, folder);
  if (!jobs.empty())
    write_folder(folder, [&](const fs::path& staging) { write_images(jobs, staging, scene); });
  for (const Job& job : jobs) {
    SceneImage& image = scene.images[job.image];
    image.path = (folder / job.name).string();
    image.camera = image.camera.resized(job.size.width, job.size.height);
  }
  log_info("{} of {} images were shrunk to at most {} pixels, in {}", jobs.size(),
           scene.images.size(), max_resolution, folder.string());
}

}  // namespace axial::apps
