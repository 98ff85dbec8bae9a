// SPDX-License-Identifier: Apache-2.0
/// Memory that the workers of DescriptorMaps share, so that none is allocated for every map.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "bodyloom/geometry/normals.h"

namespace bodyloom::describe_internal {

/// Three planes as they go to the file.
using Map = std::vector<char>;

/// What one worker needs to make maps.
struct Scratch {
  NormalScratch normals;
  std::vector<float> vertices, padded, planes;  ///< V×3, V×4, three planes
};

/// Hands out scratch memory, one a worker at a time. ScratchType is Scratch or derives from it.
template <typename ScratchType>
class ScratchPool {
 public:
  ScratchPool(int num_vertices, int num_pixels) : num_vertices_(num_vertices), num_pixels_(num_pixels) {}
  std::unique_ptr<ScratchType> Take() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<ScratchType> scratch = std::move(free_.back());
        free_.pop_back();
        return scratch;
      }
    }
    auto scratch = std::make_unique<ScratchType>();
    scratch->vertices.resize(3 * size_t(num_vertices_));
    scratch->padded.resize(4 * size_t(num_vertices_));
    scratch->planes.resize(3 * size_t(num_pixels_));
    return scratch;
  }
  void Return(std::unique_ptr<ScratchType> scratch) {
    const std::lock_guard<std::mutex> lock(mutex_);
    free_.push_back(std::move(scratch));
  }

 private:
  int num_vertices_, num_pixels_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<ScratchType>> free_;
};

/// Room for maps: one that is no longer needed, or a new one. Either is zero where no texel is.
class MapPool {
 public:
  explicit MapPool(size_t map_bytes) : map_bytes_(map_bytes) {}
  Map Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (free_.empty()) return Map(map_bytes_, 0);
    Map map = std::move(free_.back());
    free_.pop_back();
    return map;
  }
  /// Leaves `map` empty; an empty one is not kept.
  void Return(Map* map) {
    if (map->empty()) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    free_.push_back(std::move(*map));
    map->clear();
  }

 private:
  size_t map_bytes_;
  std::mutex mutex_;
  std::vector<Map> free_;
};

}  // namespace bodyloom::describe_internal
