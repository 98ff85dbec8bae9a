// SPDX-License-Identifier: Apache-2.0
/// Surface maps of one posed body: its unit normals, or its velocities, as three planes over the atlas.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/normals.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"
#include "geometry/uv_maps/uv_bake.h"
#include "geometry/uv_maps/uv_texels.h"

namespace bodyloom::describe_internal {

// Memory that the workers of DescriptorMaps share, so that none is allocated for every map.

/// Three planes in the layout of the file.
using Map = std::vector<char>;

/// Memory of one worker.
struct Scratch {
  NormalScratch normals;
  std::vector<float> vertices, padded, planes;  ///< V×3, V×4, three planes
};

/// Lends scratch memory to workers, each to one worker at a time. ScratchType is Scratch or derives from it.
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

/// Reuses the memory of maps that are no longer needed. A map is zero where there is no texel.
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

/// Immutable and safe to share between threads. Texels that show no surface are not written.
class SurfaceMaps {
 public:
  /// Borrows the body. Throws std::invalid_argument when it has no UV map. `normals`: true if normals will be
  /// requested.
  SurfaceMaps(const BodyModel& body, const UvTexelOptions& texels, NormalWeighting weighting, bool normals);

  [[nodiscard]] const UvTexelTable& texels() const { return table_; }
  [[nodiscard]] size_t num_pixels() const { return static_cast<size_t>(baker_.num_pixels()); }

  /// Bakes the unit normals of vertices (V×3, relative to the root). Returns the number of texels whose corners'
  /// normals cancel out.
  int Normals(std::span<const float> vertices, const PosedSkeleton& skeleton, Scratch* scratch, NormalSummary* summary,
              std::span<float> planes) const;

  /// Bakes the vertices' velocities (V×3).
  void Velocities(std::span<const float> velocities, Scratch* scratch, std::span<float> planes) const;

 private:
  const BodyModel& body_;
  UvTexelTable table_;
  UvBaker baker_;
  MeshNormals normals_;
  MatrixX3f template_normals_;
};

// Posed surfaces of the frames being described; frames that two neighbouring chunks need are posed once.

class PosedFrames {
 public:
  /// Borrows the skinner, the shape and the poses (empty: a frame without a fit). Memory for `room` frames is reserved.
  PosedFrames(const Skinner& skinner, const ShapedBody& shape, const std::vector<std::optional<BodyPose>>& poses,
              int num_vertices, int room);

  /// Poses the frames of `needed` (ascending) that are not held yet and releases all others. Returns the number posed.
  int Need(std::span<const int> needed);

  /// Vertices of a frame in the last Need: V×3, relative to the root.
  [[nodiscard]] std::span<const float> Vertices(int t) const {
    return {vertices_.data() + stride_ * place_of_frame_[t], stride_};
  }
  /// Roots of all frames that were ever posed, by frame.
  [[nodiscard]] std::span<const Eigen::Vector3d> roots() const { return roots_; }

 private:
  const Skinner& skinner_;
  const ShapedBody& shape_;
  const std::vector<std::optional<BodyPose>>& poses_;
  size_t stride_;
  std::vector<Eigen::Vector3d> roots_;
  std::vector<int> place_of_frame_, placed_frames_;
  std::vector<float> vertices_;  ///< of placed_frames_
};

}  // namespace bodyloom::describe_internal
