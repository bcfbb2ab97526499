// SPDX-License-Identifier: GPL-3.0-or-later
#include "cameras/private/image_names.h"

#include <filesystem>
#include <set>

namespace axial::io {
namespace {

// The entry that matches the longest end of `name`. An end that is shorter than `name` and in
// `taken` does not count.
ByImage::const_iterator longest_entry(const ByImage& entries, const std::string& name,
                                      const std::set<std::string>& taken) {
  for (std::size_t begin = 0;;) {
    const std::string end = name.substr(begin);
    const auto entry = entries.find(end);
    if (entry != entries.end() && (begin == 0 || !taken.contains(end))) return entry;
    const std::size_t slash = name.find('/', begin);
    if (slash == std::string::npos) return entries.end();
    begin = slash + 1;
  }
}

}  // namespace

ByImage::const_iterator entry_of(const ByImage& entries, const std::string& image_name) {
  return longest_entry(entries, image_name, {});
}

std::vector<ByImage::const_iterator> entries_of_all(const ByImage& entries,
                                                    std::span<const std::string> names,
                                                    const std::string& where) {
  std::vector<ByImage::const_iterator> found(names.size(), entries.end());
  if (entries.empty()) return found;
  const std::set<std::string> whole(names.begin(), names.end());
  std::map<std::string, std::string> image_of;
  for (std::size_t i = 0; i < names.size(); ++i) {
    found[i] = longest_entry(entries, names[i], whole);
    if (found[i] == entries.end()) continue;
    const auto [image, first] = image_of.emplace(found[i]->first, names[i]);
    if (!first && image->second != names[i])
      fail("{}{} matches {} and {}: give more of the path", where, found[i]->first, image->second,
           names[i]);
  }
  return found;
}

ByImage entries_for(const std::vector<std::string>& names, const std::vector<std::string>& paths,
                    const std::vector<std::string>& values, const std::string& otherwise) {
  ByImage entries;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (values[i] != otherwise) entries[names[i]] = values[i];
  // An image with a longer name would otherwise get the entry of a shorter name.
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto entry = entry_of(entries, names[i]);
        values[i] == otherwise && entry != entries.end())
      entries[entry->first == names[i] ? paths[i] : names[i]] = values[i];
  std::set<std::string> taken;
  ByImage of_paths;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto entry = entry_of(entries, paths[i]);
    if (entry == entries.end() || entry->second != values[i]) continue;
    if (entry->first != names[i] || !taken.insert(names[i]).second) of_paths[paths[i]] = values[i];
  }
  entries.merge(of_paths);
  return entries;
}

void for_each_entry(Scene& scene, const ByImage& entries, const std::string& file,
                    const std::string& key, const UseEntry& use, const Context& context) {
  std::vector<std::string> names;
  for (const SceneImage& image : scene.images)
    names.push_back(std::filesystem::path(image.path).generic_string());
  const auto found = entries_of_all(entries, names, fmt::format("{}: {}.", file, key));
  std::set<std::string> used;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (found[i] != entries.end()) used.insert(found[i]->first);
    use(scene.images[i], found[i]);
  }
  for (const auto& [name, unused] : entries)
    if (!used.contains(name)) context.warning("{}: no image matches images.{}", file, name);
}

}  // namespace axial::io
