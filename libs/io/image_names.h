// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: what images go by in the files beside a scene. An image's identity is its
// whole name, a path; an entry may be the end of one, if it is the end of one only.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

namespace axial::io {

// An image's name, or the end of its path in whole components, to what is said of it.
using ByImage = std::map<std::string, std::string>;

// The entry that matches the longest end of `image_name`; `entries.end()` if none does. Whether
// another image goes by it, too, only entries_of_all tells.
ByImage::const_iterator entry_of(const ByImage& entries, const std::string& image_name);

// The entry that each of the images goes by; `entries.end()` if none: the one that matches the
// longest end of its name, but for those that are the whole name of another image. Error
// "`where`NAME" with the first two images, if several go by an entry that is the whole name of
// none.
std::vector<ByImage::const_iterator> entries_of_all(const ByImage& entries,
                                                    std::span<const std::string> names,
                                                    const std::string& where);

// Entries by which every image, `paths[i]` with the end `names[i]`, gets `values[i]`: one for each
// that differs from `otherwise`, which images without an entry get. Where two images would go by
// one name, the entry of the second is its whole path.
ByImage entries_for(const std::vector<std::string>& names, const std::vector<std::string>& paths,
                    const std::vector<std::string>& values, const std::string& otherwise);

}  // namespace axial::io
