// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/fuse.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "base/error.h"
#include "base/parallel.h"
#include "cloud/fusion_map.h"

namespace axial::cloud {
namespace {

enum class PixelState : std::uint8_t { free, used, deleted };

// A view with what must outlive its map, which is loaded late and dropped early.
struct Slot {
  std::uint32_t image = 0;
  std::vector<std::size_t> neighbours;  // other slots
  std::size_t last_use = 0;             // step after which the map is no longer needed
  std::optional<FusionMap> view;
  std::vector<PixelState> state;
};

// One pixel that supports a point.
struct Support {
  std::uint32_t slot;
  std::uint32_t pixel;
};

// Points that were accepted but not averaged yet: those of point i are at [begin[i], begin[i + 1]).
struct Accepted {
  std::vector<Support> supports;
  std::vector<std::size_t> begin{0};
};

class Fusion {
 public:
  Fusion(const Scene& scene, std::span<const FusionView> views, const FusionProviders& providers,
         const FuseOptions& options)
      : providers_(providers),
        options_(options),
        merge_(options.min_views < 2),
        min_views_(std::min(options.min_views, views.size())) {
    make_slots(scene, views);
    make_order(views);
  }

  PointCloud run(const ProgressSink& progress) {
    cloud_.view_begin.push_back(0);
    for (std::size_t step = 0; step < order_.size(); ++step) {
      fuse_view(order_[step]);
      for (Slot& slot : slots_) {
        if (slot.last_use == step) slot.view.reset();
      }
      if (progress) progress(step + 1, order_.size());
    }
    return std::move(cloud_);
  }

 private:
  void make_slots(const Scene& scene, std::span<const FusionView> views);
  void make_order(std::span<const FusionView> views);
  FusionMap& load(std::size_t slot);
  void fuse_view(std::size_t reference);
  void accept(std::size_t reference, std::span<const std::uint32_t> asking,
              const std::vector<std::vector<Answer>>& answers, Accepted& accepted);
  void append(const Accepted& accepted);
  void average(std::span<const Support> supports, std::size_t point, std::size_t view_begin);

  const FusionProviders& providers_;
  const FuseOptions& options_;
  bool merge_;
  std::size_t min_views_;
  std::vector<Slot> slots_;
  std::vector<std::size_t> order_;
  PointCloud cloud_;
};

void Fusion::make_slots(const Scene& scene, std::span<const FusionView> views) {
  std::unordered_map<std::uint32_t, std::size_t> slot_of;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].image >= scene.images.size()) {
      fail("fusion: image {} of {}", views[i].image, scene.images.size());
    }
    if (!slot_of.emplace(views[i].image, i).second) {
      fail("fusion: image {} is given twice", views[i].image);
    }
  }
  slots_.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    slots_[i].image = views[i].image;
    if (merge_) continue;
    for (const std::uint32_t neighbour : views[i].neighbours) {
      const auto found = slot_of.find(neighbour);
      if (found == slot_of.end() || found->second == i) continue;
      std::vector<std::size_t>& list = slots_[i].neighbours;
      if (std::find(list.begin(), list.end(), found->second) == list.end()) {
        list.push_back(found->second);
      }
    }
  }
}

void Fusion::make_order(std::span<const FusionView> views) {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].neighbours.size() + 1 >= min_views_) order_.push_back(i);
  }
  std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    if (views[a].rank != views[b].rank) return views[a].rank > views[b].rank;
    return views[a].image < views[b].image;
  });
  for (std::size_t step = 0; step < order_.size(); ++step) {
    slots_[order_[step]].last_use = step;
    for (const std::size_t neighbour : slots_[order_[step]].neighbours) {
      slots_[neighbour].last_use = step;
    }
  }
}

FusionMap& Fusion::load(std::size_t index) {
  Slot& slot = slots_[index];
  if (!slot.view) {
    cv::Mat3b color;
    DepthMap map = providers_.load_map(slot.image);
    if (providers_.load_color) color = providers_.load_color(slot.image);
    slot.view = make_fusion_map(std::move(map), std::move(color));
    slot.state.resize(slot.view->pixels(), PixelState::free);
  }
  return *slot.view;
}

void Fusion::fuse_view(std::size_t reference) {
  const FusionMap& view = load(reference);
  for (const std::size_t neighbour : slots_[reference].neighbours) load(neighbour);

  std::vector<std::uint32_t> free;
  for (std::uint32_t pixel = 0; pixel < view.pixels(); ++pixel) {
    const bool is_free = slots_[reference].state[pixel] == PixelState::free;
    if (is_free && view.depth(pixel) > 0) free.push_back(pixel);
  }
  // In portions, so that the answers of large images do not fill the memory.
  constexpr std::size_t kPortion = std::size_t{1} << 19;
  std::vector<std::vector<Answer>> answers(slots_[reference].neighbours.size());
  for (std::size_t begin = 0; begin < free.size(); begin += kPortion) {
    const auto asking = std::span(free).subspan(begin, std::min(kPortion, free.size() - begin));
    for (std::size_t n = 0; n < answers.size(); ++n) {
      answers[n].resize(asking.size());
      ask_neighbour(view, *slots_[slots_[reference].neighbours[n]].view, asking, options_,
                    answers[n]);
    }
    Accepted accepted;
    accept(reference, asking, answers, accepted);
    append(accepted);
  }
}

// The one serial pass: who comes first gets the pixel.
void Fusion::accept(std::size_t reference, std::span<const std::uint32_t> asking,
                    const std::vector<std::vector<Answer>>& answers, Accepted& accepted) {
  const std::vector<std::size_t>& neighbours = slots_[reference].neighbours;
  std::vector<Support> disproved;
  for (std::size_t i = 0; i < asking.size(); ++i) {
    const std::size_t first = accepted.supports.size();
    accepted.supports.push_back({static_cast<std::uint32_t>(reference), asking[i]});
    disproved.clear();
    for (std::size_t n = 0; n < neighbours.size(); ++n) {
      const Answer answer = answers[n][i];
      if (answer.none()) continue;
      if (slots_[neighbours[n]].state[answer.pixel()] != PixelState::free) continue;
      const Support support{static_cast<std::uint32_t>(neighbours[n]), answer.pixel()};
      (answer.agrees() ? accepted.supports : disproved).push_back(support);
    }
    if (accepted.supports.size() - first < min_views_) {
      accepted.supports.resize(first, {0, 0});
      continue;
    }
    for (std::size_t k = first; k < accepted.supports.size(); ++k) {
      slots_[accepted.supports[k].slot].state[accepted.supports[k].pixel] = PixelState::used;
    }
    for (const Support& s : disproved) slots_[s.slot].state[s.pixel] = PixelState::deleted;
    accepted.begin.push_back(accepted.supports.size());
  }
}

void Fusion::append(const Accepted& accepted) {
  const std::size_t count = accepted.begin.size() - 1;
  const std::size_t first = cloud_.size();
  const std::size_t first_view = cloud_.view_images.size();
  cloud_.positions.resize(first + count);
  if (options_.normals) cloud_.normals.resize(first + count);
  if (providers_.load_color) cloud_.colors.resize(first + count);
  cloud_.view_images.resize(first_view + accepted.supports.size());
  cloud_.view_weights.resize(first_view + accepted.supports.size());
  for (std::size_t i = 1; i <= count; ++i) {
    cloud_.view_begin.push_back(first_view + accepted.begin[i]);
  }
  constexpr std::size_t kGrain = 4096;
  parallel_for(
      count,
      [&](std::size_t i) {
        const auto supports =
            std::span(accepted.supports)
                .subspan(accepted.begin[i], accepted.begin[i + 1] - accepted.begin[i]);
        average(supports, first + i, first_view + accepted.begin[i]);
      },
      kGrain);
}

void Fusion::average(std::span<const Support> supports, std::size_t point, std::size_t view_begin) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double total = 0;
  std::size_t count = 0;
  for (const Support& support : supports) {
    const FusionMap& view = *slots_[support.slot].view;
    const float weight = view.weight[support.pixel];
    const auto w = static_cast<double>(weight);
    total += w;
    position += w * view.point[support.pixel].cast<double>();
    normal += w * view.normal[support.pixel].cast<double>();
    if (!view.color.empty()) {
      const cv::Vec3b bgr = view.color_at(support.pixel);
      color += w * Eigen::Vector3d(bgr[2], bgr[1], bgr[0]);
    }
    // Insertion keeps the few views sorted by image.
    std::size_t k = view_begin + count++;
    for (; k > view_begin && cloud_.view_images[k - 1] > slots_[support.slot].image; --k) {
      cloud_.view_images[k] = cloud_.view_images[k - 1];
      cloud_.view_weights[k] = cloud_.view_weights[k - 1];
    }
    cloud_.view_images[k] = slots_[support.slot].image;
    cloud_.view_weights[k] = weight;
  }
  cloud_.positions[point] = (position / total).cast<float>();
  if (!cloud_.normals.empty()) {
    if (!(normal.norm() > 1e-6 * total)) {  // unknown: towards the first view
      normal = slots_[supports[0].slot].view->map.pose.centre - position / total;
    }
    cloud_.normals[point] = normal.stableNormalized().cast<float>();
  }
  if (!cloud_.colors.empty()) {
    for (int c = 0; c < 3; ++c) {
      cloud_.colors[point][static_cast<std::size_t>(c)] =
          static_cast<std::uint8_t>(std::clamp(color(c) / total + 0.5, 0.0, 255.0));
    }
  }
}

}  // namespace

PointCloud fuse(const Scene& scene, std::span<const FusionView> views,
                const FusionProviders& providers, const FuseOptions& options,
                const ProgressSink& progress) {
  return Fusion(scene, views, providers, options).run(progress);
}

}  // namespace axial::cloud
