// SPDX-License-Identifier: Apache-2.0
/// Cuts the garment of a person of Gaussians from its stored measures and simulates it along tracks.
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

/// Bones of a garment's nodes in the frames of a track.
struct GarmentBones {
  MatrixX3d as_sewn;                         ///< K×3, rest space
  std::vector<std::vector<float>> of_frame;  ///< T of K×12, camera frame: render/gaussian_avatar/cloth_bones.h
};

class WornGarment {
 public:
  /// Cuts the garment on the shape `betas` of `body`. Throws std::invalid_argument when the offsets are not the body's,
  /// or the garment cannot be cut.
  WornGarment(const BodyModel& body, const Eigen::VectorXd& betas, const AvatarGarment& garment);

  [[nodiscard]] const LooseGarment& mesh() const { return mesh_; }
  [[nodiscard]] const ClothNodes& nodes() const { return nodes_; }

  /// Simulates the garment on the person in the track's motion, with the person's own shape. Frames without a result
  /// repeat the frame before. Throws std::invalid_argument as ClothRun, Cancelled.
  [[nodiscard]] GarmentBones Along(const Track& track, const PipelineCallbacks& callbacks) const;
  /// As Along(), for several perturbed runs (geometry/cloth/cloth_run.h), the first equal to Along(); 1 to
  /// kMaxClothRuns.
  [[nodiscard]] std::vector<GarmentBones> RunsAlong(const Track& track, int runs, int num_threads,
                                                    const PipelineCallbacks& callbacks) const;

 private:
  BodyModel clothed_;
  LooseGarment mesh_;
  ClothNodes nodes_;
};

/// The stored form of clothes found in a clip, which must have a garment.
AvatarGarment GarmentOf(const BodyModel& body, const Eigen::VectorXd& betas, const ClipClothes& clothes);

/// Cuts a stored garment. Throws std::runtime_error naming `where` when its nodes differ from the stored ones.
WornGarment CutAnew(const BodyModel& body, const Eigen::VectorXd& betas, const AvatarGarment& garment,
                    const std::string& where);

}  // namespace bodyloom
