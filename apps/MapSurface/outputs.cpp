// SPDX-License-Identifier: GPL-3.0-or-later
#include "outputs.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>
#include <variant>
#include <vector>

#include "base/log.h"
#include "base/version.h"
#include "io/openmvs/scene_with_cameras.h"
#include "map/map_archive.h"
#include "map/map_copies.h"
#include "map/profiles.h"
#include "map/stated_kind.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

fs::path named(const Settings& settings, const std::string& end) {
  return settings.output.string() + end;
}

map::FurtherFiles profiles_of(const Settings& settings, const map::MapGrid& grid,
                              const std::string& crs) {
  map::FurtherFiles files;
  for (const char* end : {".profiles.csv", ".profiles.gpkg", ".profiles.dxf"})
    files.paths.push_back(named(settings, end));
  files.write = [lines = map::read_lines(settings.profiles, crs, grid)](
                    const map::MapFiles& maps, std::span<const fs::path> paths) {
    map::write_profiles(maps.heights, lines, {paths[0], paths[1], paths[2]});
  };
  return files;
}

std::vector<std::pair<std::string, std::size_t>> ports_of(const survey::Survey& survey) {
  std::array<std::size_t, 3> counts{};
  for (const survey::View& view : survey.views)
    ++counts[view.camera.port ? view.camera.port->index() : 2];
  std::vector<std::pair<std::string, std::size_t>> ports;
  const char* const words[] = {"flat", "dome", "none"};
  for (std::size_t kind = 0; kind < counts.size(); ++kind)
    if (counts[kind] > 0) ports.emplace_back(words[kind], counts[kind]);
  return ports;
}

map::ArchiveFacts facts_of(const Settings& settings, const survey::Survey& survey) {
  map::ArchiveFacts facts;
  const fs::path& scene = settings.survey.files.scene;
  facts.title = scene.stem().string();
  facts.program = version_line("MapSurface");
  facts.ports = ports_of(survey);
  facts.inputs = {{"scene", scene}, {"mesh", settings.mesh}};
  if (survey.housing) facts.inputs.emplace_back("housing", io::housing_file(settings.survey.files));
  facts.image_noise = settings.image_noise;
  return facts;
}

map::FurtherFiles description_of(const Settings& settings, const survey::Survey& survey,
                                 const std::vector<map::FurtherFiles>& copies) {
  std::vector<fs::path> listed;
  for (const map::FurtherFiles& copy : copies)
    listed.insert(listed.end(), copy.paths.begin(), copy.paths.end());
  map::FurtherFiles files;
  files.paths = {named(settings, ".archive.xml")};
  files.write = [facts = facts_of(settings, survey), listed](const map::MapFiles& maps,
                                                             std::span<const fs::path> paths) {
    map::write_archive_description(maps, facts, listed, paths[0]);
  };
  return files;
}

// A file that states what it is, and those that are written with it.
struct Stale {
  fs::path file;
  const char* kind;
  std::vector<fs::path> companions;
};

std::vector<Stale> stale_of(const Settings& settings) {
  const auto at = [&](const char* end) { return named(settings, end); };
  return {
      {at(".sigma.tif"), map::kinds::kErrors, {}},
      {at(".hillshade.tif"), map::kinds::kShades, {}},
      {at(".contours.geojson"), map::kinds::kContours, {}},
      {at(".contours.gpkg"), map::kinds::kContours, {at(".contours.dxf")}},
      {at(".profiles.gpkg"), map::kinds::kProfiles, {at(".profiles.csv"), at(".profiles.dxf")}}};
}

// Copies in the folder of the maps that state that they are of the maps of this output.
std::vector<Stale> stale_copies_of(const Settings& settings) {
  constexpr std::array kMaps{"ortho.tif", "dem.tif", "views.tif", "sigma.tif", "hillshade.tif"};
  std::vector<Stale> found;
  const std::string begin = settings.output.filename().string() + ".";
  const fs::path folder = settings.output.parent_path();
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
    const fs::path& file = entry.path();
    if (!file.filename().string().starts_with(begin) || file.extension() != ".tif") continue;
    const std::string source = map::stated_source(file);
    if (std::ranges::none_of(kMaps, [&](const char* end) { return source == begin + end; }))
      continue;
    Stale stale{file, "", {}};
    if (file.filename().string().starts_with(begin + "archive.")) {
      stale.companions = {fs::path(file).replace_extension(".tfw")};
      if (file == named(settings, ".archive.dem.tif"))
        stale.companions.push_back(named(settings, ".archive.xml"));
    }
    found.push_back(std::move(stale));
  }
  return found;
}

}  // namespace

fs::path first_file(const Settings& settings) {
  return named(settings, ".dem.tif");
}

map::MapFiles map_files(const Settings& settings, const survey::Survey& survey,
                        const map::MapGrid& grid, const std::string& crs) {
  const auto at = [&](const char* end) { return named(settings, end); };
  map::MapFiles files;
  files.heights = first_file(settings);
  files.colors = at(".ortho.tif");
  files.counts = at(".views.tif");
  if (settings.image_noise > 0) files.errors = at(".sigma.tif");
  if (settings.hillshade) files.shades = at(".hillshade.tif");
  if (settings.contours > 0) {
    files.contours = at(".contours.geojson");
    files.contour_package = at(".contours.gpkg");
    files.contour_drawing = at(".contours.dxf");
  }
  files.picture = at(".jpg");
  map::require_widths(settings.copies, grid);
  files.further = map::copies_of(files, grid, settings.output, settings.copies);
  if (settings.copies.preset == map::Preset::archive)
    files.further.push_back(description_of(settings, survey, files.further));
  if (!settings.profiles.empty()) files.further.push_back(profiles_of(settings, grid, crs));
  return files;
}

void remove_stale_files(const Settings& settings, std::span<const fs::path> written) {
  const auto remove = [&](const fs::path& file) {
    if (std::ranges::find(written, file) != written.end() || !fs::is_regular_file(file)) return;
    fs::remove(file);
    log_info("removed {}, which belonged to an earlier map", file.string());
  };
  std::vector<Stale> all;
  for (const Stale& one : stale_of(settings))
    if (map::stated_kind(one.file) == one.kind) all.push_back(one);
  for (Stale& one : stale_copies_of(settings)) all.push_back(std::move(one));
  for (const Stale& one : all) {
    if (std::ranges::find(written, one.file) != written.end()) continue;
    remove(one.file);
    for (const fs::path& companion : one.companions) remove(companion);
  }
}

}  // namespace axial::apps
