// SPDX-License-Identifier: Apache-2.0
/// Poses of another system as the tracker takes them: one person's, in the camera of the solve, for the body that is
/// fitted.
#pragma once

#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct InitialPoses {
  Motion motion;  ///< a row a frame of the clip, NaN where the system has none; betas: empty when not of this body
  std::vector<MatrixX3d> landmarks;  ///< in place of the motion: T of 21×3 (body_estimate.h), no rows where missing
  Camera camera;                     ///< in which they are meant: a pinhole
  std::string system;                ///< "WHAM"
  std::string person;                ///< the file's own name of the person
  int people = 0;                    ///< in the file
  int frames = 0;                    ///< of the clip that have a pose
  bool has_shape = false;
};

struct InitialPosesRequest {
  std::string path;
  const BodyModel* body = nullptr;              ///< required
  const KeypointSequence* keypoints = nullptr;  ///< of the person who is tracked, or null
  Camera camera;                                ///< pinhole, of the solve
  int num_frames = 0;                           ///< of the clip
  int person = 0;                               ///< without landmarks: which one, 0 the largest and longest in view
};

/// With several people in the file, the one whose pelvis is where `keypoints` have the hips. Throws std::runtime_error
/// naming the file: nobody is there, images of another size, frames beyond the clip's, another number of frames (of
/// systems that do not number them).
InitialPoses ReadInitialPoses(const InitialPosesRequest& request);

}  // namespace bodyloom
