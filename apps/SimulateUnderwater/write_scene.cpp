// SPDX-License-Identifier: GPL-3.0-or-later
#include "write_scene.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/bytes/json.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "io/images/image.h"
#include "io/ply/ply.h"

namespace axial::apps {
namespace {

io::ColmapImage colmap_image(const simulate::Preset& preset, std::size_t i) {
  const simulate::View& view = preset.views[i];
  io::ColmapImage image;
  image.id = static_cast<std::uint32_t>(i + 1);
  image.camera = static_cast<std::uint32_t>(view.camera + 1);
  image.name = view_name(preset, i) + ".jpg";
  image.pose = {view.rotation, view.centre};
  return image;
}

constexpr double kColmapCentre = 0.5;  // of COLMAP's first pixel; the simulator's is 0

io::ColmapCamera colmap_camera(const simulate::Lens& lens, std::uint32_t id) {
  io::ColmapCamera camera;
  camera.id = id;
  camera.model = !lens.bend ? "PINHOLE" : lens.bend->fisheye ? "OPENCV_FISHEYE" : "OPENCV";
  camera.width = static_cast<std::uint64_t>(lens.width);
  camera.height = static_cast<std::uint64_t>(lens.height);
  camera.params = {lens.focal, lens.focal, lens.cx + kColmapCentre, lens.cy + kColmapCentre};
  if (lens.bend)
    camera.params.insert(camera.params.end(), lens.bend->k.begin(), lens.bend->k.end());
  return camera;
}

Rgb to_rgb(const Eigen::Vector3f& color) {
  const auto byte = [](float c) {
    return static_cast<std::uint8_t>(std::clamp(255.0f * c, 0.0f, 255.0f) + 0.5f);
  };
  return {byte(color.x()), byte(color.y()), byte(color.z())};
}

io::HousingPort housing_port(const simulate::Port& port) {
  if (port.dome)
    return refractive::DomePort<double>{port.dome->centre, port.dome->inner_radius,
                                        port.thickness,    port.n_air,
                                        port.n_glass,      port.n_water};
  return refractive::FlatPort<double>{port.normal, port.distance, port.thickness,
                                      port.n_air,  port.n_glass,  port.n_water};
}

}  // namespace

std::string view_name(const simulate::Preset& preset, std::size_t view) {
  if (!preset.second_port) return fmt::format("{:04}", view);
  return fmt::format("{}/{:04}", preset.views[view].camera == 1 ? "right" : "left",
                     view % (preset.views.size() / 2));
}

void write_sparse_model(const std::filesystem::path& folder, const simulate::Preset& preset,
                        std::span<const simulate::SparsePoint> points) {
  io::ColmapModel model;
  model.cameras.push_back(colmap_camera(preset.lens, 1));
  if (preset.second_port) model.cameras.push_back(colmap_camera(preset.lens, 2));
  for (std::size_t i = 0; i < preset.views.size(); ++i)
    model.images.push_back(colmap_image(preset, i));
  for (const simulate::SparsePoint& from : points) {
    io::ColmapPoint3D point;
    point.id = model.points.size() + 1;
    point.position = from.position;
    point.color = to_rgb(from.color);
    for (const simulate::Observation& seen : from.observations) {
      io::ColmapImage& image = model.images[seen.view];
      point.track.push_back({image.id, static_cast<std::uint32_t>(image.points.size())});
      image.points.push_back(
          {seen.pixel.x() + kColmapCentre, seen.pixel.y() + kColmapCentre, point.id});
    }
    model.points.push_back(std::move(point));
  }
  write_folder(
      folder, [&](const std::filesystem::path& staging) { io::write_colmap_text(staging, model); });
}

void write_port(const std::filesystem::path& file, const simulate::Preset& preset) {
  const simulate::Port& port = preset.port;
  io::Housing housing = io::housing_with(housing_port(port));
  if (preset.water_level)
    housing = io::housing_with(
        WaterSurface{{0, 0, -1}, {0, 0, *preset.water_level}, port.n_air, port.n_water});
  if (preset.second_port) {
    housing = {};
    housing.ports = {{"left", housing_port(port)}, {"right", housing_port(*preset.second_port)}};
    housing.cameras = {{1, "left"}, {2, "right"}};
  }
  io::write_housing(file, housing);
}

void write_change(const std::filesystem::path& file, const simulate::Preset& preset,
                  const simulate::ChangeTruth& change) {
  const auto part = [](const simulate::ChangedPart& of) {
    return nlohmann::json{
        {"volume", of.volume}, {"area", of.area}, {"x", of.place.x()}, {"y", of.place.y()}};
  };
  nlohmann::json json{{"boulder_gone", part(change.gone)},
                      {"boulder_came", part(change.came)},
                      {"patch_came", part(change.patch)}};
  const simulate::Growth& growth = preset.terrain.growth;
  json["patch_came"]["width"] = 2 * growth.half.x();
  json["patch_came"]["length"] = 2 * growth.half.y();
  json["patch_came"]["height"] = preset.terrain.relief * growth.height;
  json["came"] = change.came.volume + change.patch.volume;
  json["gone"] = change.gone.volume;
  json["net"] = change.came.volume + change.patch.volume - change.gone.volume;
  io::write_json(file, json);
}

void write_mesh(const std::filesystem::path& file, const simulate::TriangleMesh& mesh) {
  const Mesh plain{mesh.vertices, {}, mesh.faces};
  if (mesh.thickness.empty())
    io::write_mesh_ply(file, plain);
  else
    io::write_mesh_ply(file, plain, io::VertexProperty{"thickness", mesh.thickness});
}

void write_truth(const std::filesystem::path& folder, const std::string& name,
                 const simulate::Truth& truth) {
  io::write_float_tiff(folder / (name + ".distance.tiff"), truth.distance);
  io::write_float_tiff(folder / (name + ".normal.tiff"), truth.normal);
}

}  // namespace axial::apps
