// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfinished.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "base/hash.h"
#include "io/artifacts/artifact.h"
#include "io/artifacts/written_files.h"
#include "io/images/image.h"
#include "survey/fingerprint.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "unfinished";

template <class Values>
void add_numbers(Fingerprint& print, const Values& values) {
  for (const auto value : values) print.add(static_cast<double>(value));
}

void add_mesh(Fingerprint& print, const Mesh& mesh) {
  const auto add = [&](const auto& list) {
    print.add(std::string_view(reinterpret_cast<const char*>(list.data()),
                               list.size() * sizeof(list.front())));
  };
  add(mesh.vertices);
  add(mesh.faces);
  add(mesh.unseen);
}

void add_options(Fingerprint& print, const Settings& settings) {
  print.add(settings.light ? (*settings.light == color::Light::sun ? "sun" : "lamp") : "auto");
  print.add(std::uint64_t{settings.exposure == ExposureKind::each});
  print.add(std::uint64_t{settings.observe.points});
  print.add(settings.assumed ? color::name_of(*settings.assumed) : "");
  print.add(static_cast<std::uint64_t>(settings.jpeg_quality));
  if (settings.up) add_numbers(print, *settings.up);
}

}  // namespace

std::string made_from(const Settings& settings, const survey::Survey& survey, const Mesh& mesh,
                      const Findings& findings, const Context& context) {
  Fingerprint print;
  // The number is the version of the method.
  print.add("AxialMVS restored photographs 2");
  add_options(print, settings);
  add_mesh(print, mesh);
  add_numbers(print, survey.frame.origin);
  print.add(findings.transfer.name());
  add_numbers(print, findings.gain);
  for (const Eigen::Array3f& exposure : findings.exposures) add_numbers(print, exposure);
  print.add(survey::fingerprint_of_views(survey, context));
  return print.hex();
}

Unfinished::Unfinished(const fs::path& output, OutputNames names, std::string made_from)
    : folder_(output / kFolder), names_(std::move(names)), made_from_(std::move(made_from)) {}

std::vector<fs::path> Unfinished::files(const fs::path& output, const OutputNames& names) {
  std::vector<fs::path> files;
  for (const auto* list : {&names.photographs, &names.masks})
    for (const fs::path& name : *list)
      for (const fs::path& file : io::with_side_file(output / kFolder / name))
        files.push_back(file);
  return files;
}

// The number and the name of the view: another view may have had this name in the earlier run.
std::string Unfinished::mark_of(std::size_t view) const {
  return fmt::format("{} {} {}", made_from_, view, names_.photographs[view].generic_string());
}

std::optional<std::uint64_t> Unfinished::known_pixels(std::size_t view) const {
  const std::string mark = mark_of(view);
  if (!names_.masks.empty() && !io::read_mark({folder_ / names_.masks[view], mark}))
    return std::nullopt;
  const auto facts = io::read_mark({folder_ / names_.photographs[view], mark});
  if (!facts) return std::nullopt;
  const auto known = facts->find("known_pixels");
  if (known == facts->end() || !known->is_number_unsigned()) return std::nullopt;
  return known->get<std::uint64_t>();
}

void Unfinished::write(std::size_t view, const color::Restored& restored, int jpeg_quality) const {
  const std::string mark = mark_of(view);
  if (!names_.masks.empty()) {
    const fs::path mask = folder_ / names_.masks[view];
    make_folder(mask.parent_path());
    io::write_png(mask, restored.known);
    io::write_mark({mask, mark}, nlohmann::json::object());
  }
  const fs::path file = folder_ / names_.photographs[view];
  make_folder(file.parent_path());
  if (is_jpeg_name(file))
    io::write_jpeg(file, restored.pixels, jpeg_quality);
  else
    io::write_png(file, restored.pixels);
  const auto known = static_cast<std::uint64_t>(cv::countNonZero(restored.known));
  io::write_mark({file, mark}, {{"known_pixels", known}});
}

void Unfinished::give_to(const fs::path& folder) const {
  for (const auto* list : {&names_.photographs, &names_.masks})
    for (const fs::path& name : *list) link_or_copy(folder_ / name, folder / name);
}

void Unfinished::remove() const {
  std::vector<fs::path> ours;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder_, error)) {
    if (!entry.is_regular_file(error) || entry.is_symlink(error)) continue;
    if (!io::read_mark(entry.path())) continue;
    for (const fs::path& file : io::with_side_file(entry.path()))
      ours.push_back(file.lexically_relative(folder_));
  }
  io::remove_below(folder_, ours);
  fs::remove(folder_, error);  // stays if it contains other files
}

}  // namespace axial::apps
