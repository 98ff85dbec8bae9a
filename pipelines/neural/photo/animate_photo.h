// SPDX-License-Identifier: Apache-2.0
/// Renders a person from one photo in any motion: what `bodyloom animate photo` does.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/neural/animation.h"
#include "bodyloom/pipelines/neural/photo/photo_appearance.h"
#include "bodyloom/pipelines/neural/photo/photo_input.h"
#include "bodyloom/pipelines/people/background.h"

namespace bodyloom {

/// The body is the photo's; `body` is not looked at.
struct AnimatePhotoRequest : AnimationRequest {
  PhotoRequest photo;              ///< what the person looks like
  std::vector<std::string> views;  ///< more pictures of the person, IMAGE:TRACK[:FRAME] (ParsePhotoRequest)
  LentGarment garment;             ///< both of its parts are given, or none
  PhotoBackground background;
  std::string view_yaw;          ///< degrees that the view is turned by: "30", or "0:360" over the clip
  bool shape_of_motion = false;  ///< the body has the shape of the motion's track; false: the photo's
  bool whole_window = false;     ///< the background of the window is computed too
  std::string texture;           ///< the completed texture to write as an image; empty: not written
};

struct AnimatePhotoSummary : AnimationSummary {
  double texels_seen = 0;        ///< share of the texture that the photos show
  double frames_per_second = 0;  ///< rendered and written
  std::string notes;             ///< lines: what stands in for what, what is missing; they were messages too
};

/// Throws RequestError for a request that contradicts itself, std::runtime_error for files that cannot be used,
/// Cancelled. The stage of `callbacks` is "rendering".
AnimatePhotoSummary AnimatePhoto(const AnimatePhotoRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
