// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: how the files beside a scene refer to images. An image is identified by its
// whole name, a path. An entry may be the end of a path if only one image has that end.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "private/only_for_io.h"

namespace axial::io {

// Maps an image's name, or the end of its path in whole components, to a value.
using ByImage = std::map<std::string, std::string>;

// Returns the entry that matches the longest end of `image_name`; `entries.end()` if none does.
// Only entries_of_all checks whether the same entry matches other images.
ByImage::const_iterator entry_of(const ByImage& entries, const std::string& image_name);

// Returns the entry of each image; `entries.end()` if it has none. The entry with the longest
// matching end is taken, except that an entry that is the whole name of another image does not
// count. Error that starts with `where` and the entry, and names two images, if several images
// share an entry that is the whole name of none.
std::vector<ByImage::const_iterator> entries_of_all(const ByImage& entries,
                                                    std::span<const std::string> names,
                                                    const std::string& where);

// Returns entries that give every image its value: image i has the path `paths[i]`, the name
// `names[i]`, which is the end of that path, and the value `values[i]`. Images without an entry get
// the value `otherwise`, so an entry is written only where it is needed. If two images share a
// name, the entry of the second one is its whole path.
ByImage entries_for(const std::vector<std::string>& names, const std::vector<std::string>& paths,
                    const std::vector<std::string>& values, const std::string& otherwise);

}  // namespace axial::io
