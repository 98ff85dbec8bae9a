// SPDX-License-Identifier: Apache-2.0
/// Computes the maps of a track's descriptors, a few frames at a time; maps shared by several frames are computed once.
/// Used for files (describe_track.h) and for planes in memory (descriptor_frames.h).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"
#include "geometry/uv_maps/descriptor_options.h"
#include "geometry/uv_maps/surface_maps.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom::describe_internal {

/// Scratch memory of one worker for maps and their visible texels.
struct SightScratch : Scratch {
  VisibilityBuffer buffer;
};

/// Frames whose maps are held at the same time.
inline constexpr int kFramesInFlight = 32;

/// Options of the storage of maps.
struct DescriptorMapsOptions {
  bool half = false;       ///< maps of float16 instead of float32
  bool reuse_past = true;  ///< false: computes all velocity maps anew for each frame; same values
};

/// Call for a chunk of frames: PoseFor(), Make(), then Use() for each frame, from any thread.
class DescriptorMaps {
 public:
  /// Counts of the work so far.
  struct Counts {
    int frames_posed = 0, normal_maps = 0, velocity_maps = 0;
    NormalSummary normals;
    int normal_texels_cancelled = 0;  ///< texels whose corners' normals cancelled out
  };
  struct FrameSummary {
    int velocity_maps = 0;  ///< computed for this frame
    double seen = 0;        ///< seen_only: share of the texels
  };
  /// The maps of a frame in the order of the channels, three planes each (seen_only: one map with all planes).
  using Maps = std::span<const std::span<const char>>;

  /// Borrows body and track, and throws as DescriptorFrames' constructor does.
  DescriptorMaps(const BodyModel& body, const Track& track, const DescriptorOptions& options,
                 const DescriptorMapsOptions& how = {});

  /// Poses the body for these frames (ascending, at most kFramesInFlight) and releases memory of others.
  void PoseFor(std::span<const int> frames);
  /// Computes their missing maps.
  void Make();
  /// Calls `use` with the maps of frame i of PoseFor(). They are valid during the call.
  void Use(int i, const std::function<void(Maps, const FrameSummary&)>& use);

  [[nodiscard]] int channels() const { return options_.channels(); }
  [[nodiscard]] size_t plane_size() const { return surface_.num_pixels(); }
  [[nodiscard]] size_t map_bytes() const { return map_bytes_; }
  [[nodiscard]] const UvTexelTable& texels() const { return surface_.texels(); }
  [[nodiscard]] const std::vector<VelocityStencil>& stencils() const { return stencils_; }
  [[nodiscard]] bool HasFit(int t) const { return poses_[t].has_value(); }
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  [[nodiscard]] int PastFrame(int t, int k) const;
  [[nodiscard]] size_t Stride() const { return 3 * size_t(body_.num_vertices()); }
  template <typename Bake>
  Map Baked(Scratch* scratch, const Bake& bake);
  Map NormalMap(int t, Scratch* scratch, NormalSummary* summary, int* cancelled);
  Map VelocityMap(int s, std::span<const float> velocities, Scratch* scratch);
  [[nodiscard]] std::vector<float> AnalyticVelocities(std::span<const int> frames) const;
  [[nodiscard]] MatrixX3d VerticesInCamera(int t) const;
  /// Rotates vectors of frame t from the scene's axes to those of a moving camera, if the options request these.
  void TurnToCamera(int t, std::span<float> planes) const;
  Map OnlySeen(int t, Maps maps, VisibilityBuffer* buffer, double* share) const;

  const BodyModel& body_;
  const Track& track_;
  DescriptorOptions options_;
  DescriptorMapsOptions how_;
  std::vector<std::optional<BodyPose>> poses_;
  SurfaceMaps surface_;
  Skinner skinner_;
  ShapedBody shape_;
  VelocitySkinner velocity_skinner_;
  ScratchPool<SightScratch> scratch_;
  size_t item_size_, map_bytes_;
  Map zero_map_;
  MapPool maps_;
  PosedFrames posed_;
  std::vector<VelocityStencil> stencils_;
  Counts counts_;

  std::vector<int> frames_;             ///< of the last PoseFor()
  std::vector<int> new_velocity_maps_;  ///< frames whose maps Make() will compute
  std::vector<Map> normal_maps_;        ///< of frames_, empty without a fit
  std::vector<int> held_;               ///< frames with a velocity map, ascending
  std::vector<Map> velocity_maps_;      ///< by frame, empty where not held
};

struct SeenTexels {
  std::vector<char> seen;  ///< W·H, not 0: seen; a gutter texel follows the adjacent texels of its chart
  double share = 0;        ///< of the texels inside the charts
};

/// Finds the texels visible in a frame. `buffer` is scratch memory.
SeenTexels FindSeenTexels(const UvTexelTable& table, const BodyModel& body, const MatrixX3d& vertices_in_camera,
                          const Camera& camera, VisibilityBuffer* buffer);

/// Concatenates the maps (each of three planes of items of `item_size` bytes), zero at texels that are not seen.
std::vector<char> KeepSeen(const UvTexelTable& table, const std::vector<char>& seen,
                           std::span<const std::span<const char>> maps, size_t item_size);

}  // namespace bodyloom::describe_internal
