// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/scene_memory.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "densify/memory_limit.h"
#include "densify/project.h"
#include "io/openmvs/mvs_counts.h"
#include "io/openmvs/point_source.h"

namespace axial::densify {
namespace {

// The memory that a project holds for each image besides the scene: view, chosen neighbours,
// fingerprint.
std::uint64_t kept_of_images(std::uint64_t images) {
  constexpr std::uint64_t kChosen = 1024;
  return images * (sizeof(View) + kChosen);
}

// The memory for the text of the housing and of the lenses while it is read.
std::uint64_t side_files(const Settings& settings) {
  constexpr std::uint64_t kPerByte = 12;
  std::uint64_t bytes = 0;
  for (const std::filesystem::path& file :
       {housing_file(settings), io::lenses_beside(settings.survey.files.scene)}) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error) bytes += size;
  }
  return kPerByte * bytes;
}

// The memory of a scene before its views are scored.
std::uint64_t kept_of(const io::MvsCounts& counts, const Settings& settings) {
  return counts.scene_bytes() + side_files(settings) + kept_of_images(counts.images);
}

// The peak while the file of the scene is read and before its views are scored. Empty if the file
// cannot be counted.
std::optional<std::uint64_t> bytes_to_read(const Settings& settings) {
  auto counts = io::count_mvs(settings.survey.files.scene);
  if (!counts) return {};
  std::uint64_t reading = counts->reading_bytes();
  if (!settings.point_cloud.empty())
    if (const auto cloud = io::count_point_cloud(settings.point_cloud, *counts)) {
      reading = std::max(reading, cloud->reading_bytes);
      if (!only_exports(settings)) counts = cloud->scene;
    }
  const ScoringMemory scoring =
      scoring_memory({counts->images, counts->points, counts->observations, 0});
  const std::uint64_t kept = kept_of(*counts, settings);
  return std::max({reading, kept + scoring.work + scoring.kept, kept + counts->writing_bytes()});
}

// The peak while views are scored, with `size.neighbours` neighbours.
std::uint64_t bytes_to_score(const io::MvsCounts& counts, const ScoringSize& size,
                             const Settings& settings) {
  const ScoringMemory scoring = scoring_memory(size);
  io::MvsCounts written = counts;
  written.set_view_scores(size.neighbours);
  return kept_of(counts, settings) + scoring.kept + std::max(scoring.work, written.writing_bytes());
}

// `bytes`: the peak while the scene is read and its views are scored.
void require_memory_for_scene(std::uint64_t bytes, const Settings& settings) {
  const std::uint64_t cap = memory_limit(settings),
                      least = bytes + settings.survey.memory.program_bytes;
  if (bytes > settings.survey.memory.program_bytes && cap < least)
    fail(
        "{} {}: {} MB are too little, this scene needs at least {} MB for reading and for "
        "scoring its views",
        settings.name_of("max_memory"), settings.survey.memory.megabytes, cap / kMegabyte,
        least / kMegabyte + 1);
}

}  // namespace

void require_memory_to_read(const Settings& settings) {
  if (const auto bytes = bytes_to_read(settings)) require_memory_for_scene(*bytes, settings);
}

void require_memory_to_score(const Scene& scene, const Settings& settings) {
  ScoringSize size = scoring_size(scene, settings.selection);
  const io::MvsCounts counts = io::count_scene(scene);
  if (bytes_to_score(counts, size, settings) + settings.survey.memory.program_bytes >
      memory_limit(settings))
    size.neighbours = count_neighbours(scene, settings.selection);
  require_memory_for_scene(bytes_to_score(counts, size, settings), settings);
}

std::uint64_t least_memory_to_prepare(const Scene& scene, const Settings& settings) {
  ScoringSize size = scoring_size(scene, settings.selection);
  size.neighbours = 0;
  for (const SceneImage& image : scene.images) size.neighbours += image.neighbours.size();
  io::MvsCounts counts = io::count_scene(scene);
  counts.set_view_scores(0);  // before scoring
  return settings.survey.memory.program_bytes +
         std::max(bytes_to_score(counts, size, settings), bytes_to_read(settings).value_or(0));
}

}  // namespace axial::densify
