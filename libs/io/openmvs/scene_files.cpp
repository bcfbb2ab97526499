// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/scene_files.h"

#include <fmt/format.h>

#include "base/program/output_name.h"
#include "io/cameras/geo_offset.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// Whether two paths lead to one place, which need not exist.
bool is_one_place(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return a.filename() == b.filename() && (a.parent_path() == b.parent_path() ||
                                          fs::equivalent(a.parent_path(), b.parent_path(), error));
}

bool names_scene(const fs::path& given, const fs::path& scene) {
  const std::string extension = known_extension(given);
  return (extension.empty() || extension == ".mvs") &&
         is_one_place(without_known_extension(given), without_known_extension(scene));
}

}  // namespace

fs::path cloud_beside(const fs::path& scene) {
  return with_extension(scene, ".ply");
}

std::string depth_map_name(std::uint32_t id) {
  return fmt::format("depth{:04}.dmap", id);
}

std::vector<fs::path> files_of_scene(const SceneFiles& files) {
  return {files.scene,
          cloud_beside(files.scene),
          housing_file(files),
          housing_beside(files.scene),
          lenses_beside(files.scene),
          geo_offset_beside(files.scene)};
}

std::vector<fs::path> files_of_scene(const SceneFiles& files, const Scene& scene) {
  std::vector<fs::path> all = files_of_scene(files);
  for (const SceneImage& image : scene.images) {
    all.insert(all.end(), {image.path, image.mask_path});
    for (const fs::path& folder : {files.working_folder, files.scene.parent_path()}) {
      const fs::path map = folder / depth_map_name(image.id);
      all.insert(all.end(), {map, map.string() + ".json"});
    }
  }
  return all;
}

fs::path mesh_beside(const fs::path& scene, const fs::path& given, const std::string& ending,
                     bool is_ply, const Context& context) {
  const fs::path own = without_known_extension(scene) += ending;
  if (given.empty()) return own;
  if (!is_ply || !names_scene(given, scene)) return without_known_extension(given);
  context.info("{}: is the name of the scene, whose cloud is kept: the mesh is written to {}.ply",
               given.string(), own.string());
  return own;
}

}  // namespace axial::io
