// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/file_contents.h"

#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "io/bytes/json.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

constexpr const char* kFile = "depth_inputs.json";

std::vector<fs::path> files_of(const Project& project, std::size_t image) {
  std::vector<fs::path> files{project.scene.images[image].path};
  if (!project.views[image].mask.empty()) files.push_back(project.views[image].mask);
  return files;
}

std::string content_of(const std::vector<fs::path>& files) {
  Fingerprint print;
  for (const fs::path& file : files) print.add(read_file(file));
  return print.hex();
}

// A fingerprint of names, sizes and times of change. Empty if a file does not exist.
std::string state_of(const std::vector<fs::path>& files) {
  Fingerprint state;
  for (const fs::path& file : files) {
    struct stat found {};
    if (::stat(file.c_str(), &found) != 0) return {};
    state.add(file.string());
    for (const auto number : {found.st_size, found.st_mtim.tv_sec, found.st_mtim.tv_nsec})
      state.add(static_cast<std::uint64_t>(number));
  }
  return state.hex();
}

// Fingerprints by state_of().
nlohmann::json kept_contents(const fs::path& file) {
  try {
    if (fs::exists(file)) return io::read_json(file).at("contents");
  } catch (const std::exception&) {
    // A damaged file: the photographs are read.
  }
  return nlohmann::json::object();
}

std::string kept_or_read(const nlohmann::json& kept, const std::string& state,
                         const std::vector<fs::path>& files) {
  const auto found = kept.is_object() ? kept.find(state) : kept.end();
  if (!state.empty() && found != kept.end() && found->is_string()) return found->get<std::string>();
  return content_of(files);
}

}  // namespace

std::vector<std::string> contents_of_views(const Project& project, const Settings& settings) {
  const bool is_part = settings.parts > 0 || settings.tile > 0;
  const bool uses_kept = is_part || !settings.until.empty() || !settings.plan.empty();
  const fs::path file = settings.working_folder / kFile;
  const nlohmann::json kept = uses_kept ? kept_contents(file) : nlohmann::json::object();
  std::vector<std::string> prints(project.views.size()), states(project.views.size());
  ProgressCounter counter(console_progress("Fingerprints of images"), prints.size());
  parallel_for(prints.size(), [&](std::size_t i) {
    if (project.scene.images[i].calibrated) {
      const std::vector<fs::path> files = files_of(project, i);
      states[i] = uses_kept ? state_of(files) : std::string();
      prints[i] = kept_or_read(kept, states[i], files);
    }
    counter.add();
  });
  if (!uses_kept || is_part) return prints;
  nlohmann::json contents = nlohmann::json::object();
  for (std::size_t i = 0; i < prints.size(); ++i)
    if (!states[i].empty()) contents[states[i]] = prints[i];
  if (contents != kept) io::write_json(file, {{"contents", contents}});
  return prints;
}

}  // namespace axial::densify
