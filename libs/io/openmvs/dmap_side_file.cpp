// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cameras/private/port_json.h"
#include "io/artifacts/artifact.h"
#include "openmvs/private/dmap_parts.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

int read_side(const JsonPlace& place, const char* key) {
  const double value = place.number(key);
  if (!(value >= 1 && value <= 1e6) || value != std::trunc(value))
    fail("{}.{} is {}, expected a number of pixels", place.where, key, value);
  return static_cast<int>(value);
}

refractive::PinholeLens<double> read_lens(const JsonPlace& place) {
  place.require_object({"fx", "fy", "cx", "cy"});
  const refractive::PinholeLens<double> lens{place.number("fx"), place.number("fy"),
                                             place.number("cx"), place.number("cy")};
  if (!(lens.fx > 0 && lens.fy > 0))
    fail("{} has the focal lengths {} and {}", place.where, lens.fx, lens.fy);
  return lens;
}

}  // namespace

std::optional<DmapSideFile> read_dmap_side_file(const fs::path& dmap, const Context& context) {
  const fs::path path = side_file(dmap);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  const nlohmann::json json = read_json(path);
  const JsonPlace root{json, path.string() + ": depth map"};
  root.require_object({"version", "width", "height", "lens", "distortion", "port", "min_depth_m",
                       "max_depth_m", "made_from", "content"});
  root.require_version_1();
  DmapSideFile side;
  side.camera.width = read_side(root, "width");
  side.camera.height = read_side(root, "height");
  side.camera.lens = read_lens(root.at("lens"));
  if (root.has("distortion")) {
    side.camera.distortion = distortion_from_json(root.at("distortion"));
    if (!(distorted_lens<double>(side.camera).field > 0))
      fail("{}.distortion is not a valid lens: it mirrors the image", root.where);
  }
  if (const JsonPlace port = root.at("port"); !port.json.is_null())
    // A water surface is a flat port at a distance that equals the camera's height, which has no
    // limit.
    side.camera.port = port_from_json(port, std::numeric_limits<double>::infinity(), context);
  side.min_depth = static_cast<float>(root.number("min_depth_m"));
  side.max_depth = static_cast<float>(root.number("max_depth_m"));
  if (!std::isfinite(side.min_depth) || !std::isfinite(side.max_depth))
    fail("{} has the depth range {} to {}", root.where, side.min_depth, side.max_depth);
  side.made_from = root.text("made_from");
  side.content = root.text("content");
  return side;
}

void write_dmap_side_file(const fs::path& dmap, const DmapSideFile& side) {
  const auto& lens = side.camera.lens;
  nlohmann::json json{
      {"version", 1},
      {"width", side.camera.width},
      {"height", side.camera.height},
      {"lens", {{"fx", lens.fx}, {"fy", lens.fy}, {"cx", lens.cx}, {"cy", lens.cy}}},
      {"port", nullptr},
      {"min_depth_m", side.min_depth},
      {"max_depth_m", side.max_depth},
      {"made_from", side.made_from},
      {"content", side.content}};
  if (side.camera.port) json["port"] = port_to_json(*side.camera.port);
  if (side.camera.distortion) json["distortion"] = distortion_to_json(*side.camera.distortion);
  write_json(side_file(dmap), json);
}

}  // namespace axial::io
