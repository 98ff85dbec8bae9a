// SPDX-License-Identifier: Apache-2.0
/// The garment of a person of Gaussians, cut anew and simulated along tracks.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_nodes.h"
#include "geometry/scene/track.h"
#include "render/garment/clip_clothes.h"
#include "render/gaussian_avatar/avatar_frame.h"

namespace bodyloom {

/// Where a garment's nodes are in the frames of a track.
struct GarmentBones {
  MatrixX3d as_sewn;                         ///< K×3, rest space
  std::vector<std::vector<float>> of_frame;  ///< T of K×12, camera frame: render/gaussian_avatar/cloth_bones.h
};

class WornGarment {
 public:
  /// On the shape `betas` of `body`. Throws std::invalid_argument when the offsets are not the body's, or the garment
  /// cannot be cut.
  WornGarment(const BodyModel& body, const Eigen::VectorXd& betas, const AvatarGarment& garment);

  [[nodiscard]] const LooseGarment& mesh() const { return mesh_; }
  [[nodiscard]] const ClothNodes& nodes() const { return nodes_; }

  /// The garment on the person in the track's motion, whatever shape the track's body has. Frames without a result go
  /// on as the frame before them. Throws std::invalid_argument as ClothRun, Cancelled.
  [[nodiscard]] GarmentBones Along(const Track& track, const PipelineCallbacks& callbacks) const;
  /// So many runs of it (geometry/cloth/cloth_run.h), the first as above; 1 to kMostClothRuns.
  [[nodiscard]] std::vector<GarmentBones> RunsAlong(const Track& track, int runs, int num_threads,
                                                    const PipelineCallbacks& callbacks) const;

 private:
  BodyModel clothed_;
  LooseGarment mesh_;
  ClothNodes nodes_;
};

/// What is stored of clothes found in a clip, which have a garment.
AvatarGarment GarmentOf(const BodyModel& body, const Eigen::VectorXd& betas, const ClipClothes& clothes);

/// A stored garment cut anew. Throws std::runtime_error naming `where` when its nodes are not the stored ones.
WornGarment CutAnew(const BodyModel& body, const Eigen::VectorXd& betas, const AvatarGarment& garment,
                    const std::string& where);

}  // namespace bodyloom
