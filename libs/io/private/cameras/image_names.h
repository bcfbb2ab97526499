// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: entries by which the files beside a scene refer to images. The name of an
// image is a path. The key of an entry is the whole name of an image, or an end of the name that no
// other image has.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "private/only_for_io.h"

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

}  // namespace axial::io
