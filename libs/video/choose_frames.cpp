// SPDX-License-Identifier: GPL-3.0-or-later
#include "video/choose_frames.h"

#include <algorithm>
#include <cmath>

#include "base/order_statistics.h"

namespace axial::video {
namespace {

constexpr double kNeighbourSeconds = 0.25;
constexpr double kLeast = 0.75, kMost = 1.25;  // motion between chosen frames, in shares
constexpr double kStart = 0.25;                // motion before the first chosen frame, in shares

// The sharpness of each frame beside that of its neighbours, and of itself.
std::vector<double> relative_sharpness(std::span<const FrameMeasure> frames, double per_second) {
  const auto reach = static_cast<std::size_t>(std::max(1.0, kNeighbourSeconds * per_second));
  std::vector<double> relative;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t begin = i < reach ? 0 : i - reach;
    const std::size_t end = std::min(frames.size(), i + reach + 1);
    std::vector<double> near;
    for (std::size_t k = begin; k < end; ++k) near.push_back(frames[k].sharpness);
    const double usual = upper_median(std::move(near));
    relative.push_back(usual > 0 ? frames[i].sharpness / usual : 1);
  }
  return relative;
}

// A part of the clip: from `begin` up to `end`, without `end`. All its frames except the first have
// a motion.
class Part {
 public:
  Part(std::span<const FrameMeasure> frames, std::span<const double> sharpness,
       const ChoiceRules& rules, std::size_t begin, std::size_t end)
      : frames_(frames), sharpness_(sharpness), rules_(rules), begin_(begin), end_(end) {}

  void choose(std::vector<std::size_t>& chosen) const {
    if (end_ - begin_ < 2) return;
    std::optional<std::size_t> next = sharpest(begin_, 0, kStart, begin_);
    for (; next; next = sharpest(*next, kLeast, kMost, std::nullopt)) chosen.push_back(*next);
  }

 private:
  // The sharpest frame after `from` until which the picture moves by `least` to `most` shares, or
  // `best` if `best` is sharper. If there is none, the first frame beyond.
  std::optional<std::size_t> sharpest(std::size_t from, double least, double most,
                                      std::optional<std::size_t> best) const {
    Motion motion;
    for (std::size_t i = from + 1; i < end_; ++i) {
      motion = then(motion, *frames_[i].motion);
      const double shares = displacement(motion, rules_.aspect) / rules_.share;
      if (shares > most) return best ? best : i;
      if (shares >= least && (!best || sharpness_[i] > sharpness_[*best])) best = i;
    }
    return best;
  }

  std::span<const FrameMeasure> frames_;
  std::span<const double> sharpness_;
  ChoiceRules rules_;
  std::size_t begin_, end_;
};

}  // namespace

Motion then(const Motion& first, const Motion& second) {
  return {second.turn * first.turn, second.turn * first.shift + second.shift};
}

// The displacement of z is (turn - 1) z + shift. The mean of z over the picture is 0, and the mean
// of |z|^2 is (1 + aspect^2) / 12.
double displacement(const Motion& motion, double aspect) {
  const double mean_square = (1 + aspect * aspect) / 12;
  return std::sqrt(std::norm(motion.turn - 1.0) * mean_square + std::norm(motion.shift));
}

std::vector<std::size_t> choose_frames(std::span<const FrameMeasure> frames,
                                       const ChoiceRules& rules) {
  const std::vector<double> sharpness = relative_sharpness(frames, rules.frames_per_second);
  std::vector<std::size_t> chosen;
  for (std::size_t begin = 0, end = 0; begin < frames.size(); begin = end) {
    for (end = begin + 1; end < frames.size() && frames[end].motion;) ++end;
    Part(frames, sharpness, rules, begin, end).choose(chosen);
  }
  return chosen;
}

}  // namespace axial::video
