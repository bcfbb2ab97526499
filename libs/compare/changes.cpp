// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/changes.h"

#include <algorithm>
#include <cmath>

#include "base/order_statistics.h"
#include "compare/height_map.h"

namespace axial::compare {
namespace {

// Marks of pixels while regions are searched, besides the classes.
constexpr std::uint8_t kRefused = 3;               // in a region that is too small
constexpr std::uint8_t kUnseen = 4;                // not seen by a survey, in no region
constexpr std::uint8_t kCounted = 16, kAtRim = 8;  // in a volume: pixels of regions, others

struct Pixel {
  int y, x;
};

// What the pixels of a volume add up to.
struct Sums {
  double difference = 0, variance = 0;  // sums [m], [m^2]
  Vector6d row = Vector6d::Zero();      // of derivatives by the motion
  std::int64_t pixels = 0;              // without the rim

  void add(const Sums& other) {
    difference += other.difference;
    variance += other.variance;
    row += other.row;
    pixels += other.pixels;
  }
};

class Search {
 public:
  Search(const cv::Mat1f& difference, const cv::Mat1f& sigma, const VolumeFacts& facts,
         const ChangeOptions& options)
      : difference_(difference), sigma_(sigma), facts_(facts), options_(options) {
    changes_.classes = cv::Mat1b(difference.size(), kUnchanged);
  }

  Changes run() {
    std::vector<Pixel> seeds;
    mark_not_compared();
    for (int y = 0; y < difference_.rows; ++y)
      for (int x = 0; x < difference_.cols; ++x) {
        if (changes_.classes(y, x) == kUnchanged && is_larger({y, x}, options_.strong) &&
            mark_region({y, x}))
          seeds.push_back({y, x});
      }
    for (std::uint8_t& mark : changes_.classes)
      if (mark == kRefused) mark = kUnchanged;
    for (const Pixel& seed : seeds)
      if ((mark(seed) & kCounted) == 0) measure(seed);  // unseen pixels may join two regions
    finish();
    return std::move(changes_);
  }

 private:
  void mark_not_compared() {
    for (int y = 0; y < difference_.rows; ++y)
      for (int x = 0; x < difference_.cols; ++x) {
        if (std::isnan(difference_(y, x)))
          changes_.classes(y, x) = kNotCompared;
        else if (!facts_.unseen.empty() && facts_.unseen(y, x) > 0)
          changes_.classes(y, x) = kUnseen;
      }
  }

  std::uint8_t& mark(const Pixel& p) { return changes_.classes(p.y, p.x); }
  double difference(const Pixel& p) const { return static_cast<double>(difference_(p.y, p.x)); }
  double sigma(const Pixel& p) const { return static_cast<double>(sigma_(p.y, p.x)); }
  bool came(const Pixel& p) const { return difference(p) > 0; }
  bool is_larger(const Pixel& p, double limit) const {
    return std::abs(difference(p)) > limit * sigma(p);
  }

  template <class Visit>
  void for_neighbours(const Pixel& p, const Visit& visit) const {
    for (int y = std::max(0, p.y - 1); y <= std::min(difference_.rows - 1, p.y + 1); ++y)
      for (int x = std::max(0, p.x - 1); x <= std::min(difference_.cols - 1, p.x + 1); ++x)
        if (y != p.y || x != p.x) visit(Pixel{y, x});
  }

  // Collects in reached_ the pixels that are connected to `seed` by pixels that `belongs` accepts.
  // `belongs` must accept a pixel once.
  template <class Belongs>
  void reach(const Pixel& seed, const Belongs& belongs) {
    reached_.clear();
    if (belongs(seed)) reached_.push_back(seed);
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      const Pixel inner = reached_[i];  // a copy: reached_ grows
      for_neighbours(inner, [&](const Pixel& p) {
        if (belongs(p)) reached_.push_back(p);
      });
    }
  }

  // Marks the pixels of the region of `seed`. False if the region is too small.
  bool mark_region(const Pixel& seed) {
    const bool seed_came = came(seed);
    const std::uint8_t kind = seed_came ? kCame : kGone;
    reach(seed, [&](const Pixel& p) {
      if (mark(p) != kUnchanged || came(p) != seed_came || !is_larger(p, options_.weak))
        return false;
      mark(p) = kind;
      return true;
    });
    const auto strong = std::ranges::count_if(
        reached_, [&](const Pixel& p) { return is_larger(p, options_.strong); });
    if (strong >= options_.least_pixels) {
      add_unseen(kind);
      return true;
    }
    for (const Pixel& p : reached_) mark(p) = kRefused;
    return false;
  }

  // The median of the absolute differences of the pixels in reached_.
  double median_difference() const {
    std::vector<double> differences;
    differences.reserve(reached_.size());
    for (const Pixel& p : reached_) differences.push_back(std::abs(difference(p)));
    return upper_median(std::move(differences));
  }

  // Adds the unseen pixels that are connected to the region in reached_, unless there are more of
  // them than a quarter of the region. Differences larger than twice the median of the region do
  // not belong to it.
  void add_unseen(std::uint8_t kind) {
    if (facts_.unseen.empty()) return;
    const std::size_t seen = reached_.size(), most = seen + seen / 4;
    const double limit = 2 * median_difference();
    for (std::size_t i = 0; i < reached_.size() && reached_.size() <= most; ++i) {
      const Pixel inner = reached_[i];
      for_neighbours(inner, [&](const Pixel& p) {
        if (mark(p) != kUnseen || came(p) != (kind == kCame) || !is_larger(p, options_.weak) ||
            std::abs(difference(p)) > limit)
          return;
        mark(p) = kind;
        reached_.push_back(p);
      });
    }
    if (reached_.size() <= most) return;
    for (std::size_t i = seen; i < reached_.size(); ++i) mark(reached_[i]) = kUnseen;
  }

  Eigen::Vector3d place(const Pixel& p) const {
    return facts_.grid.centre(p.y, p.x, facts_.registration.motion.centre.z());
  }

  // The slope is left out: over a region, rises and falls cancel.
  void add(const Pixel& p, Sums& sums) const {
    sums.difference += difference(p);
    sums.variance += sigma(p) * sigma(p);
    sums.row += height_row(place(p) - facts_.registration.motion.centre, {0, 0});
  }

  void measure(const Pixel& seed) {
    Region region;
    region.came = came(seed);
    const std::uint8_t kind = mark(seed);
    reach(seed, [&](const Pixel& p) {
      if (mark(p) != kind) return false;
      mark(p) = kind | kCounted;
      return true;
    });
    Sums sums;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Pixel& p : reached_) {
      add(p, sums);
      middle += place(p);
      region.largest = std::max(region.largest, std::abs(difference(p)));
    }
    sums.pixels = std::ssize(reached_);
    middle /= static_cast<double>(sums.pixels);
    region.x = middle.x(), region.y = middle.y();
    add_rim(sums);
    region.size = volume_of(sums, region.came ? 1 : -1);
    changes_.regions.push_back(region);
    (region.came ? came_ : gone_).add(sums);
    net_.add(sums);
  }

  // Adds the pixels around those in reached_.
  void add_rim(Sums& sums) {
    for (int ring = 0; ring < options_.rim; ++ring) {
      std::vector<Pixel> next;
      for (const Pixel& inner : reached_)
        for_neighbours(inner, [&](const Pixel& p) {
          if (mark(p) != kUnchanged) return;
          mark(p) = kAtRim;
          add(p, sums);
          next.push_back(p);
        });
      reached_ = std::move(next);
    }
  }

  double deviation(const Sums& sums) const {
    const double registration = sums.row.dot(facts_.registration.covariance * sums.row);
    const double area = facts_.grid.pixel * facts_.grid.pixel;
    return area * std::sqrt(facts_.correlation * sums.variance + std::max(0.0, registration));
  }

  Volume volume_of(const Sums& sums, double sign) const {
    const double area = facts_.grid.pixel * facts_.grid.pixel;
    return {std::max(0.0, sign * sums.difference * area), deviation(sums),
            static_cast<double>(sums.pixels) * area};
  }

  void finish() {
    const double area = facts_.grid.pixel * facts_.grid.pixel;
    for (std::uint8_t& mark : changes_.classes) {
      if (mark == kAtRim) mark = kUnchanged;
      if (mark == kUnseen) mark = kNotCompared;
      if (mark != kNotCompared) ++compared_, mark &= static_cast<std::uint8_t>(~kCounted);
    }
    std::ranges::stable_sort(changes_.regions, [](const Region& a, const Region& b) {
      return a.size.volume > b.size.volume;
    });
    changes_.came = volume_of(came_, 1);
    changes_.gone = volume_of(gone_, -1);
    changes_.net = net_.difference * area;
    changes_.net_sigma = deviation(net_);
    changes_.area_compared = static_cast<double>(compared_) * area;
  }

  const cv::Mat1f& difference_;
  const cv::Mat1f& sigma_;
  const VolumeFacts& facts_;
  const ChangeOptions& options_;
  Changes changes_;
  std::int64_t compared_ = 0;
  Sums came_, gone_, net_;
  std::vector<Pixel> reached_;
};

}  // namespace

Changes find_changes(const cv::Mat1f& difference, const cv::Mat1f& sigma, const VolumeFacts& facts,
                     const ChangeOptions& options) {
  return Search(difference, sigma, facts, options).run();
}

}  // namespace axial::compare
