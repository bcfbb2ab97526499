// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary/options.h"

#include "base/error.h"
#include "base/split.h"

namespace axial::boundary {
namespace {

constexpr std::size_t kLeastTargets = 3;

std::vector<std::string> labels_of(const std::string& text) {
  std::vector<std::string> labels;
  for (const std::string_view part : split(text, ',')) labels.emplace_back(trimmed(part));
  for (const std::string& label : labels)
    if (label.empty()) fail("--boundary-targets {}: has an empty label", text);
  if (labels.size() < kLeastTargets)
    fail("--boundary-targets {}: must be three or more labels, separated by commas", text);
  return labels;
}

}  // namespace

void declare(OptionList& list, Options& options) {
  list.add("boundary", &options.file,
           "polygons (GeoJSON, GeoPackage or shape file) outside of which everything is left out, "
           "in the coordinates of the map")
      .add_text(
          "boundary-targets",
          [&options](const std::string& text) { options.targets = labels_of(text); },
          "in place of --boundary: labels of three or more targets at the corners, in their order "
          "around the area, separated by commas")
      .add("target-places", &options.places,
           "places of these targets: of RefinePoses, or control points (default: "
           "target_places.json in the folder of the mesh or in refined/ there)")
      .add("boundary-map", &options.map,
           "map of MapSurface, or .change.json of CompareSurveys, that states the axes and the "
           "coordinate reference system in which the boundary is meant");
}

void declare_like(OptionList& list, Options& options) {
  list.add("like", &options.map,
           "map of MapSurface whose axes and coordinate reference system the new map gets; or "
           ".change.json of CompareSurveys: the map of the later survey gets those of the earlier "
           "one");
}

void check(const ParsedOptions& parsed, const Options& options) {
  if (!options.file.empty() && !options.targets.empty())
    fail("--boundary-targets contradicts --boundary: give one of them");
  if (!options.places.empty() && options.targets.empty())
    fail("--target-places {}: is only for --boundary-targets", options.places.string());
  if (given(parsed, "boundary-map") && !options.is_given())
    fail("--boundary-map {}: is only for --boundary and --boundary-targets", options.map.string());
}

void check_like(const ParsedOptions& parsed) {
  const bool is_like = given(parsed, "like"), is_of_boundary = given(parsed, "boundary-map");
  if (is_like && is_of_boundary) fail("--boundary-map contradicts --like: give one of them");
  if (!is_like && !is_of_boundary) return;
  for (const char* option : {"up", "epsg"})
    if (given(parsed, option))
      fail("--{} contradicts --{}, which states it", option, is_like ? "like" : "boundary-map");
}

}  // namespace axial::boundary
