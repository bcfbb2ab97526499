// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/parallel.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "io/openmvs/scene_files.h"
#include "scene/resolution.h"
#include "view/color_scale.h"
#include "view/map_pictures.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kDepthQuality = 80;                        // of JPEG files
constexpr std::uint64_t kBytesInFlight = 2'000'000'000;  // of the maps that are read at a time

fs::path map_of(const SceneImage& image, const fs::path& folder) {
  return folder / io::depth_map_name(image.id);
}

void check_photograph(const DepthMap& map, const SceneImage& image, const fs::path& file) {
  const std::string of_map = fs::path(map.image_path).filename().string();
  const std::string of_scene = fs::path(image.path).filename().string();
  if (!of_map.empty() && of_map != of_scene)
    fail_in(file, "is the depth map of {}, but image {} of the scene is {}", of_map, image.id,
            of_scene);
}

// `values` where the map has a depth, and NaN elsewhere.
cv::Mat1f where_known(const cv::Mat1f& values, const cv::Mat1f& depth) {
  cv::Mat1f result = values.clone();
  result.setTo(std::numeric_limits<float>::quiet_NaN(), depth <= 0);
  return result;
}

class DepthPictures {
 public:
  // `stem`: of the files, relative to `staging`.
  DepthPictures(fs::path staging, std::string stem, cv::Size size)
      : staging_(std::move(staging)), stem_(std::move(stem)), size_(size) {}

  Json values(const char* kind, const cv::Mat1f& all, std::span<const cv::Vec3b> colors) const {
    const cv::Mat1f reduced = view::reduced_values(all, size_);
    const auto [low, high] = view::quantiles(reduced, 0.01, 0.99);
    const view::ColorScale scale = view::scale_of(colors, low, high);
    Json entry = write(kind, view::painted(reduced, scale));
    entry["low"] = low;
    entry["high"] = high;
    for (const cv::Vec3b& color : colors) entry["colors"].push_back(view::css_color(color));
    return entry;
  }

  Json normals(const cv::Mat3f& all) const {
    return write("normal", view::normal_picture(all, size_));
  }

 private:
  Json write(const char* kind, const cv::Mat3b& picture) const {
    const std::string name = fmt::format("{}.{}.jpg", stem_, kind);
    io::write_jpeg(staging_ / name, picture, kDepthQuality);
    return {{"file", name}};
  }

  fs::path staging_;
  std::string stem_;
  cv::Size size_;
};

// `number`: of the camera on the page.
Json write_depth_map(const SceneImage& image, std::size_t number, const DepthMapOptions& options,
                     const fs::path& staging, const Context& context) {
  const fs::path file = map_of(image, options.folder);
  const DepthMap map = io::read_dmap(file, io::DmapSide::used, context).map;
  check_photograph(map, image, file);
  const cv::Size size = working_size(map.width(), map.height(), {0, 1, options.longest_side});
  const DepthPictures pictures(staging, fmt::format("depth/{:05}", number), size);
  Json entry;
  entry["depth"] =
      pictures.values("depth", where_known(map.depth, map.depth), view::violet_to_yellow());
  if (cv::norm(map.normal, cv::NORM_INF) > 0) entry["normal"] = pictures.normals(map.normal);
  if (!map.confidence.empty())
    entry["confidence"] = pictures.values("confidence", where_known(map.confidence, map.depth),
                                          view::dark_to_green());
  return entry;
}

// How many maps may be read at the same time.
std::size_t maps_at_once(const std::vector<const SceneImage*>& images) {
  std::uint64_t pixels = 1;
  for (const SceneImage* image : images)
    pixels = std::max(pixels, static_cast<std::uint64_t>(image->camera.width) *
                                  static_cast<std::uint64_t>(image->camera.height));
  // The map, what reading it needs, and two copies of its values.
  const std::uint64_t each = bytes_of_map(pixels) + io::dmap_bytes_needed(pixels) + 8 * pixels;
  return std::clamp<std::size_t>(kBytesInFlight / each, 1, thread_count());
}

}  // namespace

Json write_depth_maps(const Scene& scene, const DepthMapOptions& options, const fs::path& staging,
                      const Context& context) {
  std::vector<const SceneImage*> images;
  for (const SceneImage& image : scene.images)
    if (image.calibrated) images.push_back(&image);
  const auto has_map = [&](const SceneImage* image) {
    return image->id != kNoId && fs::exists(map_of(*image, options.folder));
  };
  if (options.longest_side == 0) return Json::array();
  if (std::ranges::none_of(images, has_map)) {
    if (options.is_given)
      fail("--depth-maps {}: has no depth map of the scene's photographs, such as {}",
           options.folder.string(), map_of(*images.front(), {}).string());
    return Json::array();
  }
  make_folder(staging / "depth");
  std::vector<Json> entries(images.size());
  for_each_in_flight(images.size(), maps_at_once(images), [&](std::size_t i) {
    if (!has_map(images[i])) return;
    try {
      entries[i] = write_depth_map(*images[i], i, options, staging, context);
    } catch (const Error& error) {
      if (options.is_given) throw;
      log_warning("a depth map is left out: {}", error.text());
    }
  });
  return entries;
}

}  // namespace axial::apps
