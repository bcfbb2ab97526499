// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "colmap/private/colmap_parts.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 3> kParts{"cameras", "images", "points3D"};

ModelForm other_than(ModelForm form) {
  return form == ModelForm::text ? ModelForm::binary : ModelForm::text;
}

std::string missing_parts(const fs::path& folder, ModelForm form) {
  std::vector<std::string> missing;
  for (const char* part : kParts)
    if (!has_part(folder, part, form))
      missing.push_back(part_file(folder, part, form).filename().string());
  return fmt::format("{}", fmt::join(missing, ", "));
}

bool same(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

template <class Numbers>
bool same_numbers(const Numbers& a, const Numbers& b) {
  return std::ranges::equal(a, b, [](double x, double y) { return same(x, y); });
}

bool same_ports(const ColmapCamera& a, const ColmapCamera& b) {
  if (!a.port || !b.port) return a.port.has_value() == b.port.has_value();
  return a.port->index() == b.port->index() &&
         same_numbers(port_numbers(*a.port), port_numbers(*b.port));
}

bool same(const ColmapCamera& a, const ColmapCamera& b) {
  return a.model == b.model && a.width == b.width && a.height == b.height &&
         same_numbers(a.params, b.params) && same_ports(a, b);
}

bool same(const ColmapPoint2D& a, const ColmapPoint2D& b) {
  return same(a.x, b.x) && same(a.y, b.y) && a.point3d == b.point3d;
}

bool same(const ColmapImage& a, const ColmapImage& b) {
  return a.camera == b.camera && a.name == b.name &&
         same_numbers(a.pose.rotation.reshaped(), b.pose.rotation.reshaped()) &&
         same_numbers(a.pose.centre, b.pose.centre) &&
         std::ranges::equal(a.points, b.points,
                            [](const auto& p, const auto& q) { return same(p, q); });
}

bool same(const ColmapPoint3D& a, const ColmapPoint3D& b) {
  const auto key = [](const ColmapTrackElement& e) { return std::pair(e.image, e.point2d); };
  return same_numbers(a.position, b.position) && a.color == b.color && same(a.error, b.error) &&
         std::ranges::is_permutation(a.track, b.track, {}, key, key);
}

template <class T>
std::vector<const T*> by_id(const std::vector<T>& items) {
  std::vector<const T*> sorted;
  for (const T& item : items) sorted.push_back(&item);
  std::ranges::sort(sorted, {}, [](const T* item) { return item->id; });
  return sorted;
}

template <class T>
bool same_part(const std::vector<T>& a, const std::vector<T>& b) {
  return std::ranges::equal(by_id(a), by_id(b),
                            [](const T* x, const T* y) { return x->id == y->id && same(*x, *y); });
}

// True if the file of a part in `form` differs from `items`.
template <class T>
bool differs(const fs::path& folder, ModelForm form, const ModelPart<T>& part,
             const std::vector<T>& items, const Context& context) {
  try {
    return !same_part(part.read(folder, form, context), items);
  } catch (const Error&) {
    return true;
  }
}

// The files of one folder that differ from the model that is read.
struct IgnoredFiles {
  const fs::path& folder;
  ModelForm read;
  const Context& context;
  std::vector<std::string> used = {}, ignored = {};

  template <class T>
  void add(const ModelPart<T>& part, const std::vector<T>& items) {
    const ModelForm other = other_than(read);
    if (!has_part(folder, part.name, other) || !differs(folder, other, part, items, context))
      return;
    used.push_back(part_file(folder, part.name, read).filename().string());
    ignored.push_back(part_file(folder, part.name, other).filename().string());
  }

  void warn() const {
    if (used.empty()) return;
    context.warning("{}: {} {} read, as in COLMAP; ignored: {}, which {} from {}", folder.string(),
                    fmt::join(used, ", "), used.size() == 1 ? "is" : "are",
                    fmt::join(ignored, ", "), used.size() == 1 ? "differs" : "differ",
                    used.size() == 1 ? "it" : "them");
  }
};

}  // namespace

fs::path part_file(const fs::path& folder, const std::string& part, ModelForm form) {
  return folder / (part + (form == ModelForm::text ? ".txt" : ".bin"));
}

bool has_part(const fs::path& folder, const std::string& part, ModelForm form) {
  std::error_code ignored;
  return fs::is_regular_file(part_file(folder, part, form), ignored);
}

bool holds_model(const fs::path& folder, ModelForm form) {
  return std::ranges::all_of(kParts,
                             [&](const char* part) { return has_part(folder, part, form); });
}

ModelForm model_form(const fs::path& folder) {
  for (const ModelForm form : {ModelForm::binary, ModelForm::text})
    if (holds_model(folder, form)) return form;
  fail_in(folder,
          "contains no complete COLMAP model: a text model lacks {}, a binary model lacks {}",
          missing_parts(folder, ModelForm::text), missing_parts(folder, ModelForm::binary));
}

ModelForm cameras_form(const fs::path& folder) {
  for (const ModelForm form : {ModelForm::binary, ModelForm::text})
    if (holds_model(folder, form)) return form;
  for (const ModelForm form : {ModelForm::binary, ModelForm::text})
    if (has_part(folder, "cameras", form)) return form;
  fail_in(folder, "has neither cameras.txt nor cameras.bin");
}

void warn_of_ignored_cameras(const fs::path& folder, ModelForm read,
                             const std::vector<ColmapCamera>& cameras, const Context& context) {
  IgnoredFiles ignored{folder, read, context};
  ignored.add(kCameras, cameras);
  ignored.warn();
}

void warn_of_ignored_files(const fs::path& folder, ModelForm read, const ColmapModel& model,
                           const Context& context) {
  IgnoredFiles ignored{folder, read, context};
  ignored.add(kCameras, model.cameras);
  ignored.add(kImages, model.images);
  ignored.add(kPoints, model.points);
  ignored.warn();
}

}  // namespace axial::io
