// SPDX-License-Identifier: GPL-3.0-or-later
#include "plates.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/error.h"
#include "io/bytes/json.h"
#include "targets/codes/pattern.h"
#include "write_scene.h"

namespace axial::apps {
namespace {

using nlohmann::json;

json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

json pixel_json(const Eigen::Vector2d& pixel) {
  constexpr double kColmapCentre = 0.5;  // of COLMAP's first pixel; the simulator's is 0
  return {pixel.x() + kColmapCentre, pixel.y() + kColmapCentre};
}

// The centre of the area inside a closed line.
Eigen::Vector2d centre_of_area(const std::vector<Eigen::Vector2d>& line) {
  double twice = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d a = line[i] - line[0], b = line[(i + 1) % line.size()] - line[0];
    const double area = a.x() * b.y() - a.y() * b.x();
    twice += area;
    sum += area * (a + b) / 3;
  }
  return line[0] + sum / twice;
}

// Adds what can be measured in a photograph: "dot", the centre of the area of a ring's dot, or
// "corners", those of a square's black border.
void add_outline(json& image, const simulate::Plate& plate, const targets::Family& family,
                 const simulate::Lens& lens, const simulate::Port* port,
                 const simulate::View& view) {
  const targets::Pattern pattern(family, targets::numbers_of(family).first);
  std::vector<Eigen::Vector2d> outline;
  if (family.kind == targets::Kind::ring) {
    constexpr int kPoints = 180;
    for (int i = 0; i < kPoints; ++i)
      outline.push_back(Eigen::Rotation2Dd(2 * std::numbers::pi * i / kPoints) *
                        Eigen::Vector2d(1 / pattern.half_plate(), 0));
  } else {
    const double half = pattern.half_marker() / pattern.half_plate();
    outline = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  }
  const auto pixels = simulate::pixels_of(plate, outline, lens, port, view);
  if (!pixels) return;
  if (family.kind == targets::Kind::ring) {
    image["dot"] = pixel_json(centre_of_area(*pixels));
  } else {
    for (const Eigen::Vector2d& corner : *pixels) image["corners"].push_back(pixel_json(corner));
  }
}

// The images of all plates in one medium, by the names of the photographs.
json images_json(const PlatesOnGround& plates, const simulate::RayScene& scene,
                 const simulate::Preset& preset, bool water) {
  json images = json::object();
  for (std::size_t i = 0; i < preset.views.size(); ++i) {
    json& image = images[view_name(preset, i) + ".jpg"] = json::array();
    const simulate::Port port = port_of_view(preset, preset.views[i]);
    for (std::size_t k = 0; k < plates.plates.size(); ++k) {
      const simulate::Port* in_front = water ? &port : nullptr;
      const auto seen =
          simulate::image_of(plates.plates[k], scene, preset.lens, in_front, preset.views[i]);
      if (!seen) continue;
      const json centre = pixel_json(seen->centre);
      image.push_back({{"label", plates.labels[k]},
                       {"x", centre[0]},
                       {"y", centre[1]},
                       {"width", seen->width},
                       {"oblique_degrees", seen->oblique / simulate::kRadians}});
      add_outline(image.back(), plates.plates[k], plates.family, preset.lens, in_front,
                  preset.views[i]);
    }
  }
  return images;
}

}  // namespace

PlatesOnGround plates_on(const simulate::TriangleMesh& ground, const simulate::Preset& preset,
                         const Arguments& a) {
  PlatesOnGround result{{}, {}, a.bars, {}};
  const auto single = static_cast<std::size_t>(a.targets);
  const std::size_t count = single + 2 * a.bars.size();
  if (count == 0) return result;
  const targets::Family& family = result.family = targets::parse_family(a.target_family);
  const targets::Numbers numbers = targets::numbers_of(family);
  if (numbers.first + count > numbers.last + 1)
    fail("--targets {} and {} bars need {} targets, but {} has {}", a.targets, a.bars.size(), count,
         family.name, numbers.last + 1 - numbers.first);
  const simulate::RayScene scene(ground);
  // The second camera of a rig does not move the plates.
  std::vector<simulate::View> views = preset.views;
  std::erase_if(views, [](const simulate::View& view) { return view.camera == 1; });
  result.plates = simulate::lay_plates(scene, preset.lens, views,
                                       {single, a.bars, a.target_side, a.preset.seed});
  for (std::size_t i = 0; i < count; ++i) {
    const targets::Pattern pattern(family, numbers.first + i);
    result.labels.push_back(targets::label_of(family, numbers.first + i));
    result.plates[i].white = [pattern](double x, double y) {
      return pattern.white(x * pattern.half_plate(), y * pattern.half_plate());
    };
  }
  return result;
}

void write_true_targets(const std::filesystem::path& folder, const PlatesOnGround& plates,
                        const simulate::RayScene& scene, const simulate::Preset& preset,
                        const std::string& medium) {
  json file = {{"plates", json::array()}, {"bars", json::array()}, {"images", json::object()}};
  for (std::size_t i = 0; i < plates.plates.size(); ++i) {
    const simulate::Plate& plate = plates.plates[i];
    file["plates"].push_back({{"label", plates.labels[i]},
                              {"centre", vector_json(plate.centre)},
                              {"normal", vector_json(-plate.axes.col(2))},
                              {"side", plate.side}});
  }
  const std::size_t first = plates.plates.size() - 2 * plates.bars.size();
  for (std::size_t i = 0; i < plates.bars.size(); ++i)
    file["bars"].push_back({{"a", plates.labels[first + 2 * i]},
                            {"b", plates.labels[first + 2 * i + 1]},
                            {"length", plates.bars[i]}});
  if (medium != "water") file["images"]["air"] = images_json(plates, scene, preset, false);
  if (medium != "air") file["images"]["water"] = images_json(plates, scene, preset, true);
  io::write_json(folder / "true_targets.json", file);
}

}  // namespace axial::apps
