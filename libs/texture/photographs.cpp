// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/photographs.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <unordered_map>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "io/images/bit_depth.h"
#include "io/images/image.h"
#include "io/images/masks.h"
#include "io/images/photograph_size.h"
#include "texture/black_border.h"

namespace axial::texture {
namespace {

namespace fs = std::filesystem;

// The images by the words that name them in a views file: the ID, the path, and the name of the
// file with and without extension.
class ImageWords {
 public:
  explicit ImageWords(const Scene& scene) {
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
      const SceneImage& image = scene.images[i];
      const fs::path path = image.path;
      ids_[image.id == kNoId ? static_cast<std::uint32_t>(i) : image.id].push_back(i);
      for (const fs::path& name : {path, path.filename(), path.stem()})
        names_[name.string()].push_back(i);
    }
  }

  std::set<std::size_t> named_by(const std::string& word) const {
    std::set<std::size_t> found;
    if (const auto named = names_.find(word); named != names_.end())
      found.insert(named->second.begin(), named->second.end());
    const auto id = parse_number<std::uint32_t>(word);
    if (const auto with_id = id ? ids_.find(*id) : ids_.end(); with_id != ids_.end())
      found.insert(with_id->second.begin(), with_id->second.end());
    return found;
  }

 private:
  std::unordered_map<std::string, std::vector<std::size_t>> names_;
  std::unordered_map<std::uint32_t, std::vector<std::size_t>> ids_;
};

std::set<std::size_t> images_in(const fs::path& file, const Scene& scene) {
  std::set<std::size_t> images;
  const ImageWords words(scene);
  const std::string text = read_file(file, 1 << 24);
  std::size_t number = 0;
  for (std::string_view line : split(text, '\n')) {
    ++number;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    const std::set<std::size_t> named = words.named_by(std::string(line));
    if (named.empty())
      fail("{}: line {}: no image has the ID or the name {}", file.string(), number, line);
    images.insert(named.begin(), named.end());
  }
  return images;
}

void leave_out(const cv::Mat1b& mask, cv::Mat1b& usable) {
  if (mask.empty()) return;
  if (usable.empty())
    usable = mask;
  else
    cv::bitwise_and(mask, usable, usable);
}

// Resampling mixes colours of transparent pixels into pixels at their edge: leaves these out, too.
cv::Mat1b opaque_at(const cv::Mat1b& opaque, cv::Size size) {
  if (opaque.empty()) return {};
  cv::Mat1b resized;
  cv::resize(opaque, resized, size, 0, 0, cv::INTER_AREA);
  cv::compare(resized, 255, resized, cv::CMP_EQ);
  return resized;
}

}  // namespace

Photographs::Photographs(const Scene& scene, const fs::path& scene_file,
                         const PhotographOptions& options)
    : choice_(options.masks),
      label_(options.mask_label),
      check_(std::make_unique<belong::PhotographCheck>(scene, scene_file)) {
  std::vector<io::PhotographSize> sizes;
  std::set<std::size_t> wanted;
  if (!options.views_file.empty()) wanted = images_in(options.views_file, scene);
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const SceneImage& image = scene.images[i];
    if (!image.calibrated || (!options.views_file.empty() && !wanted.contains(i))) continue;
    const io::ImageHeader& header = headers_.emplace_back(io::read_image_header(image.path));
    sizes.push_back({image.path, header.size, {image.camera.width, image.camera.height}});
    const cv::Size size = working_size(header.size.width, header.size.height, options.resolution);
    images_.push_back(i);
    files_.emplace_back(image.path);
    views_.push_back({image.camera.resized(size.width, size.height), image.pose});
  }
  if (views_.empty()) fail("{}: has no calibrated image to use", scene_file.string());
  io::check_photograph_sizes(sizes);
  bit_depth_ =
      io::common_bit_depth(files_, headers_, options.bit_depth, options.name_of("bit_depth"));
  masks_.resize(views_.size());
  if (choice_ == MaskChoice::label) find_masks(scene, options);
}

void Photographs::find_masks(const Scene& scene, const PhotographOptions& options) {
  std::vector<io::MaskRequest> requests;
  for (std::size_t v = 0; v < views_.size(); ++v)
    requests.push_back({files_[v], scene.images[images_[v]].mask_path});
  const std::vector<io::FoundMask> found = io::find_masks(requests, options.mask_folder);
  for (std::size_t v = 0; v < views_.size(); ++v) {
    masks_[v] = found[v].path;
    if (!masks_[v].empty()) continue;
    if (!options.mask_folder.empty())
      fail("{} {}: no mask for image {}: looked for {}", options.name_of("mask_folder"),
           options.mask_folder.string(), files_[v].string(), found[v].looked_for);
    log_warning("{}: no mask: looked for {}", files_[v].string(), found[v].looked_for);
  }
}

std::vector<fs::path> Photographs::files() const {
  std::vector<fs::path> all = files_;
  all.insert(all.end(), masks_.begin(), masks_.end());
  return all;
}

std::uint64_t Photographs::bytes_to_load() const {
  std::uint64_t largest = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const io::ImageHeader& header = headers_[v];
    const auto stored = static_cast<std::uint64_t>(header.size.width) *
                        static_cast<std::uint64_t>(header.size.height);
    const auto used = static_cast<std::uint64_t>(views_[v].camera.width) *
                      static_cast<std::uint64_t>(views_[v].camera.height);
    // While the photograph is decoded and converted to 8 bits; while its black border is found, or
    // while its labels are decoded and resized.
    const std::uint64_t decoded = io::bytes_needed(header) + (header.bits > 8 ? 3 * stored : 0);
    const std::uint64_t marked = 4 * used + (masks_[v].empty() ? 0 : 6 * stored);
    largest = std::max(largest, 4 * used + std::max(decoded, marked));
  }
  return largest;
}

ViewImage Photographs::load(std::size_t view) const {
  const CameraModel& camera = views_[view].camera;
  const cv::Size size(camera.width, camera.height);
  io::Photograph photograph = io::read_photograph(files_[view]);
  const cv::Size stored = photograph.pixels.size();
  ViewImage result;
  result.color = resized_image(io::in_8_bits(photograph.pixels, bit_depth_), size);
  photograph.pixels.release();
  check_->take(images_[view], result.color);
  leave_out(opaque_at(photograph.opaque, size), result.usable);
  if (choice_ == MaskChoice::black_border)
    leave_out(outside_black_border(result.color), result.usable);
  if (masks_[view].empty()) return result;
  const cv::Mat1w labels = io::read_label_image(masks_[view]);
  io::check_mask_shape(masks_[view], labels.size(), stored);
  cv::Mat1b mask;
  cv::compare(resized_labels(labels, size), label_, mask, cv::CMP_NE);
  leave_out(mask, result.usable);
  return result;
}

}  // namespace axial::texture
