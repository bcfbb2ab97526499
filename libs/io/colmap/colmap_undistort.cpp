// SPDX-License-Identifier: GPL-3.0-or-later
#include "colmap/private/colmap_undistort.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/first_error.h"
#include "base/parallel.h"
#include "io/colmap/colmap_lens.h"
#include "io/images/image.h"
#include "io/images/masks.h"
#include "scene/resolution.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// The maps for cv::remap. A map stays in memory from the first to the last image of its camera.
class UndistortionMaps {
 public:
  explicit UndistortionMaps(std::span<const DistortedImage> images) {
    for (const DistortedImage& image : images) ++entries_[image.camera->id].images_left;
  }

  // Call once for each image; thread-safe.
  cv::Mat2f take(const DistortedImage& image) {
    Entry& entry = entries_.at(image.camera->id);
    const std::scoped_lock lock(entry.mutex);
    if (entry.map.empty()) entry.map = undistortion_map(lens_of(*image.camera), image.pinhole);
    cv::Mat2f map = entry.map;
    if (--entry.images_left == 0) entry.map.release();
    return map;
  }

 private:
  struct Entry {
    std::size_t images_left = 0;
    std::mutex mutex{};
    cv::Mat2f map{};
  };
  std::map<std::uint32_t, Entry> entries_;
};

// Undistorts `mask`, unless it is empty, and writes it beside `target`. Labels are not
// interpolated.
void undistort_mask(const fs::path& mask, const fs::path& target, const cv::Mat2f& map) {
  if (mask.empty()) return;
  const cv::Mat1w distorted = resized_labels(read_label_image(mask), map.size());
  cv::Mat1w straight;
  cv::remap(distorted, straight, map, cv::noArray(), cv::INTER_NEAREST, cv::BORDER_REPLICATE);
  write_png(mask_beside(target), straight);
}

// Resamples a photograph with `map`: B G R in its own depth, and alpha if some pixels are
// transparent. The colour of a transparent pixel does not influence opaque pixels.
cv::Mat resampled(const Photograph& photograph, const cv::Mat2f& map) {
  cv::Mat straight;
  cv::remap(photograph.pixels, straight, map, cv::noArray(), cv::INTER_LANCZOS4,
            cv::BORDER_REPLICATE);
  if (straight.depth() == CV_16U) {
    // Interpolation can overshoot. The values must not need more bits than the camera has.
    cv::Mat values = straight.reshape(1);
    cv::min(values, (1 << bits_used(photograph.pixels)) - 1, values);
  }
  if (photograph.opaque.empty()) return straight;
  cv::Mat alpha;
  cv::remap(photograph.opaque, alpha, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::erode(alpha == 255, alpha, cv::Mat1b::ones(7, 7));  // the reach of the 8 x 8 kernel
  alpha.convertTo(alpha, straight.depth(), straight.depth() == CV_16U ? 257 : 1);
  std::vector<cv::Mat> channels;
  cv::split(straight, channels);
  channels.push_back(alpha);
  cv::merge(channels, straight);
  return straight;
}

// Writes the undistorted image to `target`, and its mask beside it.
void undistort(const DistortedImage& image, const cv::Mat2f& map, const fs::path& target) {
  const cv::Mat straight = resampled(read_photograph(image.source), map);
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  if (error) fail_in(target.parent_path(), "cannot be made: {}", error.message());
  constexpr int kQuality = 98;  // high, because the image is compressed a second time
  if (is_jpeg_name(target))
    write_jpeg(target, straight, kQuality);
  else
    write_png(target, straight);
  undistort_mask(image.mask, target, map);
}

}  // namespace

fs::path undistorted_name(const DistortedImage& image) {
  fs::path undistorted = fs::path(image.name).lexically_normal();
  const bool jpeg = image.fits_jpeg && is_jpeg_name(undistorted);
  if (!jpeg && undistorted.extension() != ".png") undistorted += ".png";
  return undistorted;
}

void require_apart(std::span<const DistortedImage> images, const fs::path& model_folder) {
  std::map<std::string, const std::string*> taken;
  for (const DistortedImage& image : images) {
    const std::string undistorted = undistorted_name(image).generic_string();
    const auto [other, added] = taken.try_emplace(lower_case(undistorted), &image.name);
    if (!added)
      fail_in(model_folder,
              "the images {} and {} would both be undistorted to {}: rename one image",
              *other->second, image.name, undistorted);
  }
}

void undistort_images(std::span<const DistortedImage> images, const fs::path& folder,
                      const ProgressSink& progress) {
  UndistortionMaps maps(images);
  FirstError error;
  std::mutex mutex;
  std::size_t done = 0;
  for_each_in_flight(images.size(), thread_count(), [&](std::size_t i) {
    const DistortedImage& image = images[i];
    error.run(i, [&] { undistort(image, maps.take(image), folder / undistorted_name(image)); });
    const std::scoped_lock lock(mutex);
    if (progress) progress(++done, images.size());
  });
  error.rethrow();
}

}  // namespace axial::io
