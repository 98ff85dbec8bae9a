// SPDX-License-Identifier: Apache-2.0
/// Reads initial poses of another system for the tracker: those of one person, in the solve's camera, for the body that
/// is fitted.
#pragma once

#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct InitialPoses {
  Motion motion;  ///< one row per frame of the clip, NaN where missing; betas: empty when not of this body
  std::vector<MatrixX3d> landmarks;  ///< instead of the motion: T of 21×3 (body_estimate.h), no rows where missing
  Camera camera;                     ///< pinhole camera of the poses
  std::string system;                ///< "WHAM"
  std::string person;                ///< the file's own name of the person
  int people = 0;                    ///< in the file
  int frames = 0;                    ///< of the clip with a pose
  bool has_shape = false;
};

struct InitialPosesRequest {
  std::string path;
  const BodyModel* body = nullptr;              ///< required
  const KeypointSequence* keypoints = nullptr;  ///< of the tracked person, or null
  Camera camera;                                ///< pinhole, of the solve
  int num_frames = 0;                           ///< of the clip
  int person = 0;                               ///< used without landmarks; 0: the largest and longest in view
};

/// Reads the poses. Of several people in the file, takes the one whose pelvis is at the hips of `keypoints`. Throws
/// std::runtime_error naming the file if it holds nobody, images of another size, frames beyond the clip's, or another
/// number of frames (for systems that do not number them).
InitialPoses ReadInitialPoses(const InitialPosesRequest& request);

}  // namespace bodyloom
