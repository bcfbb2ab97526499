// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/masks.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "io/images/masks.h"

namespace axial::densify {

namespace {

std::size_t masks_of_scene(const Scene& scene) {
  return static_cast<std::size_t>(std::ranges::count_if(scene.images, [](const SceneImage& image) {
    return image.calibrated && !image.mask_path.empty();
  }));
}

void tell_of_unused(const Project& project, const Settings& settings) {
  if (!settings.mask_folder.empty())
    log_warning("{} {}: is not used, because {} is {}", settings.name_of("mask_folder"),
                settings.mask_folder.string(), settings.name_of("ignore_mask_label"),
                settings.ignore_mask_label);
  else if (const std::size_t named = masks_of_scene(project.scene))
    log_info("{}: contains masks of {} images, which are used only with {}",
             settings.input.string(), named, settings.name_of("ignore_mask_label"));
}

void warn_of_ignored_masks(const Project& project, const Settings& settings,
                           const std::vector<io::FoundMask>& masks) {
  const std::size_t named = settings.mask_folder.empty() ? 0 : masks_of_scene(project.scene);
  if (named > 0)
    log_warning("{} {}: is used instead of the masks that {} names for {} images",
                settings.name_of("mask_folder"), settings.mask_folder.string(),
                settings.input.string(), named);
  const io::IgnoredMasks ignored = io::ignored_masks(masks);
  if (ignored.count > 0)
    log_warning("{}: is used; {} differs and is ignored ({} images have two different masks)",
                ignored.used.string(), ignored.other.string(), ignored.count);
}

}  // namespace

void choose_masks(Project& project, const Settings& settings) {
  if (settings.ignore_mask_label < 0) return tell_of_unused(project, settings);
  std::vector<std::size_t> images;
  std::vector<io::MaskRequest> requests;
  for (std::size_t i = 0; i < project.views.size(); ++i) {
    const SceneImage& image = project.scene.images[i];
    if (!image.calibrated) continue;
    images.push_back(i);
    requests.push_back({image.path, image.mask_path});
  }
  const auto masks = io::find_masks(requests, settings.mask_folder);
  for (std::size_t k = 0; k < images.size(); ++k) {
    project.views[images[k]].mask = masks[k].path;
    if (!masks[k].path.empty()) continue;
    if (!settings.mask_folder.empty())
      fail("{} {}: no mask for image {}: looked for {}", settings.name_of("mask_folder"),
           settings.mask_folder.string(), requests[k].image.string(), masks[k].looked_for);
    log_warning("{}: no mask: looked for {}", requests[k].image.string(), masks[k].looked_for);
  }
  warn_of_ignored_masks(project, settings, masks);
}

void LabelCheck::add(const cv::Mat1w& labels) {
  if (seen_) return;
  std::bitset<65536> present;
  for (const std::uint16_t label : labels) present.set(label);
  if (label_ <= 65535 && present[static_cast<std::size_t>(label_)]) seen_ = true;
  const std::lock_guard lock(mutex_);
  others_ |= present;
}

void LabelCheck::warn_if_absent(const Project& project) const {
  if (seen_ || others_.none()) return;
  constexpr std::size_t kMost = 10;
  std::string labels;
  std::size_t listed = 0;
  for (std::size_t label = 0; label < others_.size() && listed < kMost; ++label)
    if (others_[label]) labels += (listed++ > 0 ? ", " : "") + std::to_string(label);
  if (others_.count() > kMost) labels += fmt::format(" and {} more", others_.count() - kMost);
  const auto first =
      std::ranges::find_if(project.views, [](const View& view) { return !view.mask.empty(); });
  log_warning("{} {}: no mask has this label; {} and the other masks have {}", setting_, label_,
              first->mask.string(), labels);
}

}  // namespace axial::densify
