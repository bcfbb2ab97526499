// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/masks.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "io/images/masks.h"

namespace axial::survey {
namespace {

std::size_t masks_of_scene(const Scene& scene) {
  return static_cast<std::size_t>(std::ranges::count_if(scene.images, [](const SceneImage& image) {
    return image.calibrated && !image.mask_path.empty();
  }));
}

void tell_of_unused(const Survey& survey, const Context& context) {
  const Options& options = survey.options;
  if (!options.mask_folder.empty())
    context.warning("{} {}: is not used, because {} is {}", setting("mask_folder"),
                    options.mask_folder.string(), setting("ignore_mask_label"),
                    options.ignore_mask_label);
  else if (const std::size_t named = masks_of_scene(survey.scene))
    context.info("{}: contains masks of {} images, which are used only with {}",
                 survey.file().string(), named, setting("ignore_mask_label"));
}

void warn_of_ignored_masks(const Survey& survey, const std::vector<io::FoundMask>& masks,
                           const Context& context) {
  const std::filesystem::path& folder = survey.options.mask_folder;
  const std::size_t named = folder.empty() ? 0 : masks_of_scene(survey.scene);
  if (named > 0)
    context.warning("{} {}: is used instead of the masks that {} names for {} images",
                    setting("mask_folder"), folder.string(), survey.file().string(), named);
  const io::IgnoredMasks ignored = io::ignored_masks(masks);
  if (ignored.count > 0)
    context.warning("{}: is used; {} differs and is ignored ({} images have two different masks)",
                    ignored.used.string(), ignored.other.string(), ignored.count);
}

}  // namespace

void choose_masks(Survey& survey, const Context& context) {
  const Options& options = survey.options;
  if (!options.has_masks) return;
  if (options.ignore_mask_label < 0) return tell_of_unused(survey, context);
  std::vector<io::MaskRequest> requests;
  for (const View& view : survey.views)
    requests.push_back({view.file, survey.scene.images[view.image].mask_path});
  const std::vector<io::FoundMask> masks = io::find_masks(requests, options.mask_folder);
  for (std::size_t v = 0; v < masks.size(); ++v) {
    survey.views[v].mask = masks[v].path;
    if (!masks[v].path.empty()) continue;
    const std::string photograph = survey.views[v].file.string();
    if (!options.mask_folder.empty())
      fail("{} {}: no mask for image {}: looked for {}", setting("mask_folder"),
           options.mask_folder.string(), photograph, masks[v].looked_for);
    context.warning("{}: no mask: looked for {}", photograph, masks[v].looked_for);
  }
  warn_of_ignored_masks(survey, masks, context);
}

void LabelCheck::add(const cv::Mat1w& labels) {
  if (seen_) return;
  std::bitset<65536> present;
  for (const std::uint16_t label : labels) present.set(label);
  if (label_ <= 65535 && present[static_cast<std::size_t>(label_)]) seen_ = true;
  const std::lock_guard lock(mutex_);
  others_ |= present;
}

void LabelCheck::warn_if_absent(std::span<const View> views, const Context& context) const {
  if (seen_ || others_.none()) return;
  constexpr std::size_t kMost = 10;
  std::string labels;
  std::size_t listed = 0;
  for (std::size_t label = 0; label < others_.size() && listed < kMost; ++label)
    if (others_[label]) labels += (listed++ > 0 ? ", " : "") + std::to_string(label);
  if (others_.count() > kMost) labels += fmt::format(" and {} more", others_.count() - kMost);
  const auto first =
      std::ranges::find_if(views, [](const View& view) { return !view.mask.empty(); });
  context.warning("{} {}: no mask has this label; {} and the other masks have {}",
                  setting("ignore_mask_label"), label_, first->mask.string(), labels);
}

}  // namespace axial::survey
