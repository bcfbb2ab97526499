// SPDX-License-Identifier: GPL-3.0-or-later
#include "contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "base/parallel.h"
#include "base/version.h"
#include "belong/surface_check.h"
#include "depth_maps.h"
#include "folder.h"
#include "geometry/seen_part.h"
#include "io/images/image.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "maps.h"
#include "residuals.h"
#include "restored.h"
#include "run.h"
#include "scene/check_mesh.h"
#include "scene/resolution.h"
#include "survey/photographs.h"
#include "truth.h"
#include "view/camera_data.h"
#include "view/cloud_data.h"
#include "view/cloud_sample.h"
#include "view/first_view.h"
#include "view/mesh_data.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kPartFaces = 500'000;  // keeps a part of a mesh below 32 MB
constexpr int kQuality = 88;                 // of JPEG files
constexpr std::size_t kChecks = 3;           // points of each camera that the viewer projects, too

Json list(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

cv::Size reduced(cv::Size size, int longest) {
  return working_size(size.width, size.height, {0, 1, longest});
}

void read_cloud(const Options& options, Contents& contents, const Context& context) {
  view::CloudSample sample(options.max_points);
  constexpr std::size_t kPortion = 1 << 18;
  io::read_cloud_of_scene_in_portions(
      contents.survey.frame, options.cloud, kPortion,
      [&](const PointCloud& portion, std::size_t all) { sample.add(portion, all); }, context);
  contents.all_points = sample.added();
  contents.cloud = sample.take();
  if (contents.cloud.size() == 0) fail_in(options.cloud, "the cloud has no points");
  log_info("{}: {} of {} points are shown", options.cloud.string(), contents.cloud.size(),
           contents.all_points);
  belong::check_surface(contents.survey.scene, belong::shape_of(contents.cloud),
                        {options.cloud, options.survey.files.scene}, context);
}

const Mesh& mesh_of(const Contents& contents) {
  return contents.textured ? contents.textured->mesh : *contents.mesh;
}

// The vertices of faces, each one once, for a first view without a cloud. Vertices that no face has
// are not shown.
PointCloud corners_of_mesh(const Contents& contents) {
  const Mesh& mesh = mesh_of(contents);
  std::vector<bool> is_corner(mesh.vertices.size());
  for (const auto& face : mesh.faces)
    for (const std::uint32_t vertex : face) is_corner[vertex] = true;
  PointCloud corners;
  for (std::size_t v = 0; v < is_corner.size(); ++v)
    if (is_corner[v]) corners.positions.push_back(mesh.vertices[v]);
  return corners;
}

void read_mesh(const Options& options, Contents& contents, const Context& context) {
  if (options.mesh.empty()) return;
  const LocalFrame& frame = contents.survey.frame;
  std::size_t faces = 0;
  if (io::is_textured_mesh(options.mesh)) {
    contents.textured = io::read_textured_mesh_of_scene(frame, options.mesh, context);
    faces = contents.textured->mesh.faces.size();
  } else {
    contents.mesh = io::read_mesh_of_scene(frame, options.mesh, context);
    faces = contents.mesh->faces.size();
  }
  if (faces == 0) fail_in(options.mesh, "the mesh has no faces");
  log_info("{}: {} faces", options.mesh.string(), faces);
  const Mesh& mesh = mesh_of(contents);
  naming(options.mesh, [&] { check_mesh(mesh); });
  belong::check_surface(contents.survey.scene, belong::shape_of(mesh),
                        {options.mesh, options.survey.files.scene}, context);
}

// Warns if the mesh is inside out.
void check_sides(const Options& options, const Contents& contents, const Context& context) {
  if (!contents.mesh && !contents.textured) return;
  const auto cameras = geometry::posed_cameras(contents.survey.scene);
  const Mesh& mesh = mesh_of(contents);
  naming(options.mesh, [&] {
    geometry::warn_if_inside_out(geometry::find_seen_part(mesh, cameras, {.strays = false}),
                                 options.mesh, context);
  });
}

// The number of the camera of each image; kNoId for an image that is not calibrated.
std::vector<std::uint32_t> camera_numbers(const Scene& scene) {
  std::vector<std::uint32_t> numbers(scene.images.size(), kNoId);
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (scene.images[i].calibrated) numbers[i] = next++;
  return numbers;
}

// A few points of the cloud that each image sees.
std::vector<std::vector<Eigen::Vector3f>> points_to_check(const Contents& contents) {
  const PointCloud& cloud = contents.cloud;
  std::vector<std::vector<Eigen::Vector3f>> points(contents.survey.scene.images.size());
  if (cloud.view_begin.empty()) return points;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (const std::uint32_t image : cloud.views_of(i))
      if (image < points.size() && points[image].size() < kChecks)
        points[image].push_back(cloud.positions[i]);
  return points;
}

Json write_cloud(const Contents& contents, const Options& options, const fs::path& staging) {
  if (options.cloud.empty()) return Json::array();
  const std::vector<std::uint32_t> cameras = camera_numbers(contents.survey.scene);
  const view::PointErrors errors{contents.distances, view::error_step(contents.distances)};
  DataFiles files(staging, "cloud");
  Json chunks = Json::array();
  for (const view::PointChunk& chunk :
       view::divide_into_chunks(contents.cloud, view::kMostChunkPoints)) {
    const view::ChunkData data = naming(
        options.cloud, [&] { return view::chunk_data(contents.cloud, chunk, cameras, errors); });
    chunks.push_back({{"file", files.add(data.bytes)},
                      {"level", chunk.level},
                      {"points", chunk.points.size()},
                      {"low", list(data.low.cast<double>())},
                      {"size", list(data.size.cast<double>())},
                      {"lists", data.lists},
                      {"error_step", errors.step}});
  }
  return chunks;
}

Json write_textures(const TexturedMesh& mesh, int longest, const fs::path& staging) {
  DataFiles files(staging, "texture");
  const fs::path jpeg = staging / "texture.jpg";
  Json textures = Json::array();
  for (const cv::Mat3b& texture : mesh.textures) {
    io::write_jpeg(jpeg, resized_image(texture, reduced(texture.size(), longest)), kQuality);
    textures.push_back({{"file", files.add(read_file(jpeg))}});
    fs::remove(jpeg);
  }
  return textures;
}

Json write_mesh(const Contents& contents, const Options& options, const fs::path& staging) {
  Json mesh{{"textures", Json::array()}, {"parts", Json::array()}};
  std::vector<view::MeshPart> parts;
  if (contents.textured) {
    mesh["textures"] = write_textures(*contents.textured, options.texture_size, staging);
    parts = view::mesh_parts(*contents.textured, kPartFaces);
  } else {
    parts = view::mesh_parts(*contents.mesh, kPartFaces);
  }
  DataFiles files(staging, "mesh");
  for (const view::MeshPart& part : parts)
    mesh["parts"].push_back({{"file", files.add(part.bytes)},
                             {"vertices", part.vertices},
                             {"faces", part.faces},
                             {"texture", part.texture},
                             {"colors", part.colors}});
  return mesh;
}

Json write_cameras(const Contents& contents, const fs::path& staging, const Context& context) {
  const survey::Survey& survey = contents.survey;
  const auto checks = points_to_check(contents);
  Json cameras = Json::array();
  for (const survey::View& view : survey.views)
    cameras.push_back(view::camera_data(survey.scene.images[view.image], checks[view.image]));
  const survey::Photographs photographs(survey);
  for_each_in_flight(survey.views.size(), thread_count(), [&](std::size_t v) {
    const std::string name = fmt::format("photographs/{:05}.jpg", v);
    const cv::Mat3b pixels = photographs.read(v, survey::Channels::color).color;
    io::write_jpeg(staging / name, pixels, kQuality);
    Json& camera = cameras[v];
    camera["name"] = survey.views[v].file.filename().string();
    camera["photo"] = name;
    camera["photo_size"] = {pixels.cols, pixels.rows};
  });
  photographs.report(context);
  return cameras;
}

// Adds the maps, the run, the depth maps and the restored colours to `data`.
void add_survey(const Contents& contents, const Options& options, const fs::path& staging,
                Json& data, const Context& context) {
  if (!options.run.empty()) data["run"] = run_report(options.run);
  if (Json maps = write_maps(options.maps, staging); !maps.is_null()) data["map"] = std::move(maps);
  Json depths = write_depth_maps(contents.survey.scene, options.depth_maps, staging, context);
  if (!depths.empty()) data["depth_maps"] = std::move(depths);
  if (!options.survey.color_folder.empty())
    data["colors"] = restored_colors(contents.survey, staging, context);
}

Json files_of(const Options& options) {
  Json files{{"scene", options.survey.files.scene.filename().string()}};
  if (!options.cloud.empty()) files["cloud"] = options.cloud.filename().string();
  if (!options.mesh.empty()) files["mesh"] = options.mesh.filename().string();
  return files;
}

}  // namespace

Contents read_contents(const Options& options, const Context& context) {
  Contents contents;
  contents.survey = survey::open_scene(options.survey, context);
  survey::find_photographs(contents.survey, context);
  if (!options.cloud.empty()) read_cloud(options, contents, context);
  read_mesh(options, contents, context);
  check_sides(options, contents, context);
  if (!options.truth.empty())
    contents.distances =
        distances_to_truth(contents.survey.frame, contents.cloud, options.truth, context);
  return contents;
}

void write_contents(const Contents& contents, const Options& options, const fs::path& staging,
                    const Context& context) {
  make_folder(staging / "data");
  make_folder(staging / "photographs");
  const survey::Survey& scene = contents.survey;
  const view::FirstView first =
      options.cloud.empty()
          ? view::first_view(corners_of_mesh(contents), scene.scene.images, !scene.frame.is_world())
          : view::first_view(contents.cloud, scene.scene.images, !scene.frame.is_world());
  Json data{{"program", version_line("ViewScene")}, {"files", files_of(options)},
            {"origin", list(scene.frame.origin)},   {"metric", scene.housing.has_value()},
            {"points", contents.cloud.size()},      {"all_points", contents.all_points}};
  data["view"] = {{"centre", list(first.centre)},
                  {"radius", first.radius},
                  {"towards", list(first.towards)},
                  {"up", list(first.up)}};
  add_survey(contents, options, staging, data, context);
  if (!options.sfm_model.empty())
    data["residuals"] = residual_data(scene, options.sfm_model, context);
  if (!contents.distances.empty()) data["truth"] = options.truth.filename().string();
  data["cameras"] = write_cameras(contents, staging, context);
  data["chunks"] = write_cloud(contents, options, staging);
  if (contents.mesh || contents.textured) data["mesh"] = write_mesh(contents, options, staging);
  write_scene_file(staging, data);
}

}  // namespace axial::apps
