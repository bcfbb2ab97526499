// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_scene.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "base/error.h"
#include "base/first_error.h"
#include "base/parallel.h"
#include "base/same_file.h"
#include "cameras/private/image_names.h"
#include "colmap/private/colmap_undistort.h"
#include "io/colmap/colmap_lens.h"
#include "io/images/image.h"
#include "io/images/masks.h"
#include "scene/camera_model.h"

namespace axial::io {

namespace fs = std::filesystem;

namespace {

// The scene's camera for one camera of the model.
struct ImportedCamera {
  CameraModel camera;
  bool resampled = false;  // its images are undistorted
};

// Keeps the distorted lens. Warns if it does not cover its whole image.
void keep_lens(const ColmapCamera& from, const refractive::LensDistortion<double>& distortion,
               const fs::path& model_folder, CameraModel& camera, const Context& context) {
  camera.distortion = distortion;
  const auto lens = distorted_lens<double>(camera);
  if (!(lens.field > 0))
    fail_in(model_folder, "camera {}: the distortion of its {} lens mirrors the image", from.id,
            from.model);
  if (!lens.shows_all(camera.width, camera.height))
    context.warning(
        "{}: camera {} ({}): its camera model is not defined up to the corners of the image; "
        "pixels outside its range are not matched",
        model_folder.string(), from.id, from.model);
}

ImportedCamera import_camera(const ColmapCamera& camera, const ColmapImport& import,
                             const Context& context) {
  const fs::path& model_folder = import.model_folder;
  constexpr std::uint64_t kLargest = 1u << 16;
  if (camera.width == 0 || camera.height == 0 || camera.width > kLargest ||
      camera.height > kLargest)
    fail_in(model_folder, "camera {}: size {} x {} is out of range", camera.id, camera.width,
            camera.height);
  ImportedCamera imported;
  imported.camera.width = static_cast<int>(camera.width);
  imported.camera.height = static_cast<int>(camera.height);
  const lens::Lens in_air = lens_of(camera);
  const auto lens = pinhole_lens(in_air);
  const auto distortion = lens_distortion(in_air);
  const bool resampled = !lens && (import.undistort || !distortion);
  if (!lens && !import.undistort && !distortion)
    context.info(
        "camera {} ({}): images are undistorted, because this camera model cannot be matched "
        "directly",
        camera.id, camera.model);
  if (lens) imported.camera.lens = *lens;
  if (resampled) imported.camera.lens = pinhole_inside(camera, model_folder.string());
  if (!lens && !resampled) imported.camera.lens = in_air.pinhole;
  if (const auto& l = imported.camera.lens; !(l.fx > 0 && l.fy > 0))
    fail_in(model_folder, "camera {}: focal length ({}, {}) is not positive", camera.id, l.fx,
            l.fy);
  imported.resampled = resampled;
  if (!lens && !resampled) keep_lens(camera, *distortion, model_folder, imported.camera, context);
  return imported;
}

std::map<std::uint32_t, ImportedCamera> import_cameras(const ColmapModel& model,
                                                       const ColmapImport& import,
                                                       const ProgressSink& progress,
                                                       const Context& context) {
  std::set<std::uint32_t> used;
  for (const ColmapImage& image : model.images) used.insert(image.camera);
  std::map<std::uint32_t, ImportedCamera> imported;
  for (const ColmapCamera& camera : model.cameras) {
    if (!used.contains(camera.id)) continue;
    imported.emplace(camera.id, import_camera(camera, import, context));
    if (progress) progress(imported.size(), used.size());
  }
  return imported;
}

// Checks the size of the image. Returns true if a JPEG can hold its pixels.
bool check_image(const fs::path& path, const CameraModel& camera) {
  const ImageHeader header = read_image_header(path);
  const cv::Size size = header.size;
  if (size.width != camera.width || size.height != camera.height)
    fail_in(path, "image is {} x {}, but its camera is {} x {}", size.width, size.height,
            camera.width, camera.height);
  return header.bits == 8 && !header.alpha;
}

// Checks the mask of an image that needs to be undistorted. The image has the size of `camera`.
void check_mask(const fs::path& mask, const CameraModel& camera) {
  if (!mask.empty()) check_mask_shape(mask, read_image_size(mask), {camera.width, camera.height});
}

// The masks of the images that need to be undistorted; empty for other images.
std::vector<fs::path> masks_to_undistort(const Scene& scene, const std::vector<bool>& resampled,
                                         const Context& context) {
  std::vector<MaskRequest> requests;
  for (const SceneImage& image : scene.images) requests.push_back({image.path, {}});
  const std::vector<FoundMask> found = find_masks(requests);
  const IgnoredMasks ignored = ignored_masks(found);
  if (ignored.count > 0)
    context.warning("{}: is used; {} differs and is ignored ({} images have two different masks)",
                    ignored.used.string(), ignored.other.string(), ignored.count);
  std::vector<fs::path> masks(found.size());
  for (std::size_t i = 0; i < masks.size(); ++i)
    if (resampled[i]) masks[i] = found[i].path;
  return masks;
}

// The names come from a file. No name may lead out of the output folder or to a photograph, and no
// two names may lead to one file. `distorted`: the images to undistort.
void check_undistorted_names(const ColmapModel& model, std::span<const DistortedImage> distorted,
                             const ColmapImport& import) {
  std::error_code error;
  if (fs::equivalent(import.image_folder, import.undistorted_folder, error))
    fail_in(import.undistorted_folder, "contains the images to undistort and would be overwritten");
  for (const ColmapImage& image : model.images) {
    const fs::path name = image.name;
    if (name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end())
      fail_in(import.model_folder, "image {}: name '{}' is not in the image folder", image.id,
              image.name);
  }
  require_apart(distorted, import.model_folder);
  std::vector<fs::path> photographs, undistorted;
  for (const DistortedImage& image : distorted)
    undistorted.push_back(import.undistorted_folder / undistorted_name(image));
  for (const ColmapImage& image : model.images)
    photographs.push_back(import.image_folder / image.name);
  require_no_inputs(undistorted, photographs, "The undistorted image");
}

// Undistorts the images that are `resampled` and sets their new paths in the scene. `masks` and
// `fits_jpeg` have one element for every image of the model.
void undistort(const ColmapModel& model, const ColmapImport& import,
               const std::vector<bool>& resampled, std::span<const fs::path> masks,
               std::span<const char> fits_jpeg, const ProgressSink& progress, Scene& scene) {
  std::unordered_map<std::uint32_t, const ColmapCamera*> camera_of;
  for (const ColmapCamera& camera : model.cameras) camera_of.emplace(camera.id, &camera);
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < model.images.size(); ++i)
    if (resampled[i]) indices.push_back(i);
  std::ranges::stable_sort(indices, {}, [&](std::size_t i) { return model.images[i].camera; });
  std::vector<DistortedImage> distorted;
  for (const std::size_t i : indices)
    distorted.push_back({model.images[i].name, scene.images[i].path, masks[i],
                         camera_of.at(model.images[i].camera), scene.images[i].camera.lens,
                         fits_jpeg[i] != 0});
  check_undistorted_names(model, distorted, import);
  undistort_images(distorted, import.undistorted_folder, progress);
  for (std::size_t k = 0; k < indices.size(); ++k)
    scene.images[indices[k]].path =
        (import.undistorted_folder / undistorted_name(distorted[k])).string();
}

void import_points(const ColmapModel& model, const ColmapImport& import, Scene& scene,
                   const Context& context) {
  std::unordered_map<std::uint32_t, std::uint32_t> index_of;
  for (std::size_t i = 0; i < model.images.size(); ++i)
    index_of.emplace(model.images[i].id, static_cast<std::uint32_t>(i));
  std::size_t repetitions = 0;
  scene.points.reserve(model.points.size());
  scene.point_colors.reserve(model.points.size());
  for (const ColmapPoint3D& point : model.points) {
    SparsePoint sparse;
    sparse.views.reserve(point.track.size());
    sparse.position = point.position.cast<float>();
    for (const ColmapTrackElement& element : point.track)
      sparse.views.push_back({index_of.at(element.image), 0.0f});
    std::ranges::sort(sparse.views, {}, &SparseView::image);
    // Not std::ranges::unique, whose result clang 14 cannot compile.
    const auto repeated =
        std::unique(sparse.views.begin(), sparse.views.end(),
                    [](const SparseView& a, const SparseView& b) { return a.image == b.image; });
    repetitions += static_cast<std::size_t>(sparse.views.end() - repeated);
    sparse.views.erase(repeated, sparse.views.end());
    scene.points.push_back(std::move(sparse));
    scene.point_colors.push_back(point.color);
  }
  if (repetitions > 0)
    context.info(
        "{}: {} observations are ignored, because another observation in the same image belongs to "
        "the same point",
        import.model_folder.string(), repetitions);
}

// The name of `image` in the scene's housing. `path` is its path in the scene.
std::string scene_name(const ColmapImage& image, const fs::path& path, const ColmapImport& import) {
  const bool undistorted = path != (import.image_folder / image.name).lexically_normal();
  const fs::path name =
      undistorted ? path.lexically_relative(import.undistorted_folder) : fs::path(image.name);
  return name.lexically_normal().generic_string();
}

// Readers find an entry by the end of a path. Checks that they will find the right port for every
// image.
void check_ports(const Housing& resolved, const Scene& scene,
                 const std::vector<std::string>& ports) {
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const std::string path = fs::path(scene.images[i].path).generic_string();
    const auto entry = resolved.entry_of(path);
    const std::string& read =
        entry == resolved.images.end() ? resolved.default_port : entry->second;
    if (read != ports[i])
      fail_in(path,
              "its port is '{}', but the end of its path matches an image with port '{}': rename a "
              "folder",
              ports[i], read);
  }
}

}  // namespace

std::vector<fs::path> remove_missing_images(ColmapModel& model, const fs::path& image_folder) {
  std::vector<fs::path> missing;
  std::set<std::uint32_t> ids;
  for (const ColmapImage& image : model.images) {
    std::error_code error;
    const fs::path file = (image_folder / image.name).lexically_normal();
    if (fs::exists(file, error)) continue;
    missing.push_back(file);
    ids.insert(image.id);
  }
  if (missing.empty()) return missing;
  std::erase_if(model.images, [&](const ColmapImage& image) { return ids.contains(image.id); });
  for (ColmapPoint3D& point : model.points)
    std::erase_if(point.track,
                  [&](const ColmapTrackElement& element) { return ids.contains(element.image); });
  std::set<std::uint64_t> points;
  for (const ColmapPoint3D& point : model.points)
    if (point.track.size() >= 2) points.insert(point.id);
  std::erase_if(model.points,
                [&](const ColmapPoint3D& point) { return !points.contains(point.id); });
  for (ColmapImage& image : model.images)
    for (ColmapPoint2D& point : image.points)
      if (!points.contains(point.point3d)) point.point3d = kNoPoint3D;
  return missing;
}

Scene import_colmap_scene(const ColmapModel& model, const ColmapImport& import,
                          const ProgressSink& undistorting, const ProgressSink& preparing_cameras,
                          const ProgressSink& checking_images, const Context& context) {
  if (model.images.size() < 2)
    fail_in(import.model_folder, "the model has {} registered images, at least 2 are needed",
            model.images.size());
  const auto cameras = import_cameras(model, import, preparing_cameras, context);
  const bool from_zero = std::any_of(model.images.begin(), model.images.end(),
                                     [](const ColmapImage& image) { return image.id == 0; });

  Scene scene;
  for (const ColmapImage& image : model.images) {
    SceneImage imported;
    imported.path = (import.image_folder / image.name).lexically_normal().string();
    imported.id = from_zero ? image.id : image.id - 1;
    imported.camera = cameras.at(image.camera).camera;
    imported.pose = image.pose;
    scene.images.push_back(std::move(imported));
  }

  // Everything is checked before the first file is written.
  std::vector<bool> resampled;
  for (const ColmapImage& image : model.images)
    resampled.push_back(cameras.at(image.camera).resampled);
  const bool all_straight = std::ranges::count(resampled, true) == 0;
  const std::vector<fs::path> masks = all_straight ? std::vector<fs::path>(resampled.size())
                                                   : masks_to_undistort(scene, resampled, context);
  FirstError error;
  std::vector<char> fits_jpeg(scene.images.size());
  ProgressCounter checked(checking_images, scene.images.size());
  parallel_for(scene.images.size(), [&](std::size_t i) {
    const SceneImage& image = scene.images[i];
    error.run(i, [&] {
      fits_jpeg[i] = check_image(image.path, image.camera);
      check_mask(masks[i], image.camera);
    });
    checked.add();
  });
  error.rethrow();
  if (!all_straight) undistort(model, import, resampled, masks, fits_jpeg, undistorting, scene);
  import_points(model, import, scene, context);
  return scene;
}

Housing housing_of(std::span<const ColmapCamera> cameras) {
  Housing housing;
  for (const ColmapCamera& camera : cameras) {
    if (!camera.port) continue;
    const std::string name = fmt::format("camera_{}", camera.id);
    housing.ports[name] = to_housing_port(*camera.port);
    housing.cameras[camera.id] = name;
  }
  return housing;
}

Housing read_housing(const fs::path& path, const ColmapModel& model, const Context& context) {
  std::vector<NamedCamera> images;
  for (const ColmapImage& image : model.images) images.push_back({image.name, image.camera});
  return for_images(read_housing(path, PortValues::checked, context), images, path.string());
}

Housing housing_by_image(const Housing& housing, const ColmapModel& model, const Scene& scene,
                         const ColmapImport& import) {
  Housing resolved;
  resolved.ports = housing.ports;
  resolved.sigmas = housing.sigmas;
  resolved.default_port = housing.default_port;
  std::vector<std::string> names, paths, ports;
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const ColmapImage& image = model.images[i];
    names.push_back(scene_name(image, scene.images[i].path, import));
    paths.push_back(fs::path(scene.images[i].path).generic_string());
    ports.push_back(housing.port_of(image.name, image.camera));
  }
  resolved.images = entries_for(names, paths, ports, housing.default_port);
  check_ports(resolved, scene, ports);
  return resolved;
}

std::vector<std::string> unused_entries(const Housing& housing, const ColmapModel& model) {
  std::set<std::string> names;
  std::set<std::uint32_t> cameras;
  for (const ColmapImage& image : model.images) {
    cameras.insert(image.camera);
    const auto entry = housing.entry_of(image.name);
    if (entry != housing.images.end()) names.insert(entry->first);
  }
  std::vector<std::string> unused;
  for (const auto& [name, port] : housing.images)
    if (!names.contains(name)) unused.push_back("images." + name);
  for (const auto& [id, port] : housing.cameras)
    if (!cameras.contains(id)) unused.push_back("cameras." + std::to_string(id));
  return unused;
}

}  // namespace axial::io
