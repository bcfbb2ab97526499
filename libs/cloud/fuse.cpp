// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/fuse.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "base/error.h"
#include "cloud/crop.h"
#include "cloud/fusion_map.h"
#include "cloud/map_store.h"
#include "cloud/view_fusion.h"

namespace axial::cloud {
namespace {

bool is_processed(const std::optional<FusionPart>& part, std::size_t view) {
  return !part || part->seen_by.empty() || part->seen_by[view];
}

// The data of a view that are kept when its map is evicted.
struct Slot {
  std::uint32_t image = 0;
  int photograph_width = 0;
  std::vector<std::size_t> neighbours;  // other slots
  std::vector<bool> taken;              // pixels that support a point, or were discarded
};

class Fusion {
 public:
  Fusion(const Scene& scene, std::span<const FusionView> views, const FusionProviders& providers,
         const FuseOptions& options)
      : providers_(providers),
        options_(options),
        merge_(options.min_views < 2),
        min_views_(std::min(options.min_views, views.size())),
        fewest_(options.two_if_undisputed ? std::min<std::size_t>(2, min_views_) : min_views_) {
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

  const FusionProviders& providers_;
  const FuseOptions& options_;
  bool merge_;
  std::size_t min_views_;
  std::size_t fewest_;  // the smallest number of views of a point
  std::vector<Slot> slots_;
  std::vector<std::size_t> order_;
};

void Fusion::make_slots(const Scene& scene, std::span<const FusionView> views) {
  std::unordered_map<std::uint32_t, std::size_t> slot_of;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].image >= scene.images.size()) {
      fail("fusion: image {} is not in the scene, which has {} images", views[i].image,
           scene.images.size());
    }
    if (!slot_of.emplace(views[i].image, i).second) {
      fail("fusion: image {} is given twice", views[i].image);
    }
  }
  slots_.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    slots_[i].image = views[i].image;
    slots_[i].photograph_width = scene.images[views[i].image].camera.width;
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
    if (!is_processed(options_.part, i)) continue;
    if (slots_[i].neighbours.size() + 1 >= fewest_) order_.push_back(i);
  }
  std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    if (views[a].rank != views[b].rank) return views[a].rank > views[b].rank;
    return views[a].image < views[b].image;
  });
}

// The slots that are needed to fuse one view: its own slot first, then its neighbours.
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
  if (providers_.load_color) {
    color = providers_.load_color(image);
    if (color.empty()) fail("fusion: image {} has no pixels", image);
  }
  return make_fusion_map(providers_.load_map(image), color);
}

void Fusion::fuse_view(std::size_t reference, const MapStore& store, const CloudSink& sink) {
  std::vector<WorkingView> views;
  for (const std::size_t slot : views_of(reference)) {
    slots_[slot].taken.resize(store.map(slot).pixels());
    const double reduction = static_cast<double>(slots_[slot].photograph_width) /
                             static_cast<double>(store.map(slot).depth.cols);
    views.push_back({slots_[slot].image, &store.map(slot), &slots_[slot].taken, reduction});
  }
  ViewFusion fusion(views);
  for (std::size_t pixel = 0; pixel < store.map(reference).pixels();) {
    pixel = fusion.collect(pixel);
    if (options_.part) fusion.keep_collected_in(options_.part->reach);
    fusion.compare(options_);
    fusion.accept(min_views_);
    if (fusion.size() == 0) continue;
    PointCloud points = fusion.points(options_);
    if (options_.part) crop(points, options_.part->tile);
    if (points.size() > 0) sink(std::move(points));
  }
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
  add(cloud.errors, portion.errors);
  add(cloud.confidences, portion.confidences);
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

std::size_t views_needed(std::span<const FusionView> views, const FusionPart& part) {
  std::unordered_set<std::uint32_t> with_view, needed;
  for (const FusionView& view : views) with_view.insert(view.image);
  const std::optional<FusionPart> of_part(part);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!is_processed(of_part, i)) continue;
    needed.insert(views[i].image);
    for (const std::uint32_t neighbour : views[i].neighbours)
      if (with_view.contains(neighbour)) needed.insert(neighbour);
  }
  return needed.size();
}

std::uint64_t bytes_needed(const FusionSize& size) {
  // One bit per pixel of each view tells whether the pixel is used.
  const std::uint64_t used = size.views * size.pixels / 8;
  return used + size.maps * ((20 + (size.colors ? 3 : 0)) * size.pixels);
}

}  // namespace axial::cloud
