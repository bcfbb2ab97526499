// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/image_positions.h"

#include <algorithm>

#include "base/error.h"
#include "base/file_extension.h"
#include "cameras/private/position_parts.h"
#include "io/cameras/position_file.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// The variants of the tables, from the strictest to the most lenient.
enum Variant { kLiteral, kAnyCase, kAnyExtension, kAnyCaseAndExtension };

constexpr int kRules = 4;

std::string without_extension(const std::string& path) {
  return fs::path(path).replace_extension().string();
}

bool is_photograph(const std::string& path) {
  static constexpr std::array kExtensions{".jpg",  ".jpeg", ".png", ".tif", ".tiff", ".bmp",
                                          ".webp", ".heic", ".dng", ".arw", ".cr2",  ".cr3",
                                          ".nef",  ".orf",  ".raf", ".rw2", ".gpr",  ".raw"};
  return std::ranges::find(kExtensions, lower_extension(path)) != kExtensions.end();
}

bool has_slash_at(const std::string& text, std::size_t at) {
  return text.size() > at && (text[at] == '/' || text[at] == '\\');
}

// The path of a label of Windows with slashes, without its drive.
std::string with_slashes(std::string label) {
  if (label.size() > 2 && label[1] == ':' && has_slash_at(label, 2)) label.erase(0, 2);
  std::ranges::replace(label, '\\', '/');
  return label;
}

std::string key_of(const std::string& path, int variant, bool is_image) {
  std::string key = path;
  if ((variant == kAnyExtension || variant == kAnyCaseAndExtension) &&
      (is_image || is_photograph(path)))
    key = without_extension(key);
  if (variant == kAnyCase || variant == kAnyCaseAndExtension) key = lower_case(key);
  return key;
}

// The ends of a path in whole folder and file names, the longest first.
std::vector<std::string> ends_of(const std::string& path) {
  std::vector<std::string> ends;
  for (std::size_t begin = 0; begin < path.size();) {
    ends.push_back(path.substr(begin));
    const std::size_t slash = path.find('/', begin);
    if (slash == std::string::npos) break;
    begin = slash + 1;
  }
  return ends;
}

std::string normal(const std::string& path) {
  return fs::path(path).lexically_normal().string();
}

using Images = std::unordered_map<std::string, std::vector<std::size_t>>;

const std::vector<std::size_t>* found_in(const Images& images, const std::string& key) {
  const auto found = images.find(key);
  return found == images.end() ? nullptr : &found->second;
}

// The images of the first end that is in `images`.
const std::vector<std::size_t>* longest_end_in(const Images& images, const std::string& key) {
  for (const std::string& end : ends_of(key))
    if (const auto* found = found_in(images, end)) return found;
  return nullptr;
}

// The image of each position; nothing for labels without an image, and for labels of an image that
// has a better one.
std::vector<std::optional<std::size_t>> images_of(const PositionFile& read,
                                                  const ImageLabels& labels,
                                                  std::span<const std::string> paths,
                                                  const fs::path& file) {
  constexpr int kAbsent = 1 << 30;
  std::vector<int> best(paths.size(), kAbsent);
  std::vector<ImageLabels::Match> matches;
  for (const NamedPosition& one : read.positions) {
    matches.push_back(labels.find(one.name));
    const ImageLabels::Match& match = matches.back();
    if (match.images.size() > 1)
      fail("{}:{}: '{}' can be {} or {}; give more of its path", file.string(), one.line, one.name,
           paths[match.images[0]], paths[match.images[1]]);
    if (match.images.empty()) continue;
    int& rank = best[match.images[0]];
    if (rank == match.rank) fail("{}:{}: {} occurs twice", file.string(), one.line, one.name);
    rank = std::min(rank, match.rank);
  }
  std::vector<std::optional<std::size_t>> images;
  for (const ImageLabels::Match& match : matches)
    images.push_back(!match.images.empty() && best[match.images[0]] == match.rank
                         ? std::optional(match.images[0])
                         : std::nullopt);
  return images;
}

using ImageOfRow = std::vector<std::optional<std::size_t>>;

// Drops lines without a fix, whose 0 0 is no place of the survey.
void drop_lost_fixes(PositionFile& read, ImageOfRow& images) {
  std::size_t kept = 0;
  for (std::size_t row = 0; row < images.size(); ++row) {
    if (images[row] && is_lost_fix(read.positions[row].position)) continue;
    images[kept] = images[row];
    if (kept != row) read.positions[kept] = std::move(read.positions[row]);
    ++kept;
  }
  if (kept == images.size()) return;
  read.notes.push_back(
      fmt::format("{} lines have longitude and latitude 0 and are skipped", images.size() - kept));
  read.positions.resize(kept);
  images.resize(kept);
}

// Converts positions that are degrees, although no line states it.
void settle_unit(PositionFile& read, ImageOfRow& images, std::span<const Eigen::Vector3d> centres,
                 const std::string& file) {
  if (read.as_degrees.empty()) return;
  std::vector<std::size_t> rows;
  std::vector<Eigen::Vector3d> of_rows;
  for (std::size_t row = 0; row < images.size(); ++row) {
    if (!images[row] || is_lost_fix(read.positions[row].position)) continue;
    rows.push_back(row);
    of_rows.push_back(centres[*images[row]]);
  }
  ChosenUnit chosen = choose_unit(read, rows, of_rows, file);
  if (!chosen.note.empty()) read.notes.push_back(std::move(chosen.note));
  if (!chosen.as_degrees) return;
  PositionReading& degrees = read.as_degrees[*chosen.as_degrees];
  for (std::size_t row = 0; row < images.size(); ++row)
    read.positions[row].position = degrees.positions[row];
  read.notes.push_back(std::move(degrees.note));
  drop_lost_fixes(read, images);
}

}  // namespace

ImageLabels::ImageLabels(std::span<const std::string> paths) {
  for (int variant = 0; variant < kVariants; ++variant)
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const std::string key = key_of(normal(paths[i]), variant, true);
      Table& table = tables_[static_cast<std::size_t>(variant)];
      table.whole[key].push_back(i);
      for (const std::string& end : ends_of(key)) table.ends[end].push_back(i);
    }
}

ImageLabels::Match ImageLabels::find(const std::string& label) const {
  if (label.empty()) return {};
  for (int variant = 0; variant < kVariants; ++variant) {
    const Table& table = tables_[static_cast<std::size_t>(variant)];
    int rank = 2 * kRules * variant;
    for (const std::string& path : {label, with_slashes(label)}) {
      const std::string key = key_of(normal(path), variant, false);
      const bool absolute = has_slash_at(path, 0);
      for (const auto* images :
           {found_in(table.whole, key), found_in(table.ends, key), longest_end_in(table.whole, key),
            absolute ? longest_end_in(table.ends, key) : nullptr}) {
        if (images) return {*images, rank};
        ++rank;
      }
    }
  }
  return {};
}

ImagePositions positions_of_images(const fs::path& file, std::span<const std::string> paths,
                                   std::span<const Eigen::Vector3d> centres,
                                   const std::string& whose) {
  const ImageLabels labels(paths);
  PositionFile read = read_positions(
      file, [&](const std::string& name) { return !labels.find(name).images.empty(); });
  ImageOfRow images = images_of(read, labels, paths, file);
  settle_unit(read, images, centres, file.string());
  ImagePositions result;
  for (const std::string& note : read.notes) result.notes.push_back(file.string() + ": " + note);
  for (std::size_t k = 0; k < images.size(); ++k) {
    const NamedPosition& one = read.positions[k];
    if (images[k])
      result.found.push_back({*images[k], one.line, one.position, one.sigma});
    else
      result.absent.push_back(
          fmt::format("{}:{}: {} has no image '{}'", file.string(), one.line, whose, one.name));
  }
  return result;
}

}  // namespace axial::io
