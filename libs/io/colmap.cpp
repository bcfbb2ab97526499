// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap.h"

#include <unordered_map>
#include <unordered_set>

#include "base/error.h"
#include "io/calibmar.h"
#include "io/colmap_parts.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// One part of a model by the reader of the form it is stored in.
template <class T>
std::vector<T> read_part(const fs::path& folder, const std::string& name,
                         std::vector<T> (*text)(const fs::path&),
                         std::vector<T> (*binary)(const fs::path&)) {
  if (is_file(folder / (name + ".txt"))) return text(folder / (name + ".txt"));
  if (is_file(folder / (name + ".bin"))) return binary(folder / (name + ".bin"));
  fail("{}: has neither {}.txt nor {}.bin", folder.string(), name, name);
}

template <class T>
void require_unique_ids(const std::vector<T>& items, const char* what, const std::string& model) {
  std::unordered_set<std::uint64_t> seen;
  for (const T& item : items)
    if (!seen.insert(item.id).second) fail("{}: {} {} occurs twice", model, what, item.id);
}

void check_references(const ColmapModel& model, const std::string& where) {
  std::unordered_set<std::uint32_t> cameras;
  for (const ColmapCamera& camera : model.cameras) cameras.insert(camera.id);
  std::unordered_set<std::uint64_t> points;
  for (const ColmapPoint3D& point : model.points) points.insert(point.id);
  std::unordered_map<std::uint32_t, std::size_t> observations;
  for (const ColmapImage& image : model.images) {
    if (!cameras.contains(image.camera))
      fail("{}: image {} ({}) refers to camera {}, which does not exist", where, image.id,
           image.name, image.camera);
    for (const ColmapPoint2D& point : image.points)
      if (point.point3d != kNoPoint3D && !points.contains(point.point3d))
        fail("{}: image {} ({}) refers to 3D point {}, which does not exist", where, image.id,
             image.name, point.point3d);
    observations[image.id] = image.points.size();
  }
  for (const ColmapPoint3D& point : model.points)
    for (const ColmapTrackElement& element : point.track) {
      const auto found = observations.find(element.image);
      if (found == observations.end())
        fail("{}: 3D point {} refers to image {}, which does not exist", where, point.id,
             element.image);
      if (element.point2d >= found->second)
        fail("{}: 3D point {} refers to 2D point {} of image {}, which has {}", where, point.id,
             element.point2d, element.image, found->second);
    }
}

}  // namespace

fs::path find_colmap_model(const fs::path& folder) {
  const std::array<fs::path, 3> places{folder / "sparse", folder / "sparse" / "0", folder};
  for (const fs::path& place : places)
    if (is_file(place / "cameras.txt") || is_file(place / "cameras.bin")) return place;
  fail("{}: no COLMAP model: no cameras.txt or cameras.bin in {}, {} or {}", folder.string(),
       places[0].string(), places[1].string(), places[2].string());
}

ColmapModel read_colmap_model(const fs::path& folder) {
  ColmapModel model;
  model.cameras = read_part(folder, "cameras", read_cameras_text, read_cameras_binary);
  model.images = read_part(folder, "images", read_images_text, read_images_binary);
  model.points = read_part(folder, "points3D", read_points_text, read_points_binary);
  const std::string where = folder.string();
  require_unique_ids(model.cameras, "camera", where);
  require_unique_ids(model.images, "image", where);
  require_unique_ids(model.points, "3D point", where);
  check_references(model, where);
  return model;
}

std::vector<ColmapCamera> read_colmap_cameras(const fs::path& path) {
  if (is_calibmar(path)) return {read_calibmar(path)};
  std::vector<ColmapCamera> cameras;
  std::error_code error;
  if (fs::is_directory(path, error))
    cameras = read_part(path, "cameras", read_cameras_text, read_cameras_binary);
  else
    cameras = path.extension() == ".bin" ? read_cameras_binary(path) : read_cameras_text(path);
  require_unique_ids(cameras, "camera", path.string());
  return cameras;
}

}  // namespace axial::io
