// SPDX-License-Identifier: GPL-3.0-or-later
#include "openmvs/private/image_folders.h"

#include <algorithm>
#include <span>

namespace axial::io {
namespace fs = std::filesystem;

namespace {

using Paths = std::vector<fs::path>;

bool is_on_disk(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) && !error;
}

// The part of an absolute and normal path below a folder; empty: it is not below the folder.
fs::path part_below(const fs::path& folder, const fs::path& path) {
  const fs::path part = path.lexically_relative(folder);
  return part.empty() || *part.begin() == ".." || *part.begin() == "." ? fs::path() : part;
}

// The part of a name that starts at a folder; empty: the name is empty or names a place of its own.
fs::path relative_part(const fs::path& name, const fs::path& working_folder) {
  if (!name.is_absolute()) return name;
  const fs::path file = name.lexically_normal();
  return is_on_disk(file) ? fs::path() : part_below(working_folder, file);
}

fs::path file_in(const fs::path& folder, const fs::path& part) {
  return (folder / part).lexically_normal();
}

Paths candidates_of(const fs::path& working_folder, const fs::path& scene_folder) {
  Paths folders{working_folder};
  fs::path folder = scene_folder;
  for (int above = 0; above <= kFoldersAboveScene && !folder.empty(); ++above) {
    if (std::ranges::find(folders, folder) == folders.end()) folders.push_back(folder);
    if (folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  return folders;
}

// The first folder that has the most files; the first folder if none has any.
fs::path fullest(std::span<const fs::path> folders, std::span<const fs::path> parts) {
  fs::path best = folders.front();
  std::ptrdiff_t most = 0;
  for (const fs::path& folder : folders) {
    const auto count = std::ranges::count_if(
        parts, [&](const fs::path& part) { return is_on_disk(file_in(folder, part)); });
    if (count > most) best = folder;
    most = std::max(most, count);
    if (most == std::ssize(parts)) break;
  }
  return best;
}

// Warns of the first file that `others` have, too, and that is not the same file.
void warn_of_others(const fs::path& scene, const fs::path& folder, std::span<const fs::path> others,
                    std::span<const fs::path> parts, const Context& context) {
  for (const fs::path& part : parts)
    for (const fs::path& other_folder : others) {
      const fs::path used = file_in(folder, part), other = file_in(other_folder, part);
      std::error_code error;
      if (used == other || !is_on_disk(other) || !is_on_disk(used)) continue;
      if (fs::equivalent(used, other, error) || error) continue;
      return context.warning("{}: {} is used, although {} exists, too", scene.string(),
                             used.string(), other.string());
    }
}

}  // namespace

std::vector<std::string> find_files_of_scene(const fs::path& working_folder, const fs::path& scene,
                                             const std::vector<std::string>& names,
                                             std::string_view what, const Context& context) {
  Paths part_of, parts;
  for (const std::string& name : names) {
    part_of.push_back(relative_part(name, working_folder));
    if (!part_of.back().empty()) parts.push_back(part_of.back());
  }
  const fs::path scene_folder = fs::absolute(scene).lexically_normal().parent_path();
  const fs::path folder = fullest(candidates_of(working_folder, scene_folder), parts);
  if (folder != working_folder)
    context.info("{}: the paths of its {} start at {}", scene.string(), what, folder.string());
  warn_of_others(scene, folder, Paths{working_folder, scene_folder}, parts, context);
  std::vector<std::string> files;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const fs::path file =
        part_of[i].empty() ? fs::path(names[i]).lexically_normal() : file_in(folder, part_of[i]);
    files.push_back(file.string());
  }
  return files;
}

}  // namespace axial::io
