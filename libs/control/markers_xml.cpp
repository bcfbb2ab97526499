// SPDX-License-Identifier: GPL-3.0-or-later
// Metashape's XML of markers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <pugixml.hpp>
#include <vector>

#include "base/error.h"
#include "base/parse_number.h"
#include "private/readers.h"
#include "private/stated_points.h"

namespace axial::control {
namespace {

using Labels = std::map<std::string, std::string>;  // by identifier

// A document, and places in it for messages.
class Document {
 public:
  Document(const std::string& text, std::string file) : text_(text), file_(std::move(file)) {
    const auto result = xml_.load_buffer(text.data(), text.size());
    if (!result)
      fail_in(where(std::max<std::ptrdiff_t>(0, result.offset)), "is no XML: {}",
              result.description());
  }
  pugi::xml_node root() const { return xml_.document_element(); }
  std::string where(std::ptrdiff_t offset) const {
    const auto end = text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text_));
    return fmt::format("{}:{}", file_, 1 + std::count(text_.begin(), end, '\n'));
  }
  std::string where(const pugi::xml_node& node) const { return where(node.offset_debug()); }

 private:
  const std::string& text_;
  std::string file_;
  pugi::xml_document xml_;
};

// The number of an attribute; `otherwise` if it is missing or empty.
double number_of(const pugi::xml_node& node, const char* name, double otherwise,
                 const std::string& where) {
  const char* text = node.attribute(name).value();
  if (!*text) return otherwise;
  const auto number = parse_number<double>(text);
  if (!number) fail_in(where, "{} is '{}', which is not a number", name, text);
  return *number;
}

bool flag_of(const pugi::xml_node& node, const char* name) {
  const std::string text = node.attribute(name).value();
  return text.empty() || text == "true" || text == "1";
}

// The nodes of this name at any depth below the children `list` of `parent`.
std::vector<pugi::xml_node> nodes_of(const pugi::xml_node& parent, const char* list,
                                     const char* name) {
  std::vector<pugi::xml_node> nodes;
  for (const pugi::xml_node& lists : parent.children(list)) {
    // Groups hold cameras and markers, too.
    pugi::xml_node node = lists.first_child();
    while (node) {
      if (std::strcmp(node.name(), name) == 0) nodes.push_back(node);
      const bool enters = std::strcmp(node.name(), "group") == 0 && node.first_child();
      if (enters) {
        node = node.first_child();
        continue;
      }
      while (node != lists && !node.next_sibling()) node = node.parent();
      node = node == lists ? pugi::xml_node() : node.next_sibling();
    }
  }
  return nodes;
}

Labels labels_of(const std::vector<pugi::xml_node>& nodes, const Document& document) {
  Labels labels;
  for (const pugi::xml_node& node : nodes) {
    const std::string label = node.attribute("label").value();
    if (label.empty()) fail_in(document.where(node), "a {} has no label", node.name());
    if (!labels.emplace(node.attribute("id").value(), label).second)
      fail_in(document.where(node), "{}: its id {} occurs twice", label,
              node.attribute("id").value());
  }
  return labels;
}

const std::string& label_of(const Labels& labels, const pugi::xml_node& node, const char* name,
                            const Document& document) {
  const auto found = labels.find(node.attribute(name).value());
  if (found == labels.end())
    fail_in(document.where(node), "{} is '{}', but nothing in the file has this id", name,
            node.attribute(name).value());
  return found->second;
}

// The chunk, or the root of a document without chunks.
pugi::xml_node chunk_of(const Document& document, const std::string& file, Control& control) {
  const pugi::xml_node root = document.root();
  pugi::xml_node chunk = root.child("chunk");
  if (!chunk) chunk = root.child("chunks").child("chunk");
  if (!chunk) return root;
  if (chunk.next_sibling("chunk"))
    control.notes.push_back(fmt::format("{}: has several chunks; the first, '{}', is read", file,
                                        chunk.attribute("label").value()));
  return chunk;
}

class MarkersReader {
 public:
  MarkersReader(const Document& document, pugi::xml_node chunk, const ControlReading& options,
                Control& control)
      : document_(document),
        chunk_(chunk),
        options_(options),
        control_(control),
        marker_nodes_(nodes_of(chunk, "markers", "marker")),
        markers_(labels_of(marker_nodes_, document)),
        cameras_(labels_of(nodes_of(chunk, "cameras", "camera"), document)) {}

  void read_observations() {
    for (const pugi::xml_node& frame : chunk_.child("frames").children("frame"))
      for (const pugi::xml_node& marker : nodes_of(frame, "markers", "marker"))
        for (const pugi::xml_node& location : marker.children("location"))
          if (flag_of(location, "pinned") && flag_of(location, "valid"))
            read_location(label_of(markers_, marker, "marker_id", document_), location);
  }

  StatedPoints stated_points() const {
    StatedPoints stated;
    for (const pugi::xml_node& marker : marker_nodes_)
      if (const pugi::xml_node reference = marker.child("reference")) {
        StatedPoint point = stated_point(marker.attribute("label").value(), reference);
        if (!point.place.array().isNaN().all()) stated.points.push_back(std::move(point));
      }
    for (const char* name : {"coordinate_system", "reference"})
      if (const pugi::xml_node system = chunk_.child(name); system && stated.crs.empty()) {
        stated.crs = system.child_value();
        stated.crs_where = document_.where(system);
      }
    return stated;
  }

  void read_bars() {
    for (const pugi::xml_node& node : nodes_of(chunk_, "scalebars", "scalebar")) {
      const pugi::xml_node reference = node.child("reference");
      std::vector<std::string> ends;
      for (const pugi::xml_node& end : node.children("endpoint"))
        if (end.attribute("marker_id"))
          ends.push_back(label_of(markers_, end, "marker_id", document_));
      // Bars between cameras, and bars without a measured length, tell nothing.
      if (ends.size() != 2 || !reference.attribute("distance")) continue;
      const std::string where = document_.where(node);
      const double sigma = number_of(reference, "accuracy", 0, where);
      add_bar({ends[0], ends[1], number_of(reference, "distance", kNoNumber, where), sigma,
               !flag_of(reference, "enabled"), where},
              options_, control_);
    }
  }

 private:
  void read_location(const std::string& label, const pugi::xml_node& location) {
    const std::string where = document_.where(location), at = where + ": " + label;
    TargetImage image;
    image.label = label;
    image.image = label_of(cameras_, location, "camera_id", document_);
    image.pixel = {finite(number_of(location, "x", kNoNumber, at), at, "x"),
                   finite(number_of(location, "y", kNoNumber, at), at, "y")};
    image.where = where;
    control_.images.push_back(std::move(image));
  }

  StatedPoint stated_point(std::string label, const pugi::xml_node& reference) const {
    StatedPoint point;
    point.label = std::move(label);
    point.where = document_.where(reference);
    const std::string at = point.where + ": " + point.label;
    constexpr std::array kPlaces{"x", "y", "z"}, kSigmas{"sx", "sy", "sz"};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      point.place[axis] = number_of(reference, kPlaces[k], kNoNumber, at);
      point.sigma[axis] = number_of(reference, kSigmas[k], 0, at);
    }
    point.check = !flag_of(reference, "enabled");
    return point;
  }

  const Document& document_;
  pugi::xml_node chunk_;
  const ControlReading& options_;
  Control& control_;
  std::vector<pugi::xml_node> marker_nodes_;
  Labels markers_, cameras_;
};

}  // namespace

Control read_markers_xml(const std::string& text, const std::filesystem::path& file,
                         const ControlReading& options) {
  const Document document(text, file.string());
  Control control;
  MarkersReader reader(document, chunk_of(document, file.string(), control), options, control);
  reader.read_observations();
  add_points(reader.stated_points(), file, options, control);
  reader.read_bars();
  return control;
}

}  // namespace axial::control
