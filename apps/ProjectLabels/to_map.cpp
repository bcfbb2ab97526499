// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel.h"
#include "directions.h"
#include "labels/coco.h"
#include "labels/photographs_to_map.h"
#include "map/label_file.h"
#include "survey/photograph_names.h"

namespace axial::apps {
namespace {

// The view of a photograph with labels; nothing if the scene does not have the photograph. Error if
// several views have its name, or if the sizes differ.
std::optional<std::size_t> view_of(const labels::LabelledPhotograph& photograph,
                                   const Ground& ground) {
  const auto& file = ground.settings.from_photographs;
  const std::vector<std::size_t> views = survey::views_named(photograph.name, ground.survey);
  if (views.empty()) return std::nullopt;
  if (views.size() > 1)
    fail_in(file, "file_name {}: several photographs have this name; give a folder, too",
            photograph.name);
  const CameraModel& camera = ground.survey.views[views.front()].camera;
  if (camera.width != photograph.width || camera.height != photograph.height)
    fail_in(file, "file_name {}: it is {} x {} px, but the photograph is {} x {}", photograph.name,
            photograph.width, photograph.height, camera.width, camera.height);
  return views.front();
}

// A label and its photograph.
struct Drawn {
  const map::Label& label;
  std::size_t view;
};

std::vector<Drawn> drawn_labels(const labels::CocoLabels& coco, const Ground& ground) {
  std::vector<Drawn> drawn;
  std::vector<std::string> unknown;
  for (const labels::LabelledPhotograph& photograph : coco.photographs) {
    if (photograph.labels.empty()) continue;
    const auto view = view_of(photograph, ground);
    if (!view) unknown.push_back(photograph.name);
    if (!view) continue;
    for (const map::Label& label : photograph.labels) drawn.push_back({label, *view});
  }
  const auto& file = ground.settings.from_photographs;
  if (drawn.empty() && !unknown.empty())
    fail_in(file, "no photograph of the scene is named {}", unknown.front());
  if (drawn.empty()) fail_in(file, "has neither polygon nor key point");
  if (!unknown.empty())
    log_warning("{}: {} photographs with labels are not in the scene, such as {}", file.string(),
                unknown.size(), unknown.front());
  if (coco.left_out > 0)
    log_warning("{}: {} annotations are left out: they have neither polygon nor key point",
                file.string(), coco.left_out);
  return drawn;
}

std::vector<labels::CarriedLabel> carried_labels(const Ground& ground,
                                                 const std::vector<Drawn>& drawn,
                                                 const Context& context) {
  std::vector<labels::CarriedLabel> carried(drawn.size());
  ProgressCounter progress(context.stage("Carried labels"), drawn.size());
  parallel_for(drawn.size(), [&](std::size_t i) {
    const survey::View& view = ground.survey.views[drawn[i].view];
    carried[i] = labels::carried_to_map(ground.surface, labels::PosedRays({view.camera, view.pose}),
                                        drawn[i].label, ground.settings.least_part);
    progress.add();
  });
  return carried;
}

bool is_empty(const labels::CarriedLabel& carried) {
  return carried.label.parts.empty() && carried.label.points.empty();
}

}  // namespace

void to_map(const Ground& ground, const Context& context) {
  constexpr double kMuch = 0.1, kCoarse = 2;
  const Settings& settings = ground.settings;
  const std::vector<Drawn> drawn = drawn_labels(ground.given.in_photographs, ground);
  std::vector<labels::CarriedLabel> carried = carried_labels(ground, drawn, context);
  if (std::ranges::all_of(carried, is_empty))
    fail_in(settings.mesh, "no label of {} lies on its surface",
            settings.from_photographs.string());
  const auto names = survey::photograph_names(ground.survey);
  std::vector<std::string> lost, torn, coarse;
  std::vector<map::LabelFromPhotograph> on_map;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const std::string photograph = names[drawn[i].view].generic_string();
    const std::string name = drawn[i].label.name + " in " + photograph;
    if (is_empty(carried[i]))
      lost.push_back(name);
    else if (carried[i].missing > kMuch)
      torn.push_back(name);
    if (carried[i].coarseness > kCoarse) coarse.push_back(name);
    if (!is_empty(carried[i]))
      on_map.push_back({photograph, std::move(carried[i].label), std::move(carried[i].heights)});
  }
  const std::size_t carried_count = on_map.size();
  on_map = labels::joined_labels(ground.surface, std::move(on_map), settings.join);
  warn_of(lost, "the map shows none of it");
  warn_of(torn, "more than a tenth of it has no surface");
  warn_of(coarse,
          "its outline is coarser than two pixels of the photograph, because a part of it lies far "
          "away: does it reach over an edge?");
  const auto files = outputs_of(settings);
  map::write_labels({files[0], files[1]}, on_map, ground.crs);
  log_info("{} of {} labels are on the map: {}, {}", drawn.size() - lost.size(), drawn.size(),
           files[0].string(), files[1].string());
  if (settings.join.join != labels::Join::none)
    log_info("{} labels of photographs are {} on the map", carried_count, on_map.size());
}

}  // namespace axial::apps
