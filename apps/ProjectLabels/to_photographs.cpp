// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <opencv2/core.hpp>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "base/parallel.h"
#include "base/same_file.h"
#include "directions.h"
#include "io/images/image.h"
#include "labels/coco.h"
#include "labels/fill.h"
#include "labels/map_to_photographs.h"
#include "map/label_file.h"
#include "survey/photograph_names.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The labels of all views, in their order.
std::vector<std::vector<labels::SeenLabel>> seen_labels(const Ground& ground,
                                                        const labels::MapLabels& labels,
                                                        const Context& context) {
  std::vector<std::vector<labels::SeenLabel>> seen(ground.survey.views.size());
  ProgressCounter progress(context.stage("Looking at photographs"), seen.size());
  parallel_for(seen.size(), [&](std::size_t view) {
    const survey::View& of = ground.survey.views[view];
    seen[view] = labels.seen_in(labels::PosedRays({of.camera, of.pose}));
    progress.add();
  });
  return seen;
}

// Warns of labels that no photograph sees, and returns the number of the others. Error if there is
// no other label.
std::size_t count_seen(const Ground& ground, const std::vector<map::Label>& labels,
                       const labels::MapLabels& placed,
                       const std::vector<std::vector<labels::SeenLabel>>& seen) {
  std::vector<bool> is_seen(labels.size(), false);
  for (const auto& view : seen)
    for (const labels::SeenLabel& label : view) is_seen[label.index] = true;
  std::vector<std::string> beside, unseen;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (!is_seen[i]) (placed.is_on_surface(i) ? unseen : beside).push_back(labels[i].name);
  if (beside.size() == labels.size())
    fail_in(ground.settings.mesh,
            "has no surface at any label: are the coordinates those of the map?");
  if (beside.size() + unseen.size() == labels.size())
    fail_in(ground.settings.from_map, "no photograph sees a label");
  warn_of(beside, "the mesh has no surface there");
  warn_of(unseen, "no photograph sees it");
  return labels.size() - beside.size() - unseen.size();
}

// The photographs that see a label.
std::vector<labels::LabelledPhotograph> labelled(const Ground& ground,
                                                 std::vector<std::vector<labels::SeenLabel>> seen) {
  const std::vector<fs::path> names = survey::photograph_names(ground.survey);
  std::vector<labels::LabelledPhotograph> photographs;
  for (std::size_t view = 0; view < seen.size(); ++view) {
    if (seen[view].empty()) continue;
    const CameraModel& camera = ground.survey.views[view].camera;
    labels::LabelledPhotograph photograph{
        names[view].generic_string(), camera.width, camera.height, {}};
    for (labels::SeenLabel& label : seen[view]) photograph.labels.push_back(std::move(label.label));
    photographs.push_back(std::move(photograph));
  }
  return photographs;
}

fs::path mask_name(const std::string& photograph) {
  return photograph + ".png";
}

cv::Mat mask_of(const labels::LabelledPhotograph& photograph,
                const labels::Categories& categories) {
  cv::Mat1w mask(photograph.height, photograph.width, std::uint16_t{0});
  for (const map::Label& label : photograph.labels)
    labels::fill(label.parts, static_cast<std::uint16_t>(categories.at(label.category).id), mask);
  if (categories.size() > 255) return mask;
  cv::Mat1b bytes;
  mask.convertTo(bytes, CV_8U);
  return bytes;
}

// Warns of masks in the folder of photographs that see no label: they are of other labels.
void warn_of_other_masks(const Ground& ground,
                         std::span<const labels::LabelledPhotograph> photographs) {
  std::set<fs::path> written;
  for (const auto& photograph : photographs) written.insert(mask_name(photograph.name));
  std::vector<fs::path> others;
  for (const fs::path& name : survey::photograph_names(ground.survey)) {
    const fs::path mask = mask_name(name.generic_string());
    if (!written.contains(mask) && fs::exists(ground.settings.masks / mask)) others.push_back(mask);
  }
  if (!others.empty())
    log_warning("{}: {} masks of photographs that see no label are of an earlier run, such as {}",
                ground.settings.masks.string(), others.size(), others.front().string());
}

// The labels of each pixel, its mask, and the encoded mask.
std::uint64_t bytes_of_largest_mask(std::span<const labels::LabelledPhotograph> photographs) {
  constexpr std::uint64_t kOfPixel = 4;
  std::uint64_t largest = 1;
  for (const auto& one : photographs)
    largest = std::max(
        largest, static_cast<std::uint64_t>(one.width) * static_cast<std::uint64_t>(one.height));
  return kOfPixel * largest;
}

void write_masks(const Ground& ground, std::span<const labels::LabelledPhotograph> photographs,
                 const labels::Categories& categories, const Context& context) {
  ProgressCounter progress(context.stage("Writing masks"), photographs.size());
  write_folder(ground.settings.masks, [&](const fs::path& staging) {
    for (const auto& photograph : photographs)
      make_folder((staging / mask_name(photograph.name)).parent_path());
    const std::size_t at_once =
        context.memory().items(bytes_of_largest_mask(photographs), thread_count(), "a mask");
    for_each_in_flight(photographs.size(), at_once, [&](std::size_t i) {
      io::write_png(staging / mask_name(photographs[i].name), mask_of(photographs[i], categories));
      progress.add();
    });
  });
  warn_of_other_masks(ground, photographs);
}

// The masks are moved to their folder when the text is on the disk, so that a failure leaves both
// as they were.
void write(const Ground& ground, std::span<const labels::LabelledPhotograph> photographs,
           const Context& context) {
  const fs::path file = outputs_of(ground.settings).front(), folder = ground.settings.masks;
  const labels::Categories categories = labels::categories_of(ground.given.on_map);
  const std::string text = labels::coco_text(photographs, categories);
  if (folder.empty()) return write_atomically(file, text);
  std::vector<fs::path> masks;
  for (const auto& photograph : photographs) masks.push_back(folder / mask_name(photograph.name));
  require_no_inputs(masks, ground.survey.inputs, "--masks");
  write_together({file}, [&](const std::vector<fs::path>& temporaries) {
    write_atomically(temporaries.front(), text);
    write_masks(ground, photographs, categories, context);
  });
}

}  // namespace

void to_photographs(const Ground& ground, const Context& context) {
  const Settings& settings = ground.settings;
  const std::vector<map::Label>& labels = ground.given.on_map;
  const labels::MapLabels placed =
      naming(settings.from_map, [&] { return labels::MapLabels(ground.surface, labels); });
  auto seen = seen_labels(ground, placed, context);
  const std::size_t count = count_seen(ground, labels, placed, seen);
  const std::vector<labels::LabelledPhotograph> photographs = labelled(ground, std::move(seen));
  write(ground, photographs, context);
  log_info("{} of {} labels are in {} of {} photographs: {}", count, labels.size(),
           photographs.size(), ground.survey.views.size(), outputs_of(settings).front().string());
}

}  // namespace axial::apps
