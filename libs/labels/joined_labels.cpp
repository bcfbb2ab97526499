// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels/joined_labels.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/naming.h"
#include "map/united_parts.h"

namespace axial::labels {
namespace {

using map::LabelFromPhotograph;

Eigen::AlignedBox2d box_of(const map::Label& label) {
  Eigen::AlignedBox2d box;
  for (const auto& part : label.parts)
    for (const Eigen::Vector2d& corner : part.front()) box.extend(corner);
  return box;
}

bool is_polygon(const map::Label& label) {
  return !label.parts.empty() && label.points.empty();
}

double common_share(const map::Label& a, const map::Label& b) {
  return naming("labels '" + a.name + "' and '" + b.name + "'",
                [&] { return map::common_share(a.parts, b.parts); });
}

using Objects = DisjointSets<std::size_t>;  // the labels of each object

Objects objects_of(const std::vector<LabelFromPhotograph>& labels, const JoinOptions& options) {
  Objects objects(labels.size());
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const LabelFromPhotograph& one : labels) boxes.push_back(box_of(one.label));
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (std::size_t k = i + 1; k < labels.size(); ++k) {
      const map::Label &a = labels[i].label, &b = labels[k].label;
      if (a.category != b.category || !is_polygon(a) || !is_polygon(b)) continue;
      if (objects.root(i) == objects.root(k)) continue;
      const bool is_one =
          options.join == Join::name
              ? a.name == b.name && a.name != a.category
              : boxes[i].intersects(boxes[k]) && common_share(a, b) >= options.least_overlap;
      if (is_one) objects.join(i, k);
    }
  return objects;
}

LabelFromPhotograph united_label(const LabelledSurface& surface,
                                 const std::vector<const LabelFromPhotograph*>& labels) {
  const map::Label& first = labels.front()->label;
  LabelFromPhotograph whole{{}, {first.name, first.category, {}, {}}, {}};
  std::vector<const map::PolygonParts*> polygons;
  std::vector<std::string> photographs;
  for (const LabelFromPhotograph* one : labels) {
    polygons.push_back(&one->label.parts);
    if (std::ranges::find(photographs, one->photograph) != photographs.end()) continue;
    photographs.push_back(one->photograph);
    whole.photograph += (whole.photograph.empty() ? "" : "; ") + one->photograph;
  }
  whole.label.parts = naming("label '" + first.name + "'", [&] { return map::united(polygons); });
  const Eigen::Vector3d& origin = surface.origin();
  for (const auto& part : whole.label.parts)
    for (const geometry::Ring& ring : part)
      for (const Eigen::Vector2d& corner : ring) {
        const auto place = surface.highest(corner - origin.head<2>());
        whole.heights.push_back(place ? place->z() + origin.z()
                                      : std::numeric_limits<double>::quiet_NaN());
      }
  return whole;
}

}  // namespace

std::vector<LabelFromPhotograph> joined_labels(const LabelledSurface& surface,
                                               std::vector<LabelFromPhotograph> labels,
                                               const JoinOptions& options) {
  if (options.join == Join::none) return labels;
  Objects objects = objects_of(labels, options);
  std::vector<std::vector<const LabelFromPhotograph*>> of_first(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) of_first[objects.root(i)].push_back(&labels[i]);
  std::vector<LabelFromPhotograph> joined;
  for (const auto& object : of_first) {
    if (object.size() > 1) joined.push_back(united_label(surface, object));
    if (object.size() == 1) joined.push_back(*object.front());
  }
  return joined;
}

}  // namespace axial::labels
