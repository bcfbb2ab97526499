// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/pinhole_folder.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "io/artifacts/written_files.h"
#include "io/bytes/json.h"
#include "io/colmap/colmap_export.h"
#include "io/images/masks.h"

namespace axial::densify {
namespace fs = std::filesystem;

fs::path exported_name(const SceneImage& image, const fs::path& photographs) {
  fs::path name = fs::path(image.path).lexically_normal().lexically_relative(photographs);
  if (!is_jpeg_name(name) && name.extension() != ".png") name += ".png";
  return name;
}

namespace {

void check_names(const Project& project) {
  const fs::path photographs = io::common_image_folder(project.scene);
  std::map<fs::path, const std::string*> taken;
  for (const std::size_t image : project.references) {
    const std::string& path = project.scene.images[image].path;
    const fs::path name = exported_name(project.scene.images[image], photographs);
    for (const fs::path& file : {name, io::mask_beside(name)})
      if (const auto [other, added] = taken.try_emplace(file, &path); !added)
        fail("{}: {} and {} would both be exported as images/{}", setting("pinhole_export"),
             *other->second, path, file.string());
  }
}

void check_folder(const Project& project, const fs::path& folder) {
  const std::string name = setting("pinhole_export");
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error))
    fail("{} {}: is a file, not a folder", name, folder.string());
  // The folders that contain inputs, at any depth.
  std::set<fs::path> inputs;
  const auto add = [&](fs::path above) {
    for (; inputs.insert(above).second && above.has_relative_path(); above = above.parent_path()) {
    }
  };
  add(project.file().parent_path());
  add(project.options.files.working_folder);
  for (const SceneImage& image : project.scene.images) add(fs::path(image.path).parent_path());
  for (const View& view : project.views)
    if (!view.colors.empty()) add(view.colors.parent_path());
  for (const fs::path& input : inputs)
    if (fs::equivalent(folder, input, error))
      fail("{} {}: contains inputs of this run", name, folder.string());
  if (fs::exists(folder / kPinholeMarker, error)) {
    if (!io::read_json(folder / kPinholeMarker).is_object())
      fail_in(folder / kPinholeMarker, "is not the list of an earlier export");
  } else if (!fs::is_empty(folder, error))
    fail("{} {}: contains other files: give an empty or a new folder", name, folder.string());
}

// Trainers of splats write files into the folder of their data, and take them again the next time.
void warn_of_files_of_trainers(const fs::path& folder, const fs::path& staging,
                               const Context& context) {
  std::vector<fs::path> kept;
  std::error_code error;
  for (fs::recursive_directory_iterator i(folder / kPinholeModel, error), end; !error && i != end;
       i.increment(error)) {
    const fs::path& file = i->path();
    if (!i->is_directory() && !fs::exists(staging / file.lexically_relative(folder)))
      kept.push_back(file);
  }
  if (kept.empty()) return;
  context.warning(
      "{}: is not of this export and is kept, as are {} other files: a trainer may take them for "
      "its own. Give a new folder, or delete {} first",
      std::ranges::min(kept).string(), kept.size() - 1, (folder / kPinholeModel).string());
}

}  // namespace

void remove_earlier_export(const fs::path& folder, const fs::path& staging,
                           const Context& context) {
  std::error_code error;
  const fs::path marker = folder / kPinholeMarker;
  if (!fs::exists(marker, error)) return;
  const nlohmann::json earlier = io::read_json(marker);
  if (!earlier.contains("files"))
    context.warning("{}: lists no files: files that this export does not replace are kept",
                    marker.string());
  io::WrittenFiles files =
      io::find_written(folder, earlier.value("files", nlohmann::json::object()));
  const auto replaced = [&](const fs::path& file) { return fs::exists(staging / file, error); };
  std::erase_if(files.unchanged, replaced);
  std::erase_if(files.changed, replaced);
  io::remove_below(folder, files.unchanged);
  if (!files.changed.empty())
    context.warning("{}: was changed after the earlier export and is kept, as are {} other files",
                    (folder / files.changed.front()).string(), files.changed.size() - 1);
  warn_of_files_of_trainers(folder, staging, context);
}

void check_pinhole_export(const Project& project, const fs::path& folder) {
  if (all_pinholes(project))
    fail(
        "{} {}: no image of {} has a port or a distorted lens: OpenMVS can use the other "
        "results of this run directly",
        setting("pinhole_export"), folder.string(), project.file().string());
  check_folder(project, folder);
  check_names(project);
  require_writable_folder(folder);
}

}  // namespace axial::densify
