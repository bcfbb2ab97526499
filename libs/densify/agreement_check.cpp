// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/agreement_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/shared_cache.h"
#include "depth/agreement.h"
#include "io/bytes/json.h"

namespace axial::densify {
namespace {

constexpr std::size_t kImages = 16;

using axial::depth::Agreement;
using axial::depth::AgreementLimits;
using axial::depth::Disagreement;
using axial::depth::MapAgreement;
using Maps = SharedCache<DepthMap>;

// Evenly spaced references.
std::vector<std::size_t> images_to_compare(const Project& project) {
  const std::size_t count = project.references.size(), taken = std::min(count, kImages);
  std::vector<std::size_t> images;
  for (std::size_t i = 0; i < taken; ++i) images.push_back(project.references[i * count / taken]);
  return images;
}

MapAgreement compare_image(const Project& project, std::size_t image,
                           const std::vector<bool>& has_map, Maps& maps) {
  std::vector<Maps::Pointer> held{maps.get(image)};
  std::vector<const DepthMap*> neighbours;
  for (const ViewScore& source : project.sources[image]) {
    if (!has_map[source.image] || held.size() == kMapsCompared) continue;
    held.push_back(maps.get(source.image));
    neighbours.push_back(held.back().get());
  }
  std::vector<Eigen::Vector3f> points;
  for (const std::uint32_t point : project.preparations[image].init_points)
    points.push_back(project.scene.points[point].position);
  return depth::compare_map(*held.front(), neighbours, points);
}

Agreement measure(const Project& project, const MemoryPlan& plan,
                  const std::function<DepthMap(std::size_t)>& read_map) {
  std::vector<bool> has_map(project.scene.images.size(), false);
  for (const std::size_t image : project.references) has_map[image] = true;
  const std::vector<std::size_t> images = images_to_compare(project);
  std::vector<MapAgreement> found(images.size());
  Maps maps(read_map, plan.cached_maps);
  for_each_in_flight(images.size(), plan.in_flight, [&](std::size_t i) {
    found[i] = compare_image(project, images[i], has_map, maps);
  });
  return depth::summarise(found);
}

std::string likely_causes(const Project& project) {
  return project.housing
             ? "the port (its distances, normal or indices), the lens, or poses and points that "
               "are not in metres"
             : "a missing " + setting("housing") + ", the lens, or the poses";
}

void say(const Project& project, const Agreement& found, const Context& context) {
  const AgreementLimits limits;
  const std::string points = fmt::format(
      "the median deviation of {} sparse points from the depth maps is {:.2f} px ({:.2f} %), of "
      "image regions {:.2f} px",
      found.points, found.pixels, 100 * found.share, found.systematic);
  const std::string pixels = fmt::format("{:.0f} % of {} pixels agree with a neighbour's map",
                                         100 * found.consistent, found.asked);
  const Disagreement wrong = judge(found, limits);
  if (!wrong.cameras()) context.info("Agreement: {}; {}", points, pixels);
  const std::string scores = fmt::format(
      "patches at {} sparse points match with a median score of {:.2f} (usual: over {})",
      found.scored, found.score, limits.score);
  if (!wrong.cameras() && wrong.score)
    context.warning(
        "The photographs do not seem to show the scene: {}. Check that the photographs belong to "
        "the poses",
        scores);
  if (!wrong.cameras()) return;
  context.warning(
      "Cameras and photographs do not seem to belong together: {} (usual: below {} and {}); {} "
      "(usual: over {:.0f} %){}. Likely causes: {}{}",
      points, limits.pixels, limits.systematic, pixels, 100 * limits.consistent,
      wrong.score ? "; " + scores : "", likely_causes(project),
      wrong.score ? ", or photographs of another scene" : "");
}

void write_report(const std::filesystem::path& file, const Agreement& found) {
  const AgreementLimits limits;
  const Disagreement wrong = judge(found, limits);
  io::write_json(file, {{"agreement",
                         {{"points", found.points},
                          {"median_share", found.share},
                          {"median_px", found.pixels},
                          {"cells", found.cells},
                          {"systematic_px", found.systematic},
                          {"systematic_sigmas", found.significance},
                          {"pixels", found.asked},
                          {"consistent_share", found.consistent},
                          {"scored_points", found.scored},
                          {"median_score", found.score},
                          {"limits",
                           {{"median_px", limits.pixels},
                            {"systematic_px", limits.systematic},
                            {"systematic_sigmas", limits.significance},
                            {"consistent_share", limits.consistent},
                            {"median_score", limits.score}}},
                          {"warning", wrong.any()}}}});
}

}  // namespace

void check_agreement(const Project& project, const MemoryPlan& plan, bool photometric,
                     const std::function<DepthMap(std::size_t image)>& read_map,
                     const std::filesystem::path& report, const Context& context) {
  Agreement found = measure(project, plan, read_map);
  if (!photometric) found.scored = 0;
  say(project, found, context);
  if (!report.empty()) write_report(report, found);
}

}  // namespace axial::densify
