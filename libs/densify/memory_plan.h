// SPDX-License-Identifier: GPL-3.0-or-later
// The memory of a run. Checks whether max_memory is enough, and divides it among the parts of the
// run: the plan decides how many images are processed at a time and how much is cached. It never
// affects the result. The formula of each stage is defined in the source file of the stage, beside
// the code that allocates the memory.
//
// Every check throws an Error that names the setting of the budget, its value and the least
// necessary value, if the limit is too little. The budget must have a limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "densify/project.h"
#include "scene/scene.h"

namespace axial::densify {

// Checks, before the scene is read, the memory for reading it with the points of the file
// `point_cloud` (empty: none), and for scoring its views. The memory is estimated from the counts
// of images and points in the files. `for_export`: the points are only exported. There is no error
// in two cases:
// - The estimate is at most MemoryBudget::program_bytes(). plan_memory() checks the whole need
//   later.
// - The counts cannot be read. The function that reads the scene reports the fault.
void require_memory_to_read(const survey::Options& survey, const std::filesystem::path& point_cloud,
                            bool for_export, const MemoryBudget& memory);

// Makes the same check for a scene that was read. Call this function before the views are scored.
// The estimate is closer than that of require_memory_to_read(), because it includes the lists of
// neighbours that scoring makes. Throws an Error, too, if a point has a view of an image that does
// not exist.
void require_memory_to_score(const Scene& scene, const survey::Options& survey,
                             const ViewSelectionOptions& selection, const MemoryBudget& memory);

// The least memory [bytes] with which both checks pass, without MemoryBudget::program_bytes().
// `scene`: with the neighbours of its images.
std::uint64_t least_memory_to_prepare(const Scene& scene, const survey::Options& survey,
                                      const ViewOptions& options);

// The largest number of maps that the agreement check compares for one image: the image's own map
// and the maps of up to three source views.
inline constexpr std::size_t kMapsCompared = 4;

// Numbers of images. `references`: the number of images that get depth maps. Each of the next three
// is the largest number of images that a stage needs for one reference, including the reference.
struct ListLengths {
  std::size_t references = 0;
  std::size_t matched = 0;   // the reference and its source views
  std::size_t adjusted = 0;  // the reference and its neighbours in the adjust filter; 0: no filter
  std::size_t fused = 0;     // the reference and its neighbours in fusion
  // The views whose pixels fusion marks as used: all references, or those that a tile needs
  // (most_views_of_a_tile() in tiles.h).
  std::size_t marked = 0;
};

// Returns the numbers for the images and filters of a run. Precondition: views are selected, and
// there is at least one reference (load_project).
ListLengths longest_lists(const Project& project, const MatchOptions& matching,
                          const FusionOptions& fusion);

// Memory [bytes] of the large data. If images differ in size, each number is for the largest.
struct StageBytes {
  std::uint64_t scene = 0;        // of the loaded scene: the memory that is allocated already
  std::uint64_t write_scene = 0;  // while the scene is written, in addition to `scene`
  std::uint64_t decode = 0;       // while an image is read, in addition to `image`
  std::uint64_t image = 0;        // one survey::Pixels (image_store.h)
  std::uint64_t map = 0;          // one DepthMap: depth, normal, confidence
  std::uint64_t depths = 0;       // the depths of a DepthMap alone
  std::uint64_t read_map = 0;     // while a map is read or written, in addition to `map`
  std::uint64_t match = 0;        // matching of one reference, with the resulting map
  std::uint64_t adjust = 0;       // the adjust filter of one reference; 0: no filter
  std::uint64_t fused = 0;        // one map in fusion, with its image if the cloud has colours
  std::uint64_t taken = 0;        // fusion: one bit per pixel of ListLengths::marked views
  std::uint64_t exported = 0;     // pinhole export: while one image is resampled; 0: no export
  std::uint64_t shown = 0;        // pinhole export: the points of all images; 0: no export
  std::uint64_t model = 0;        // the same, while their model is written, in addition
};

// Returns the memory of each stage. `lists`: the result of longest_lists(). StageBytes::scene is
// the memory that the process has allocated at the time of the call.
StageBytes bytes_of_stages(const Project& project, const Options& options,
                           const ListLengths& lists);

// How many images and maps a run may have in memory at the same time.
struct MemoryPlan {
  std::size_t in_flight = 1;      // images that are matched or adjusted at the same time
  std::size_t decodes = 1;        // images that ImageStore::check_all() reads at the same time
  std::size_t cached_images = 0;  // capacity of the ImageStore
  std::size_t cached_depths = 0;  // StageRun::cached_depths (map_stages.h)
  std::size_t cached_maps = 0;    // StageRun::cached_maps
  std::size_t fused_maps = 0;     // FuseOptions::max_maps
  // The least value of fused_maps that suffices for any view and its neighbours.
  std::size_t least_fused_maps = 0;
  std::size_t marked_views = 0;  // views of which fusion can mark each pixel (ListLengths::marked)
  std::size_t fusion_loads = 1;  // FuseOptions::max_loads
  std::size_t exports = 1;       // images resampled at the same time by the pinhole export
};

// Returns the plan for the result of load_project() and for the present number of threads
// (base/parallel.h). The plan is sufficient for the project's largest image and for its longest
// lists of sources and neighbours. A cache has at most 48 entries, unless the images in work need
// more: the memory of a run must not grow with the number of images, and more entries would hardly
// help, because images are processed in order.
// Throws an Error if the allowed memory is too little to process one image at a time, or to write
// the scene while no images are cached.
MemoryPlan plan_memory(const Project& project, const Options& options, const Context& context);

// The least memory [bytes] of a run that processes `in_flight` images at a time, without the loaded
// scene (StageBytes::scene) and without MemoryBudget::program_bytes(). Its caches hold only the
// images and maps in work.
std::uint64_t least_bytes(const StageBytes& bytes, const ListLengths& lists, std::size_t in_flight);

// Returns the plan for at most `threads` images at a time. `room`: the allowed memory [bytes]
// without the loaded scene (StageBytes::scene) and without MemoryBudget::program_bytes().
// Precondition: `room` is at least least_bytes() for one image in flight.
MemoryPlan share_out(const StageBytes& bytes, const ListLengths& lists, std::uint64_t room,
                     std::size_t threads);

}  // namespace axial::densify
