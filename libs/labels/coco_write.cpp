// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/bytes/json.h"
#include "labels/coco.h"

namespace axial::labels {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value) {
  return std::round(value * 100) / 100;
}

// COCO's coordinates.
Eigen::Vector2d from_corner(const Eigen::Vector2d& pixel) {
  return pixel + Eigen::Vector2d::Constant(0.5);
}

// The ring `hole` as a part of `ring`, by the line between their nearest corners.
void join(const geometry::Ring& hole, geometry::Ring& ring) {
  std::size_t here = 0, there = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i)
    for (std::size_t j = 0; j < hole.size(); ++j)
      if (const double distance = (ring[i] - hole[j]).squaredNorm(); distance < least) {
        least = distance;
        here = i;
        there = j;
      }
  geometry::Ring way(hole.begin() + static_cast<std::ptrdiff_t>(there), hole.end());
  way.insert(way.end(), hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(there) + 1);
  way.push_back(ring[here]);
  ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(here) + 1, way.begin(), way.end());
}

Json box_of(const Eigen::AlignedBox2d& box) {
  return Json::array({rounded(box.min().x()), rounded(box.min().y()), rounded(box.sizes().x()),
                      rounded(box.sizes().y())});
}

Json polygons_of(const map::Label& label) {
  Json polygons = Json::array();
  double area = 0;
  Eigen::AlignedBox2d box;
  for (const auto& part : label.parts) {
    geometry::Ring ring = part.front();
    for (std::size_t i = 1; i < part.size(); ++i) join(part[i], ring);
    Json numbers = Json::array();
    for (const Eigen::Vector2d& corner : ring) {
      const Eigen::Vector2d at = from_corner(corner);
      box.extend(at);
      numbers.push_back(rounded(at.x()));
      numbers.push_back(rounded(at.y()));
    }
    area += std::abs(geometry::signed_area(ring));
    polygons.push_back(std::move(numbers));
  }
  return {{"segmentation", std::move(polygons)}, {"area", rounded(area)}, {"bbox", box_of(box)}};
}

Json key_point_of(const Eigen::Vector2d& point) {
  constexpr int kVisible = 2;
  const Eigen::Vector2d at = from_corner(point);
  return {{"segmentation", Json::array()},
          {"keypoints", Json::array({rounded(at.x()), rounded(at.y()), kVisible})},
          {"num_keypoints", 1},
          {"area", 0},
          {"bbox", box_of(Eigen::AlignedBox2d(at))}};
}

// The entries of a file, each on a line.
std::string list_of(const std::vector<Json>& entries) {
  std::string text = "[";
  for (const Json& entry : entries)
    text += (&entry == entries.data() ? "\n" : ",\n") + io::to_text(entry);
  return text + "\n]";
}

// Collects annotations with consecutive ids.
class Annotations {
 public:
  explicit Annotations(const Categories& categories) : categories_(categories) {}

  void add(const map::Label& label, int image) {
    if (!label.parts.empty()) add(label, image, polygons_of(label));
    for (const Eigen::Vector2d& point : label.points) add(label, image, key_point_of(point));
  }

  const std::vector<Json>& all() const { return all_; }

 private:
  void add(const map::Label& label, int image, const Json& shape) {
    Json entry{{"id", all_.size() + 1},
               {"image_id", image},
               {"category_id", categories_.at(label.category).id}};
    entry.update(shape);
    entry["iscrowd"] = 0;
    entry["attributes"]["name"] = label.name;
    all_.push_back(std::move(entry));
  }

  const Categories& categories_;
  std::vector<Json> all_;
};

std::vector<Json> entries_of(const Categories& categories) {
  std::vector<Json> entries;
  for (const auto& [name, category] : categories) {
    Json entry{{"id", category.id}, {"name", name}, {"supercategory", ""}};
    if (category.has_points) {
      entry["keypoints"] = Json::array({"point"});
      entry["skeleton"] = Json::array();
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace

Categories categories_of(std::span<const map::Label> labels) {
  Categories categories;
  for (const map::Label& label : labels)
    if (Category& category = categories[label.category]; !label.points.empty())
      category.has_points = true;
  int last = 0;
  for (auto& [name, category] : categories) category.id = ++last;
  return categories;
}

std::string coco_text(std::span<const LabelledPhotograph> photographs,
                      const Categories& categories) {
  std::vector<Json> images;
  Annotations annotations(categories);
  for (const LabelledPhotograph& photograph : photographs) {
    const int id = static_cast<int>(images.size()) + 1;
    images.push_back({{"id", id},
                      {"file_name", photograph.name},
                      {"width", photograph.width},
                      {"height", photograph.height}});
    for (const map::Label& label : photograph.labels) annotations.add(label, id);
  }
  const Json info{
      {"description", "labels of AxialMVS; (0, 0) is the outer corner of the first pixel"}};
  return "{\"info\": " + io::to_text(info) + ",\n\"images\": " + list_of(images) +
         ",\n\"annotations\": " + list_of(annotations.all()) +
         ",\n\"categories\": " + list_of(entries_of(categories)) + "}\n";
}

}  // namespace axial::labels
