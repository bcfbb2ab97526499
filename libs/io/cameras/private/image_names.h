// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: entries by which the files beside a scene refer to images. The name of an
// image is a path. The key of an entry is the whole name of an image, or an end of the name that no
// other image has.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "axial/base.h"
#include "base/error.h"
#include "bytes/private/only_for_io.h"
#include "cameras/private/port_json.h"
#include "scene/scene.h"

namespace axial::io {

// Entries by image. Each entry maps the name of an image, or the end of a name in whole path
// components, to a value.
using ByImage = std::map<std::string, std::string>;

// Returns the entry that matches the longest end of `image_name`; `entries.end()` if no entry
// matches. This function does not check whether the entry also matches other images.
// entries_of_all checks this.
ByImage::const_iterator entry_of(const ByImage& entries, const std::string& image_name);

// Returns the entry of each image in `names`; `entries.end()` for an image without an entry. The
// entry of an image is the entry that matches the longest end of its name. An entry that is the
// whole name of another image does not count. Error that starts with `where` and the entry, and
// names two images, if images with different names share an entry.
std::vector<ByImage::const_iterator> entries_of_all(const ByImage& entries,
                                                    std::span<const std::string> names,
                                                    const std::string& where);

// Returns entries that give every image its value. Image i has the path `paths[i]` and the value
// `values[i]`. Its name `names[i]` is the end of its path. Readers give an image without an entry
// the value `otherwise`, so the result contains no entry for such an image unless another entry
// would match it. If two images share a name and need entries, the key of the second image's entry
// is the whole path of the second image.
ByImage entries_for(const std::vector<std::string>& names, const std::vector<std::string>& paths,
                    const std::vector<std::string>& values, const std::string& otherwise);

// The name that stands for no port and for no distortion.
inline constexpr const char* kNone = "none";

// Reads the text at `key`, which is kNone or a name in `defined`. `what`: "port" or "lens", for the
// Error about another name.
template <class Defined>
std::string defined_name(const JsonPlace& place, const std::string& key, const Defined& defined,
                         const char* what) {
  std::string name = place.text(key.c_str());
  if (name != kNone && !defined.contains(name))
    fail("{}.{} is '{}', a {} that is not defined", place.where, key, name, what);
  return name;
}

// Reads an object that gives ends of image names the name of a port or a lens.
template <class Defined>
ByImage names_by_image(const JsonPlace& place, const Defined& defined, const char* what) {
  ByImage images;
  for (const std::string& key : place.keys()) {
    if (key.empty()) fail_in(place.where, "an image name is empty");
    images[key] = defined_name(place, key, defined, what);
  }
  return images;
}

// Calls use(image, entry) for each image of the scene, with the entry of entries_of_all(). Warns
// through `context` of entries that match no image. Messages start with `file`; `key` is the place
// of the entries in it, such as "housing.images".
using UseEntry = std::function<void(SceneImage& image, ByImage::const_iterator entry)>;
void for_each_entry(Scene& scene, const ByImage& entries, const std::string& file,
                    const std::string& key, const UseEntry& use, const Context& context);

}  // namespace axial::io
