// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/rig_frames.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <regex>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/parse_number.h"

namespace axial::pose {
namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// The text in a form whose alphabetical order is the order of the numbers in it: leading zeros are
// removed, and each number is preceded by its length.
std::string in_order_of_numbers(const std::string& text) {
  std::string key;
  for (std::size_t i = 0; i < text.size();) {
    if (!is_digit(text[i])) {
      key += text[i++];
      continue;
    }
    while (i + 1 < text.size() && text[i] == '0' && is_digit(text[i + 1])) ++i;
    const std::size_t begin = i;
    while (i < text.size() && is_digit(text[i])) ++i;
    key += '0';
    key += static_cast<char>(std::min<std::size_t>(i - begin, 100));
    key += text.substr(begin, i - begin);
  }
  return key;
}

// The last number in a text; nothing if there is none or if it is too long.
std::optional<double> last_number(const std::string& text) {
  const auto digit = std::find_if(text.rbegin(), text.rend(), is_digit);
  const auto begin = std::find_if_not(digit, text.rend(), is_digit);
  const std::string number(begin.base(), digit.base());
  if (number.empty() || number.size() > 15) return {};
  return parse_number<double>(number);
}

// A photograph of a rig.
struct Photograph {
  std::size_t camera = 0;  // index into io::Rig::cameras
  std::size_t image = 0;   // index into the images
  std::string key;         // of the frame
};

class FrameMaker {
 public:
  FrameMaker(const io::RigFile& rigs, const std::vector<io::ColmapImage>& images,
             const RigOptions& options, const std::string& file)
      : rigs_(rigs), images_(images), options_(options), file_(file) {}

  std::vector<RigFrame> frames_of(std::size_t rig) const {
    std::vector<RigFrame> frames = rigs_.by_prefix ? frames_by_name(rig) : stated_frames(rig);
    set_times(frames);
    return frames;
  }

 private:
  // The rig and the camera of a name; nothing if no prefix fits.
  std::optional<std::pair<std::size_t, std::size_t>> camera_of(const std::string& name) const {
    std::optional<std::pair<std::size_t, std::size_t>> best;
    std::size_t longest = 0;
    for (std::size_t i = 0; i < rigs_.rigs.size(); ++i)
      for (std::size_t k = 0; k < rigs_.rigs[i].cameras.size(); ++k) {
        const std::string& prefix = rigs_.rigs[i].cameras[k].prefix;
        if (!name.starts_with(prefix) || (best && prefix.size() <= longest)) continue;
        best = {i, k};
        longest = prefix.size();
      }
    return best;
  }

  double time_of(std::size_t image) const {
    const auto found = options_.times.find(images_[image].name);
    if (found == options_.times.end())
      fail("{}: the photograph '{}' of the rig has no time", file_, images_[image].name);
    return found->second;
  }

  std::vector<Photograph> photographs_of(std::size_t rig) const {
    std::vector<Photograph> photographs;
    for (std::size_t i = 0; i < images_.size(); ++i) {
      const std::string& name = images_[i].name;
      const auto camera = camera_of(name);
      if (!camera || camera->first != rig) continue;
      const std::string& prefix = rigs_.rigs[rig].cameras[camera->second].prefix;
      photographs.push_back({camera->second, i, name.substr(prefix.size())});
    }
    return photographs;
  }

  void set_keys_by_pattern(std::vector<Photograph>& photographs) const {
    std::regex pattern;
    try {
      pattern.assign(options_.frames);
    } catch (const std::regex_error& error) {
      fail("{}: the expression of the frames '{}' is not valid: {}", file_, options_.frames,
           error.what());
    }
    if (pattern.mark_count() < 1)
      fail("{}: the expression of the frames '{}' has no group in parentheses", file_,
           options_.frames);
    std::erase_if(photographs, [&](Photograph& photograph) {
      std::smatch match;
      if (!std::regex_search(images_[photograph.image].name, match, pattern) || !match[1].matched)
        return true;
      photograph.key = match[1].str();
      return false;
    });
  }

  // Each photograph gets the key of the nearest photograph of the reference camera.
  void set_keys_by_time(std::size_t rig, std::vector<Photograph>& photographs) const {
    std::map<double, std::string> references;
    for (const Photograph& photograph : photographs)
      if (rigs_.rigs[rig].cameras[photograph.camera].is_reference)
        references.emplace(time_of(photograph.image), images_[photograph.image].name);
    std::vector<double> intervals;
    for (auto next = references.begin(); next != references.end(); ++next)
      if (next != references.begin()) intervals.push_back(next->first - std::prev(next)->first);
    const double most =
        intervals.empty() ? std::numeric_limits<double>::infinity() : mean_median(intervals) / 2;
    for (Photograph& photograph : photographs) {
      const double time = time_of(photograph.image);
      photograph.key = images_[photograph.image].name;
      double nearest = most;
      const auto after = references.lower_bound(time);
      const auto take = [&](std::map<double, std::string>::const_iterator at) {
        if (std::abs(at->first - time) > nearest) return;
        nearest = std::abs(at->first - time);
        photograph.key = at->second;
      };
      if (after != references.end()) take(after);
      if (after != references.begin()) take(std::prev(after));
    }
  }

  std::vector<RigFrame> frames_by_name(std::size_t rig) const {
    std::vector<Photograph> photographs = photographs_of(rig);
    if (!options_.frames.empty())
      set_keys_by_pattern(photographs);
    else if (!options_.times.empty())
      set_keys_by_time(rig, photographs);
    std::map<std::string, RigFrame> frames;
    for (const Photograph& photograph : photographs)
      add(frames[photograph.key], photograph.camera, photograph.image);
    std::vector<RigFrame> result;
    for (auto& [key, frame] : frames) result.push_back(std::move(frame));
    return result;
  }

  std::vector<RigFrame> stated_frames(std::size_t rig) const {
    std::map<std::uint32_t, std::size_t> index;
    for (std::size_t i = 0; i < images_.size(); ++i) index[images_[i].id] = i;
    const io::Rig& stated = rigs_.rigs[rig];
    std::vector<RigFrame> frames;
    for (const io::RigFrame& frame : rigs_.frames) {
      if (frame.rig != stated.id) continue;
      frames.emplace_back();
      for (const io::RigFrame::Image& image : frame.images) {
        const auto found = index.find(image.image);
        if (found == index.end())
          fail("{}: frame {} has the image {}, which the model does not contain", file_, frame.id,
               image.image);
        const auto camera = std::ranges::find(stated.cameras, image.camera, &io::RigCamera::id);
        add(frames.back(), static_cast<std::size_t>(camera - stated.cameras.begin()),
            found->second);
      }
    }
    std::erase_if(frames, [](const RigFrame& frame) { return frame.images.empty(); });
    return frames;
  }

  void add(RigFrame& frame, std::size_t camera, std::size_t image) const {
    for (const RigFrame::Image& other : frame.images)
      if (other.camera == camera)
        fail("{}: the photographs '{}' and '{}' of one camera belong to one frame", file_,
             images_[other.image].name, images_[image].name);
    frame.images.push_back({camera, image});
  }

  const std::string& first_name(const RigFrame& frame) const {
    return images_[frame.images.front().image].name;
  }

  void set_times(std::vector<RigFrame>& frames) const {
    for (RigFrame& frame : frames) std::ranges::sort(frame.images, {}, &RigFrame::Image::camera);
    if (!options_.times.empty()) {
      for (RigFrame& frame : frames) frame.time = time_of(frame.images.front().image);
      std::ranges::stable_sort(frames, {}, &RigFrame::time);
      return;
    }
    std::ranges::stable_sort(
        frames, {}, [&](const RigFrame& frame) { return in_order_of_numbers(key_of(frame)); });
    const std::vector<double> counts = counts_of(frames);
    for (std::size_t i = 0; i < frames.size(); ++i)
      frames[i].time = counts[i] * (options_.interval > 0 ? options_.interval : 1);
  }

  // The name of the first photograph of a frame, without its prefix: names of different cameras
  // must be comparable.
  std::string key_of(const RigFrame& frame) const {
    const std::string& name = first_name(frame);
    const auto camera = rigs_.by_prefix ? camera_of(name) : std::nullopt;
    if (!camera) return name;
    return name.substr(rigs_.rigs[camera->first].cameras[camera->second].prefix.size());
  }

  // The frames counted by the last numbers of their names, or else in their order.
  std::vector<double> counts_of(const std::vector<RigFrame>& frames) const {
    std::vector<double> counts, steps, order;
    for (const RigFrame& frame : frames) {
      order.push_back(static_cast<double>(order.size()));
      const auto number = last_number(key_without_extension(frame));
      if (!number || (!counts.empty() && !(*number > counts.back()))) continue;
      if (!counts.empty()) steps.push_back(*number - counts.back());
      counts.push_back(*number);
    }
    if (counts.size() < frames.size() || steps.empty()) return order;
    const double step = mean_median(steps), first = counts.front();
    for (double& count : counts) count = (count - first) / step;
    return counts;
  }

  std::string key_without_extension(const RigFrame& frame) const {
    const std::string key = key_of(frame);
    return key.substr(0, key.rfind('.'));
  }

  const io::RigFile& rigs_;
  const std::vector<io::ColmapImage>& images_;
  const RigOptions& options_;
  const std::string& file_;
};

RigCamera camera_from(const io::RigCamera& stated, const RigOptions& options,
                      const std::string& file) {
  using Known = RigCamera::Known;
  RigCamera camera;
  camera.name = stated.prefix.empty() ? fmt::format("camera {}", stated.id) : stated.prefix;
  if (stated.is_reference) {
    camera.known = Known::fixed;
    return camera;
  }
  if (!stated.pose && options.poses == Known::fixed)
    fail("{}: states no pose of {} that could be fixed", file, camera.name);
  if (!stated.pose || options.poses == Known::free) return camera;
  camera.known = options.poses;
  camera.stated = camera.now = *stated.pose;
  if (stated.sigma_translation > 0) camera.sigma_translation = stated.sigma_translation;
  if (stated.sigma_rotation > 0)
    camera.sigma_rotation = stated.sigma_rotation * std::numbers::pi / 180;
  return camera;
}

// Puts the reference camera first.
io::RigFile with_reference_first(io::RigFile rigs) {
  for (io::Rig& rig : rigs.rigs)
    std::ranges::stable_sort(rig.cameras, std::greater{}, &io::RigCamera::is_reference);
  return rigs;
}

}  // namespace

std::vector<Rig> make_rigs(const io::RigFile& file_of_rigs,
                           const std::vector<io::ColmapImage>& images, const RigOptions& options,
                           const std::string& file) {
  const io::RigFile stated = with_reference_first(file_of_rigs);
  const FrameMaker maker(stated, images, options, file);
  std::vector<Rig> rigs;
  bool any = false;
  for (std::size_t i = 0; i < stated.rigs.size(); ++i) {
    Rig rig;
    for (const io::RigCamera& camera : stated.rigs[i].cameras)
      rig.cameras.push_back(camera_from(camera, options, file));
    rig.frames = maker.frames_of(i);
    rig.has_seconds = !options.times.empty() || options.interval > 0;
    const bool has_pairs = std::ranges::any_of(
        rig.frames, [](const RigFrame& frame) { return frame.images.size() > 1; });
    any = any || has_pairs;
    if (has_pairs) rigs.push_back(std::move(rig));
  }
  if (!any)
    fail(
        "{}: no two photographs of a rig belong to one frame: names must be equal behind "
        "image_prefix, or state how frames are found",
        file);
  return rigs;
}

}  // namespace axial::pose
