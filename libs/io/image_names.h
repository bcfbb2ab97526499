// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: what images go by in the files beside a scene.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace axial::io {

// An image's name, or the end of its path in whole components, to what is said of it.
using ByImage = std::map<std::string, std::string>;

// The entry that matches the longest end of `image_name`; `entries.end()` if none does.
ByImage::const_iterator entry_of(const ByImage& entries, const std::string& image_name);

// Entries by which every image, `names[i]`, gets `values[i]`: one for each that differs from
// `otherwise`, which images without an entry get.
ByImage entries_for(const std::vector<std::string>& names, const std::vector<std::string>& values,
                    const std::string& otherwise);

}  // namespace axial::io
