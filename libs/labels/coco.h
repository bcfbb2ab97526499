// SPDX-License-Identifier: GPL-3.0-or-later
// Labels of photographs in the format of the data set COCO, which annotation tools read and write.
// In its files, (0, 0) is the outer corner of the first pixel. Here, as everywhere in the program,
// pixel centres are at integers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "map/label_file.h"

namespace axial::labels {

// A photograph with its labels.
struct LabelledPhotograph {
  std::string name;
  int width = 0, height = 0;       // [px]
  std::vector<map::Label> labels;  // [px]
};

// The photographs of a file with their labels, in the order of the file.
struct CocoLabels {
  std::vector<LabelledPhotograph> photographs;
  std::size_t left_out = 0;  // annotations without polygon and key point, such as boxes and bitmaps
};

// Reads polygons and key points. A label has the name attributes.name, or the name of its category.
// Each polygon is a part. Error that names the file, and the entry and its value: the file is no
// such file; an id occurs twice or is missing; an annotation refers to no image or category; a
// polygon has fewer than three corners or an odd number of coordinates; a coordinate is larger than
// 1e6.
CocoLabels read_coco(const std::filesystem::path& file);

// A class of labels in a file.
struct Category {
  int id = 0;
  bool has_points = false;
};
using Categories = std::map<std::string, Category>;

// The classes of labels. Their ids are numbers from 1 in the order of the alphabet.
Categories categories_of(std::span<const map::Label> labels);

// The text of a file: an image for each photograph, all categories, and annotations with polygons,
// each with its bounding box and area, and a key point for each point. Numbers are rounded to
// 0.01 px. COCO's polygons have no holes: a hole is joined to the outline by a line there and back.
// Precondition: `categories` has the classes of all labels.
std::string coco_text(std::span<const LabelledPhotograph> photographs,
                      const Categories& categories);

}  // namespace axial::labels
