// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/openmvs/image_folders.h"

#include "base/log.h"

namespace axial::io {
namespace fs = std::filesystem;

namespace {

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) && !error;
}

// The part of an absolute and normal path below a folder; empty: it is not below the folder.
fs::path part_below(const fs::path& folder, const fs::path& path) {
  const fs::path part = path.lexically_relative(folder);
  return part.empty() || *part.begin() == ".." || *part.begin() == "." ? fs::path() : part;
}

}  // namespace

ImageFolders::ImageFolders(const fs::path& working_folder, const fs::path& scene)
    : working_folder_(working_folder), scene_(scene) {
  fs::path folder = fs::absolute(scene).lexically_normal().parent_path();
  for (; !folder.empty(); folder = folder.parent_path()) {
    others_.push_back(folder);
    if (folder == folder.parent_path()) break;
  }
}

std::string ImageFolders::find(const fs::path& name) {
  const fs::path usual = (working_folder_ / name).lexically_normal();
  const fs::path part = name.is_absolute() ? part_below(working_folder_, usual) : name;
  if (part.empty()) return usual.string();
  if (is_file(usual)) {
    const fs::path beside = (others_.front() / part).lexically_normal();
    std::error_code error;
    if (!is_warned_ && is_file(beside) && !fs::equivalent(usual, beside, error) && !error) {
      log_warning("{}: {} is used, although {} exists, too", scene_.string(), usual.string(),
                  beside.string());
      is_warned_ = true;
    }
    return usual.string();
  }
  for (const fs::path& folder : others_) {
    const fs::path found = (folder / part).lexically_normal();
    if (!is_file(found)) continue;
    if (!is_told_)
      log_info("{}: the paths of its images start at {}", scene_.string(), folder.string());
    is_told_ = true;
    found_in_ = folder;
    return found.string();
  }
  return found_in_.empty() ? usual.string() : (found_in_ / part).lexically_normal().string();
}

}  // namespace axial::io
