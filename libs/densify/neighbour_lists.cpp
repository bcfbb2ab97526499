// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/neighbour_lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/byte_order_mark.h"
#include "base/error.h"
#include "base/parse_number.h"

namespace axial::densify {
namespace {

std::vector<std::uint32_t> numbers_of(const std::string& line, std::size_t images,
                                      const std::string& where) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::vector<std::uint32_t> numbers;
  for (std::string word; words >> word;) {
    const auto number = parse_finite<std::uint32_t>(word);
    if (!number || *number >= images)
      fail_in(where, "'{}' is not an image of the scene, which has {} images", word, images);
    numbers.push_back(*number);
  }
  return numbers;
}

ViewScore given_neighbour(std::uint32_t image) {
  ViewScore score;
  score.image = image;
  score.scale = 1;
  score.angle = 15 * std::numbers::pi_v<float> / 180;
  score.area = 0.5f;
  score.score = 3;
  return score;
}

}  // namespace

std::vector<bool> read_neighbour_lists(const std::filesystem::path& file, Scene& scene,
                                       const Context& context) {
  const std::string bytes = read_file(file);
  std::istringstream text{std::string(without_byte_order_mark(bytes))};
  std::vector<bool> named(scene.images.size(), false);
  std::size_t number = 0;
  for (std::string line; std::getline(text, line);) {
    const std::string where = fmt::format("{}: line {}", file.string(), ++number);
    const std::vector<std::uint32_t> images = numbers_of(line, scene.images.size(), where);
    if (images.empty()) continue;
    if (images.size() == 1) fail_in(where, "image {} has no neighbours", images[0]);
    if (named[images[0]]) fail_in(where, "image {} has a second line", images[0]);
    if (std::find(images.begin() + 1, images.end(), images[0]) != images.end())
      fail_in(where, "image {} is its own neighbour", images[0]);
    named[images[0]] = true;
    for (const std::uint32_t image : images)
      if (!scene.images[image].calibrated)
        context.warning("{}: image {} has no pose and is ignored", where, image);
    std::vector<ViewScore>& neighbours = scene.images[images[0]].neighbours;
    neighbours.clear();
    for (std::size_t i = 1; i < images.size(); ++i) {
      const auto end = images.begin() + static_cast<std::ptrdiff_t>(i);
      const bool repeated = std::find(images.begin(), end, images[i]) != end;
      if (!repeated && scene.images[images[i]].calibrated)
        neighbours.push_back(given_neighbour(images[i]));
    }
  }
  return named;
}

void write_neighbour_lists(const std::filesystem::path& file, const Scene& scene) {
  std::string text;
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const SceneImage& image = scene.images[i];
    if (!image.calibrated || image.neighbours.empty()) continue;
    text += std::to_string(i);
    for (const ViewScore& neighbour : image.neighbours) text += fmt::format(" {}", neighbour.image);
    text += "\n";
  }
  write_atomically(file, text);
}

}  // namespace axial::densify
