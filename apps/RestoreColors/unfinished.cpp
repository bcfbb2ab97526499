// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfinished.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "base/atomic_file.h"
#include "base/file_extension.h"
#include "base/hash.h"
#include "base/without_slash.h"
#include "io/artifacts/artifact.h"
#include "io/images/image.h"
#include "io/textured/textured_mesh.h"
#include "survey/fingerprint.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

void add(Fingerprint& print, const Eigen::Array3f& color) {
  for (const float value : color) print.add(static_cast<double>(value));
}

void add_options(Fingerprint& print, const Settings& settings) {
  print.add(settings.light ? static_cast<std::uint64_t>(*settings.light) : 9);
  for (const float light : {0.02f, 0.2f, 0.7f})
    print.add(static_cast<double>(settings.transfer.value(light)));
  print.add(static_cast<std::uint64_t>(settings.each_exposure));
  print.add(static_cast<std::uint64_t>(settings.observe.points));
  print.add(settings.assumed ? color::name_of(*settings.assumed) : "");
  print.add(static_cast<std::uint64_t>(settings.jpeg_quality));
}

// Renames a file, or copies it where the folders are on different disks.
void move_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) fs::copy_file(from, to);
}

// Removes `folder` and the folders in it that are empty.
void remove_empty_folders(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.is_directory(ignored)) remove_empty_folders(entry.path());
  fs::remove(folder, ignored);
}

}  // namespace

std::string made_from(const Settings& settings, const survey::Survey& survey,
                      const Findings& findings, const Context& context) {
  Fingerprint print;
  print.add("AxialMVS restored photographs 1");
  add_options(print, settings);
  print.add(survey::fingerprint_of_views(survey, context));
  for (const fs::path& file : io::files_of_mesh(settings.mesh)) print.add(io::print_of_file(file));
  if (settings.up)
    for (const double value : *settings.up) print.add(value);
  for (const double value : survey.frame.origin) print.add(value);
  add(print, findings.gain);
  for (const Eigen::Array3f& exposure : findings.exposures) add(print, exposure);
  print.add(description_of(findings));
  return print.hex();
}

Unfinished::Unfinished(const fs::path& output, OutputNames names, std::string made_from)
    : folder_(without_slash(output).string() + ".unfinished"),
      names_(std::move(names)),
      made_from_(std::move(made_from)) {}

std::optional<std::uint64_t> Unfinished::known_pixels(std::size_t view) const {
  if (!names_.masks.empty() && !io::read_mark({folder_ / names_.masks[view], made_from_}))
    return std::nullopt;
  const auto mark = io::read_mark({folder_ / names_.photographs[view], made_from_});
  if (!mark || !mark->contains("known_pixels")) return std::nullopt;
  return mark->at("known_pixels").get<std::uint64_t>();
}

void Unfinished::write(std::size_t view, const color::Restored& restored, int jpeg_quality) const {
  if (!names_.masks.empty()) {
    const fs::path mask = folder_ / names_.masks[view];
    make_folder(mask.parent_path());
    io::write_png(mask, restored.known);
    io::write_mark({mask, made_from_}, nlohmann::json::object());
  }
  const fs::path file = folder_ / names_.photographs[view];
  make_folder(file.parent_path());
  if (is_jpeg_name(file))
    io::write_jpeg(file, restored.pixels, jpeg_quality);
  else
    io::write_png(file, restored.pixels);
  io::write_mark({file, made_from_}, {{"known_pixels", cv::countNonZero(restored.known)}});
}

void Unfinished::move_into(const fs::path& folder) const {
  for (const auto* list : {&names_.photographs, &names_.masks})
    for (const fs::path& name : *list) {
      make_folder((folder / name).parent_path());
      move_file(folder_ / name, folder / name);
      io::remove_with_side_file(folder_ / name);
    }
  remove_empty_folders(folder_);
}

}  // namespace axial::apps
