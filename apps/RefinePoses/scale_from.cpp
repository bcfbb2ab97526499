// SPDX-License-Identifier: GPL-3.0-or-later
#include "scale_from.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/parse_number.h"
#include "io/cameras/image_positions.h"
#include "io/cameras/position_file.h"
#include "pose/bundle/known.h"
#include "scene/robust_similarity.h"

namespace axial::apps {
namespace {

using pose::KnownDistance;

const std::string kOption = "--scale-from ";

// The input is valid, but cannot be used with this model.
class NoUse : public Error {
 public:
  using Error::Error;
};

template <class... Args>
[[noreturn]] void no_use(fmt::format_string<Args...> format, Args&&... args) {
  throw NoUse(fmt::format(format, std::forward<Args>(args)...));
}

template <class T>
T number(const std::string& text, const std::string& where) {
  const std::optional<T> value = parse_number<T>(text);
  if (!value) fail("{}: '{}' is not a number", where, text);
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(*value)) fail("{}: '{}' is not finite", where, text);
  return *value;
}

std::optional<std::size_t> find_image(const pose::Bundle& bundle, const std::string& name) {
  const auto found =
      std::find_if(bundle.images.begin(), bundle.images.end(),
                   [&](const pose::BundleImage& image) { return image.name == name; });
  if (found == bundle.images.end()) return std::nullopt;
  return static_cast<std::size_t>(found - bundle.images.begin());
}

std::size_t image_named(const pose::Bundle& bundle, const std::string& name,
                        const std::string& where) {
  const std::optional<std::size_t> image = find_image(bundle, name);
  if (!image) no_use("{}: the model has no image '{}'", where, name);
  return *image;
}

// NAME, NAME, METRES of a list whose names contain commas.
std::vector<std::string> names_with_commas(const std::vector<std::string>& words,
                                           const pose::Bundle& bundle, const std::string& where) {
  const auto joined = [&](std::size_t begin, std::size_t end) {
    return fmt::format("{}", fmt::join(words.begin() + static_cast<std::ptrdiff_t>(begin),
                                       words.begin() + static_cast<std::ptrdiff_t>(end), ","));
  };
  std::vector<std::string> found;
  const std::size_t last = words.size() - 1;
  for (std::size_t i = 1; i < last; ++i) {
    const std::string first = joined(0, i), second = joined(i, last);
    if (!find_image(bundle, first) || !find_image(bundle, second)) continue;
    if (!found.empty()) fail("{}: put names with commas in double quotes", where);
    found = {first, second, words.back()};
  }
  if (found.empty())
    no_use(
        "{}: the model does not contain two images with these names; put names with commas in "
        "double quotes",
        where);
  return found;
}

std::size_t point_named(const pose::Bundle& bundle, const std::string& word,
                        const std::string& where) {
  const auto id = number<std::size_t>(word, where);
  if (std::ranges::find(bundle.points, id, &pose::BundlePoint::source) == bundle.points.end())
    no_use("{}: point {} is not in the model", where, id);
  return id;
}

KnownDistance known_distance(KnownDistance::Between between, const std::string& list, double sigma,
                             const pose::Bundle& bundle, const std::string& where) {
  std::vector<std::string> words = io::split_list(list, where);
  if (words.size() > 3 && between == KnownDistance::Between::images)
    words = names_with_commas(words, bundle, where);
  if (words.size() != 3)
    fail("{}: must give two ends and the distance between them in metres", where);
  KnownDistance known;
  known.between = between;
  const auto end = [&](const std::string& word) {
    return between == KnownDistance::Between::images ? image_named(bundle, word, where)
                                                     : point_named(bundle, word, where);
  };
  known.metres = number<double>(words[2], where);
  known.first = end(words[0]);
  known.second = end(words[1]);
  known.sigma = sigma;
  if (!(known.metres > 0)) fail("{}: {} m is not a distance", where, words[2]);
  if (known.first == known.second) fail("{}: both ends are the same", where);
  if (place_in(bundle, between, known.first) == place_in(bundle, between, known.second))
    no_use("{}: both ends have the same position in the model", where);
  return known;
}

// Positions and the centres of the same images in the model, as columns.
struct Centres {
  Eigen::Matrix3Xd model, known;
  std::vector<std::string> names;
};

Centres centres_of(const io::ImagePositions& positions, const pose::Bundle& bundle) {
  Centres centres;
  centres.model.resize(3, static_cast<Eigen::Index>(positions.found.size()));
  centres.known.resize(3, centres.model.cols());
  // The fit needs no large coordinates, in which differences would lose digits.
  for (std::size_t i = 0; i < positions.found.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const pose::BundleImage& image = bundle.images[positions.found[i].image];
    centres.model.col(column) = image.pose.centre;
    centres.known.col(column) = positions.found[i].position - positions.found[0].position;
    centres.names.push_back(image.name);
  }
  return centres;
}

// Removes positions that do not fit the others, and returns a line for each.
std::vector<std::string> drop_outliers(io::ImagePositions& positions, const pose::Bundle& bundle,
                                       const std::filesystem::path& file) {
  const Centres centres = centres_of(positions, bundle);
  if (relative_width(centres.known) < kLineWidth || relative_width(centres.model) < kLineWidth)
    no_use(
        "{}: the positions lie on one line, about which the rotation of the model is not "
        "determined",
        file.string());
  if (const MirroredFit mirrored = mirrored_fit(centres.model, centres.known); mirrored.better)
    fail("{}: {}", file.string(), mirrored_line(mirrored));
  const RobustSimilarity fit = robust_similarity(centres.model, centres.known);
  if (fit.off_line)
    no_use("{}: {}", file.string(), off_line_sentence(fit, centres.names[*fit.off_line]));
  for (std::size_t k = fit.outliers.size(); k-- > 0;)
    positions.found.erase(positions.found.begin() + static_cast<std::ptrdiff_t>(fit.outliers[k]));
  std::vector<std::string> lines = outlier_lines(fit, centres.names);
  for (const std::string& line : lines) log_warning("{}: {}", file.string(), line);
  return lines;
}

// A survey's list may name photographs that COLMAP found no pose for: skips them with a warning.
// Returns the lines of the positions that do not fit.
std::vector<std::string> read_positions(const std::filesystem::path& file, const ScaleSigma& sigma,
                                        const pose::Bundle& bundle,
                                        std::vector<pose::KnownPosition>& known) {
  std::vector<std::string> names;
  std::vector<Eigen::Vector3d> centres;
  for (const pose::BundleImage& image : bundle.images) {
    names.push_back(image.name);
    centres.push_back(image.pose.centre);
  }
  io::ImagePositions positions = io::positions_of_images(file, names, centres, "the model");
  if (positions.found.size() < 3)
    no_use("{}: contains {} positions of images of the model, at least 3 are needed{}",
           file.string(), positions.found.size(),
           positions.absent.empty() ? "" : "; " + positions.absent.front());
  for (const std::string& line : positions.notes) log_info("{}", line);
  for (const std::string& line : positions.absent) log_warning("{}", line);
  const std::vector<std::string> dropped = drop_outliers(positions, bundle, file);
  const Eigen::Vector3d usual =
      Eigen::Vector3d::Constant(sigma.given ? sigma.metres : kGuessedPositionSigma);
  for (const io::ImagePosition& one : positions.found)
    known.push_back(
        {one.image, one.position, one.sigma.value_or(usual), !one.sigma && !sigma.given});
  return dropped;
}

std::vector<std::string> add(const std::string& scale_from, const ScaleSigma& sigma,
                             const std::filesystem::path& working_folder,
                             const pose::Bundle& bundle, pose::AdjustOptions& adjust) {
  const std::string where = kOption + scale_from;
  const std::size_t colon = scale_from.find(':');
  const std::string kind = scale_from.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : scale_from.substr(colon + 1);
  if (kind == "images")
    adjust.distances.push_back(
        known_distance(KnownDistance::Between::images, rest, sigma.metres, bundle, where));
  else if (kind == "points")
    adjust.distances.push_back(
        known_distance(KnownDistance::Between::points, rest, sigma.metres, bundle, where));
  else if (kind == "positions")
    return read_positions(working_folder / rest, sigma, bundle, adjust.positions);
  else
    fail("{}: must begin with images:, points: or positions:", where);
  return {};
}

}  // namespace

std::vector<std::string> add_known(const std::string& scale_from, const ScaleSigma& sigma,
                                   const std::filesystem::path& working_folder,
                                   const pose::Bundle& bundle, pose::AdjustOptions& adjust,
                                   UnusedInput& unused, const Context& context) {
  if (scale_from.empty()) return {};
  const auto report = [&](const std::string& what) {
    unused.report((what.starts_with(kOption) ? "" : kOption) + what, context);
  };
  try {
    return add(scale_from, sigma, working_folder, bundle, adjust);
  } catch (const NoUse& reason) {
    report(reason.what());
  } catch (const io::UnclearUnit& reason) {
    report(reason.what());
  }
  return {};
}

std::vector<pose::KnownDistance> known_lengths(const std::string& scale_from,
                                               const ScaleSigma& sigma,
                                               const pose::Bundle& bundle) {
  if (scale_from.empty() || scale_from.starts_with("positions:")) return {};
  pose::AdjustOptions adjust;
  try {
    add(scale_from, sigma, {}, bundle, adjust);
  } catch (const NoUse&) {
    return {};
  }
  return adjust.distances;
}

}  // namespace axial::apps
