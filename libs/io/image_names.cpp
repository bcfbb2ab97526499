// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image_names.h"

namespace axial::io {

ByImage::const_iterator entry_of(const ByImage& entries, const std::string& image_name) {
  auto entry = entries.find(image_name);
  for (std::size_t slash = image_name.find('/');
       entry == entries.end() && slash != std::string::npos;
       slash = image_name.find('/', slash + 1))
    entry = entries.find(image_name.substr(slash + 1));
  return entry;
}

ByImage entries_for(const std::vector<std::string>& names, const std::vector<std::string>& values,
                    const std::string& otherwise) {
  ByImage entries;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (values[i] != otherwise) entries[names[i]] = values[i];
  // Without an entry of its own an image would take that of a shorter name.
  for (std::size_t i = 0; i < names.size(); ++i)
    if (values[i] == otherwise && entry_of(entries, names[i]) != entries.end())
      entries[names[i]] = values[i];
  return entries;
}

}  // namespace axial::io
