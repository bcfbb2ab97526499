// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/masks.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/images/folder_ends.h"
#include "io/images/image.h"

namespace axial::io {

namespace fs = std::filesystem;

namespace {

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

std::string in_words(const std::vector<std::string>& items) {
  std::string words;
  for (std::size_t i = 0; i < items.size(); ++i)
    words += (i == 0 ? "" : i + 1 < items.size() ? ", " : " and ") + items[i];
  return words;
}

struct MaskName {
  std::string name;
  bool of_whole_name;  // includes the image's extension
};

std::vector<MaskName> mask_names(const fs::path& image, bool in_mask_folder) {
  const std::string stem = image.stem().string();
  std::vector<MaskName> names{{stem + ".mask.png", false},
                              {image.filename().string() + ".png", true},
                              {stem + "_mask.png", false}};
  if (in_mask_folder) names.push_back({stem + ".png", false});
  return names;
}

std::string words_of(const std::vector<MaskName>& names) {
  std::vector<std::string> items;
  for (const MaskName& name : names) items.push_back(name.name);
  return in_words(items);
}

// Uses `path` as the mask unless a better candidate was found before.
void add_candidate(const fs::path& path, FoundMask& found) {
  if (found.path.empty())
    found.path = path;
  else
    found.others.push_back(path);
}

// Finds masks in a folder of their own.
class MaskFolder {
 public:
  MaskFolder(const fs::path& folder, const std::unordered_set<std::string>& images)
      : folder_(folder), images_(images) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) fail_in(folder, "is not a folder of masks");
    for (const std::string& image : images) count(image);
  }

  void search(const fs::path& image, FoundMask& found) const {
    const std::vector<MaskName> names = mask_names(image, true);
    std::vector<std::string> folders, shared;
    for (const fs::path& end : ends_.at(image.parent_path().string())) {
      const bool own_stem = stems_.at((end / image.stem()).string()) == 1;
      const bool own_name = names_.at((end / image.filename()).string()) == 1;
      (own_stem ? folders : shared).push_back(place(end).string());
      for (const MaskName& name : names) {
        if (name.of_whole_name ? !own_name : !own_stem) continue;
        const fs::path path = place(end) / name.name;
        if (is_there(path) && !images_.contains(path.string())) add_candidate(path, found);
      }
    }
    if (folders.empty()) folders.push_back(place(image.parent_path().filename()).string());
    found.looked_for = fmt::format("{} in {}", words_of(names), in_words(folders));
    if (!shared.empty())
      found.looked_for += fmt::format(" (not in {}, because several images have the name {} there)",
                                      in_words(shared), image.stem().string());
  }

 private:
  fs::path place(const fs::path& end) const { return end.empty() ? folder_ : folder_ / end; }

  void count(const fs::path& image) {
    const fs::path parent = image.parent_path();
    auto ends = ends_.find(parent.string());
    if (ends == ends_.end())
      ends = ends_.emplace(parent.string(), folder_ends(folder_, parent)).first;
    for (const fs::path& end : ends->second) {
      ++stems_[(end / image.stem()).string()];
      ++names_[(end / image.filename()).string()];
    }
  }

  const fs::path folder_;
  const std::unordered_set<std::string>& images_;
  std::map<std::string, std::vector<fs::path>> ends_;  // by the images' folder
  // The number of images with each end, without and with the extension.
  std::unordered_map<std::string, std::size_t> stems_, names_;
};

void search_beside(const MaskRequest& request, const std::unordered_set<std::string>& images,
                   FoundMask& found) {
  std::vector<fs::path> candidates;
  if (!request.named.empty()) candidates.push_back(request.named);
  const std::vector<MaskName> names = mask_names(request.image, false);
  for (const MaskName& name : names) {
    const fs::path path = request.image.parent_path() / name.name;
    if (path != request.named && !images.contains(path.string())) candidates.push_back(path);
  }
  for (const fs::path& path : candidates)
    if (is_there(path)) add_candidate(path, found);
  const std::string named = request.named.empty() ? "" : request.named.string() + ", and for ";
  found.looked_for =
      fmt::format("{}{} in {}", named, words_of(names), request.image.parent_path().string());
}

void refuse_shared(std::span<const MaskRequest> requests, std::span<const FoundMask> masks) {
  std::unordered_map<std::string, std::size_t> owner;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const fs::path& path = masks[i].path;
    if (path.empty() || path == requests[i].named) continue;
    const auto [other, first] = owner.emplace(path.string(), i);
    if (!first && requests[other->second].image != requests[i].image)
      fail_in(path, "would be the mask of both {} and {}: name the masks {}.png and {}.png",
              requests[other->second].image.string(), requests[i].image.string(),
              requests[other->second].image.filename().string(),
              requests[i].image.filename().string());
  }
}

bool same_labels(const fs::path& a, const fs::path& b) {
  try {
    if (read_file(a) == read_file(b)) return true;
    const cv::Mat1w labels = read_label_image(a), others = read_label_image(b);
    return labels.size() == others.size() && cv::norm(labels, others, cv::NORM_INF) == 0;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::vector<FoundMask> find_masks(std::span<const MaskRequest> requests, const fs::path& folder) {
  std::unordered_set<std::string> images;
  for (const MaskRequest& request : requests) images.insert(request.image.string());
  std::vector<FoundMask> masks(requests.size());
  if (folder.empty()) {
    for (std::size_t i = 0; i < requests.size(); ++i) search_beside(requests[i], images, masks[i]);
  } else {
    const MaskFolder search(folder, images);
    for (std::size_t i = 0; i < requests.size(); ++i) search.search(requests[i].image, masks[i]);
  }
  refuse_shared(requests, masks);
  return masks;
}

fs::path mask_beside(const fs::path& image) {
  return image.parent_path() / (image.stem().string() + ".mask.png");
}

IgnoredMasks ignored_masks(std::span<const FoundMask> masks) {
  IgnoredMasks ignored;
  for (const FoundMask& mask : masks) {
    const auto other = std::ranges::find_if(
        mask.others, [&](const fs::path& path) { return !same_labels(mask.path, path); });
    if (other == mask.others.end() || ignored.count++ > 0) continue;
    ignored.used = mask.path;
    ignored.other = *other;
  }
  return ignored;
}

}  // namespace axial::io
