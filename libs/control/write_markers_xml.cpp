// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <sstream>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "control/labels.h"
#include "control/write_control.h"
#include "private/coordinate_system.h"

namespace axial::control {
namespace {

namespace fs = std::filesystem;

// Identifiers of texts, in the order of their first use.
class Identifiers {
 public:
  // `key` decides which texts are equal.
  void add(const std::string& key, const std::string& label) {
    if (ids_.emplace(key, labels_.size()).second) labels_.push_back(label);
  }
  std::size_t of(const std::string& key) const { return ids_.at(key); }
  const std::vector<std::string>& labels() const { return labels_; }

 private:
  std::map<std::string, std::size_t> ids_;
  std::vector<std::string> labels_;
};

Identifiers markers_of(const Control& control) {
  Identifiers markers;
  const auto add = [&](const std::string& label) { markers.add(label_key(label), label); };
  for (const ControlPoint& point : control.points) add(point.label);
  for (const TargetImage& image : control.images) add(image.label);
  for (const Bar& bar : control.bars) add(bar.first), add(bar.second);
  return markers;
}

void set(pugi::xml_node& node, const char* name, const std::string& value, const fs::path& file) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
  if (std::ranges::any_of(value, is_control))
    fail_in(file, "cannot be written: '{}' contains a character that XML cannot hold", value);
  node.append_attribute(name) = value.c_str();
}

void set(pugi::xml_node& node, const char* name, double value) {
  node.append_attribute(name) = fmt::format("{}", value).c_str();
}

pugi::xml_node add_item(pugi::xml_node& list, const char* name, std::size_t id,
                        const std::string& label, const fs::path& file) {
  pugi::xml_node item = list.append_child(name);
  item.append_attribute("id") = std::to_string(id).c_str();
  set(item, "label", label, file);
  return item;
}

void add_reference(pugi::xml_node& marker, const ControlPoint& point) {
  constexpr std::array kPlaces{"x", "y", "z"}, kSigmas{"sx", "sy", "sz"};
  pugi::xml_node reference = marker.append_child("reference");
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    if (!point.knows(axis)) continue;
    set(reference, kPlaces[k], point.metres[axis]);
    set(reference, kSigmas[k], point.sigma[axis]);
  }
  reference.append_attribute("enabled") = point.check ? "false" : "true";
}

void add_markers(pugi::xml_node& chunk, const Control& control, const Identifiers& markers,
                 const fs::path& file) {
  std::map<std::string, const ControlPoint*> points;
  for (const ControlPoint& point : control.points) points.emplace(label_key(point.label), &point);
  pugi::xml_node list = chunk.append_child("markers");
  for (std::size_t id = 0; id < markers.labels().size(); ++id) {
    pugi::xml_node marker = add_item(list, "marker", id, markers.labels()[id], file);
    if (const auto found = points.find(label_key(markers.labels()[id])); found != points.end())
      add_reference(marker, *found->second);
  }
}

void add_locations(pugi::xml_node& chunk, const Control& control, const Identifiers& markers,
                   const Identifiers& cameras) {
  pugi::xml_node frame = chunk.append_child("frames").append_child("frame");
  frame.append_attribute("id") = "0";
  pugi::xml_node list = frame.append_child("markers");
  for (std::size_t id = 0; id < markers.labels().size(); ++id) {
    pugi::xml_node marker;
    for (const TargetImage& image : control.images) {
      if (markers.of(label_key(image.label)) != id) continue;
      if (!marker) {
        marker = list.append_child("marker");
        marker.append_attribute("marker_id") = std::to_string(id).c_str();
      }
      pugi::xml_node location = marker.append_child("location");
      location.append_attribute("camera_id") = std::to_string(cameras.of(image.image)).c_str();
      location.append_attribute("pinned") = "true";
      set(location, "x", image.pixel.x());
      set(location, "y", image.pixel.y());
    }
  }
}

void add_bars(pugi::xml_node& chunk, const Control& control, const Identifiers& markers,
              const fs::path& file) {
  pugi::xml_node list = chunk.append_child("scalebars");
  for (std::size_t id = 0; id < control.bars.size(); ++id) {
    const Bar& bar = control.bars[id];
    pugi::xml_node node = add_item(list, "scalebar", id, name_of(bar), file);
    for (const std::string& label : {bar.first, bar.second})
      node.append_child("endpoint").append_attribute("marker_id") =
          std::to_string(markers.of(label_key(label))).c_str();
    pugi::xml_node reference = node.append_child("reference");
    set(reference, "distance", bar.metres);
    set(reference, "accuracy", bar.sigma);
    reference.append_attribute("enabled") = bar.check ? "false" : "true";
  }
}

std::string wkt_of(const Control& control, const fs::path& file) {
  if (control.crs.empty()) return R"x(LOCAL_CS["Local Coordinates (m)",UNIT["metre",1]])x";
  const auto system = CoordinateSystem::from_text(control.crs);
  if (!system)
    fail_in(file, "cannot be written: '{}' is no coordinate reference system that PROJ knows",
            control.crs);
  return system->wkt();
}

}  // namespace

void write_metashape_markers(const fs::path& file, const Control& control) {
  const Identifiers markers = markers_of(control);
  Identifiers cameras;
  for (const TargetImage& image : control.images) cameras.add(image.image, image.image);
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node root = document.append_child("document");
  root.append_attribute("version") = "1.2.0";
  pugi::xml_node chunk = root.append_child("chunk");
  pugi::xml_node list = chunk.append_child("cameras");
  for (std::size_t id = 0; id < cameras.labels().size(); ++id)
    add_item(list, "camera", id, cameras.labels()[id], file);
  add_markers(chunk, control, markers, file);
  add_locations(chunk, control, markers, cameras);
  add_bars(chunk, control, markers, file);
  chunk.append_child("coordinate_system").text() = wkt_of(control, file).c_str();
  std::ostringstream text;
  document.save(text, "  ", pugi::format_default, pugi::encoding_utf8);
  write_atomically(file, text.str());
}

}  // namespace axial::control
