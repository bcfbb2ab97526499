// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/fuse.h"

#include <algorithm>
#include <unordered_map>

#include "base/error.h"
#include "base/parallel.h"
#include "cloud/fusion_map.h"
#include "cloud/map_store.h"

namespace axial::cloud {
namespace {

constexpr std::size_t kGrain = 1024;

// Pixels of a view that ask its neighbours at a time: few enough that the answers stay in the
// processor's cache.
constexpr std::size_t kPortion = std::size_t{1} << 16;

// A view with what must outlive its map.
struct Slot {
  std::uint32_t image = 0;
  std::vector<std::size_t> neighbours;  // other slots
  std::vector<bool> taken;              // pixels that support a point, or were proved wrong
};

// One pixel that supports a point: entry `index` of view `view`'s PixelPoints.
struct Support {
  std::uint32_t view;  // 0: the reference; n: its neighbour n - 1
  std::uint32_t index;
};

// The reference's next pixels and what comes of them.
struct Portion {
  std::vector<PixelPoints> views;            // the reference's pixels, then the supports of others
  std::vector<std::vector<Answer>> answers;  // of each neighbour to each of the reference's pixels
  // Those of accepted point i are at [begin[i], begin[i + 1]).
  std::vector<Support> supports;
  std::vector<std::size_t> begin;

  explicit Portion(std::size_t neighbours) : views(neighbours + 1), answers(neighbours) {}

  std::span<const Support> supports_of(std::size_t point) const {
    return std::span(supports).subspan(begin[point], begin[point + 1] - begin[point]);
  }

  void clear() {
    for (PixelPoints& view : views) view.pixels.clear();
    supports.clear();
    begin.assign(1, 0);
  }
};

// Sums up the pixels that support one point.
class Mean {
 public:
  void add(const FusionMap& map, std::uint32_t pixel, const Eigen::Vector3f& point) {
    const auto weight = static_cast<double>(map.weight_at(pixel));
    total_ += weight;
    position_ += weight * point.cast<double>();
    normal_ += weight * map.normal_at(pixel).cast<double>();
    if (map.color.empty()) return;
    const cv::Vec3b bgr = map.color_at(pixel);
    color_ += weight * Eigen::Vector3d(bgr[2], bgr[1], bgr[0]);
  }

  Eigen::Vector3f position() const { return (position_ / total_).cast<float>(); }

  // Towards `camera` if no pixel knows it.
  Eigen::Vector3f normal(const Eigen::Vector3d& camera) const {
    if (normal_.norm() > 1e-6 * total_) return normal_.stableNormalized().cast<float>();
    return (camera - position_ / total_).stableNormalized().cast<float>();
  }

  Rgb color() const {
    Rgb rgb;
    for (int c = 0; c < 3; ++c)
      rgb[static_cast<std::size_t>(c)] =
          static_cast<std::uint8_t>(std::clamp(color_(c) / total_ + 0.5, 0.0, 255.0));
    return rgb;
  }

 private:
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d color_ = Eigen::Vector3d::Zero();
  double total_ = 0;
};

// Insertion keeps the few views of a point, at [begin, end) so far, sorted by image.
void insert_view(PointCloud& cloud, std::size_t begin, std::size_t end, std::uint32_t image,
                 float weight) {
  std::size_t k = end;
  for (; k > begin && cloud.view_images[k - 1] > image; --k) {
    cloud.view_images[k] = cloud.view_images[k - 1];
    cloud.view_weights[k] = cloud.view_weights[k - 1];
  }
  cloud.view_images[k] = image;
  cloud.view_weights[k] = weight;
}

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

  void run(const CloudSink& sink, const ProgressSink& progress) {
    MapStore store(needed_maps(), slots_.size(), {options_.max_maps, options_.max_loads},
                   [this](std::size_t slot) { return load(slot); });
    for (std::size_t step = 0; step < order_.size(); ++step) {
      store.begin_step(step);
      fuse_view(order_[step], store, sink);
      store.end_step(step);
      for (const std::size_t slot : views_of(order_[step]))
        if (!store.needed_later(slot)) slots_[slot].taken = {};
      if (progress) progress(step + 1, order_.size());
    }
  }

 private:
  void make_slots(const Scene& scene, std::span<const FusionView> views);
  void make_order(std::span<const FusionView> views);
  std::vector<std::size_t> views_of(std::size_t reference) const;
  std::vector<std::vector<std::size_t>> needed_maps() const;
  FusionMap load(std::size_t slot) const;
  void fuse_view(std::size_t reference, const MapStore& store, const CloudSink& sink);
  void accept(std::span<Slot* const> views, Portion& portion) const;
  PointCloud averaged(std::span<const FusionMap* const> maps, std::span<Slot* const> views,
                      const Portion& portion) const;

  const FusionProviders& providers_;
  const FuseOptions& options_;
  bool merge_;
  std::size_t min_views_;
  std::vector<Slot> slots_;
  std::vector<std::size_t> order_;
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
}

// The slots that are needed to fuse one view: itself, then its neighbours.
std::vector<std::size_t> Fusion::views_of(std::size_t reference) const {
  std::vector<std::size_t> views{reference};
  const std::vector<std::size_t>& neighbours = slots_[reference].neighbours;
  views.insert(views.end(), neighbours.begin(), neighbours.end());
  return views;
}

std::vector<std::vector<std::size_t>> Fusion::needed_maps() const {
  std::vector<std::vector<std::size_t>> needed;
  for (const std::size_t reference : order_) needed.push_back(views_of(reference));
  return needed;
}

FusionMap Fusion::load(std::size_t slot) const {
  const std::uint32_t image = slots_[slot].image;
  cv::Mat3b color;
  if (providers_.load_color) color = providers_.load_color(image);
  return make_fusion_map(providers_.load_map(image), color);
}

void Fusion::fuse_view(std::size_t reference, const MapStore& store, const CloudSink& sink) {
  std::vector<Slot*> views;
  std::vector<const FusionMap*> maps;
  for (const std::size_t slot : views_of(reference)) {
    views.push_back(&slots_[slot]);
    maps.push_back(&store.map(slot));
    views.back()->taken.resize(maps.back()->pixels());
  }
  const FusionMap& map = *maps[0];
  Portion portion(views.size() - 1);
  std::vector<std::uint32_t>& asking = portion.views[0].pixels;
  for (std::uint32_t pixel = 0; pixel < map.pixels();) {
    portion.clear();
    for (; pixel < map.pixels() && asking.size() < kPortion; ++pixel)
      if (map.depth_at(pixel) > 0 && !views[0]->taken[pixel]) asking.push_back(pixel);
    back_project(map, portion.views[0]);
    for (std::size_t n = 0; n < portion.answers.size(); ++n) {
      portion.answers[n].resize(asking.size());
      ask_neighbour(map, *maps[n + 1], portion.views[0], options_, portion.answers[n]);
    }
    accept(views, portion);
    for (std::size_t n = 1; n < maps.size(); ++n) back_project(*maps[n], portion.views[n]);
    if (portion.begin.size() > 1) sink(averaged(maps, views, portion));
  }
}

// The one serial pass: who comes first gets the pixel.
void Fusion::accept(std::span<Slot* const> views, Portion& portion) const {
  const std::vector<std::uint32_t>& asking = portion.views[0].pixels;
  std::vector<std::size_t> joining;
  std::vector<std::pair<std::size_t, std::uint32_t>> disproved;
  for (std::size_t i = 0; i < asking.size(); ++i) {
    joining.clear();
    disproved.clear();
    for (std::size_t n = 1; n < views.size(); ++n) {
      const Answer answer = portion.answers[n - 1][i];
      if (answer.none() || views[n]->taken[answer.pixel()]) continue;
      if (answer.agrees())
        joining.push_back(n);
      else
        disproved.emplace_back(n, answer.pixel());
    }
    if (joining.size() + 1 < min_views_) continue;
    views[0]->taken[asking[i]] = true;
    portion.supports.push_back({0, static_cast<std::uint32_t>(i)});
    for (const std::size_t n : joining) {
      std::vector<std::uint32_t>& pixels = portion.views[n].pixels;
      portion.supports.push_back(
          {static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(pixels.size())});
      pixels.push_back(portion.answers[n - 1][i].pixel());
      views[n]->taken[pixels.back()] = true;
    }
    for (const auto& [n, pixel] : disproved) views[n]->taken[pixel] = true;
    portion.begin.push_back(portion.supports.size());
  }
}

PointCloud Fusion::averaged(std::span<const FusionMap* const> maps, std::span<Slot* const> views,
                            const Portion& portion) const {
  const std::size_t count = portion.begin.size() - 1;
  PointCloud cloud;
  cloud.positions.resize(count);
  if (options_.normals) cloud.normals.resize(count);
  if (providers_.load_color) cloud.colors.resize(count);
  cloud.view_begin = portion.begin;
  cloud.view_images.resize(portion.supports.size());
  cloud.view_weights.resize(portion.supports.size());
  parallel_for(
      count,
      [&](std::size_t i) {
        Mean mean;
        std::size_t end = portion.begin[i];
        for (const Support& support : portion.supports_of(i)) {
          const FusionMap& map = *maps[support.view];
          const PixelPoints& where = portion.views[support.view];
          const std::uint32_t pixel = where.pixels[support.index];
          mean.add(map, pixel, where.points[support.index]);
          insert_view(cloud, portion.begin[i], end++, views[support.view]->image,
                      map.weight_at(pixel));
        }
        cloud.positions[i] = mean.position();
        if (options_.normals) cloud.normals[i] = mean.normal(maps[0]->pose.centre);
        if (!cloud.colors.empty()) cloud.colors[i] = mean.color();
      },
      kGrain);
  return cloud;
}

}  // namespace

void append(PointCloud& cloud, const PointCloud& portion) {
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  const std::size_t first_view = cloud.view_images.size();
  add(cloud.positions, portion.positions);
  add(cloud.normals, portion.normals);
  add(cloud.colors, portion.colors);
  add(cloud.view_images, portion.view_images);
  add(cloud.view_weights, portion.view_weights);
  for (std::size_t i = 1; i < portion.view_begin.size(); ++i)
    cloud.view_begin.push_back(first_view + portion.view_begin[i]);
}

void fuse(const Scene& scene, std::span<const FusionView> views, const FusionProviders& providers,
          const FuseOptions& options, const CloudSink& sink, const ProgressSink& progress) {
  Fusion(scene, views, providers, options).run(sink, progress);
}

PointCloud fuse(const Scene& scene, std::span<const FusionView> views,
                const FusionProviders& providers, const FuseOptions& options,
                const ProgressSink& progress) {
  PointCloud cloud;
  cloud.view_begin.push_back(0);
  fuse(
      scene, views, providers, options, [&](const PointCloud& portion) { append(cloud, portion); },
      progress);
  return cloud;
}

}  // namespace axial::cloud
