// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/views_file.h"

#include <string>
#include <unordered_map>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parse_number.h"
#include "base/split.h"

namespace axial::survey {
namespace {

namespace fs = std::filesystem;

// The images by the words that name them in a views file: the ID, the path, and the name of the
// file with and without extension.
class ImageWords {
 public:
  explicit ImageWords(const Scene& scene) {
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
      const SceneImage& image = scene.images[i];
      const fs::path path = image.path;
      ids_[image.id == kNoId ? static_cast<std::uint32_t>(i) : image.id].push_back(i);
      for (const fs::path& name : {path, path.filename(), path.stem()})
        names_[name.string()].push_back(i);
    }
  }

  std::set<std::size_t> named_by(const std::string& word) const {
    std::set<std::size_t> found;
    if (const auto named = names_.find(word); named != names_.end())
      found.insert(named->second.begin(), named->second.end());
    const auto id = parse_number<std::uint32_t>(word);
    if (const auto with_id = id ? ids_.find(*id) : ids_.end(); with_id != ids_.end())
      found.insert(with_id->second.begin(), with_id->second.end());
    return found;
  }

 private:
  std::unordered_map<std::string, std::vector<std::size_t>> names_;
  std::unordered_map<std::uint32_t, std::vector<std::size_t>> ids_;
};

}  // namespace

std::set<std::size_t> images_in(const fs::path& file, const Scene& scene) {
  std::set<std::size_t> images;
  const ImageWords words(scene);
  const std::string text = read_file(file, 1 << 24);
  std::size_t number = 0;
  for (std::string_view line : split(text, '\n')) {
    ++number;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    const std::set<std::size_t> named = words.named_by(std::string(line));
    if (named.empty()) fail_in(file, "line {}: no image has the ID or the name {}", number, line);
    images.insert(named.begin(), named.end());
  }
  return images;
}

}  // namespace axial::survey
