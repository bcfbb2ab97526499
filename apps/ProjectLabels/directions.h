// SPDX-License-Identifier: GPL-3.0-or-later
// The two directions of the program: they read the labels, carry them, and write the files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "labels/coco.h"
#include "labels/labelled_surface.h"
#include "settings.h"
#include "survey/survey.h"

namespace axial::apps {

// The labels to carry: those of Settings::from_map, or those of Settings::from_photographs.
struct GivenLabels {
  std::vector<map::Label> on_map;
  labels::CocoLabels in_photographs;
};

// `crs`: of the map. Errors of the readers. Error if the masks cannot hold all classes.
GivenLabels read_given(const Settings& settings, const std::string& crs);

// What both directions need.
struct Ground {
  const Settings& settings;
  const GivenLabels& given;
  const survey::Survey& survey;
  const labels::LabelledSurface& surface;
  const std::string& crs;  // of the map, as WKT; empty: none
};

// The files that a run writes; not the masks.
std::vector<std::filesystem::path> outputs_of(const Settings& settings);

// Errors: no photograph sees a label; a file cannot be written.
void to_photographs(const Ground& ground, const Context& context);
// Errors: an image has another size than its photograph; no label meets the surface; a file cannot
// be written.
void to_map(const Ground& ground, const Context& context);

// Warns of labels by their names, of five at most.
void warn_of(const std::vector<std::string>& names, const std::string& what);

}  // namespace axial::apps
