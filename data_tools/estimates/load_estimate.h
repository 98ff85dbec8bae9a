// SPDX-License-Identifier: Apache-2.0
/// Loads body estimates of other systems in any supported format, recognised by content.
///
/// Read: WHAM's, VIBE's, PromptHMR's and PHALP's or 4D-Humans' joblib pickles, GVHMR's hmr4d_results.pt, GEM's
/// smpl_params.pt and GEM-X's hpe_results.pt, SAM 3D Body's .npz and .json or a folder of them, SAM3DBody-cpp's .csv,
/// and tracks of this project's form (motion/track_io.h). No code in them is run.
#pragma once

#include <string>

#include "data_tools/estimates/body_estimate.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct LoadEstimateOptions {
  int image_width = 0,
      image_height = 0;  ///< of the video, 0 if unknown; WHAM and VIBE need it, PromptHMR's pixels follow it
};

/// Throws std::runtime_error in one line: what was found and what was expected; std::invalid_argument for an image size
/// below 0.
BodyEstimate LoadEstimate(const std::string& path, const LoadEstimateOptions& options = {});
/// The same for the contents of a file; `where` names it in messages.
BodyEstimate EstimateFromBytes(const std::string& bytes, const std::string& where,
                               const LoadEstimateOptions& options = {});

// Tracks as estimates: of another camera model, of a fit to be continued, or written by another program.

/// Frames without a result are missing. For bodies with hands and a face, only SMPL's 21 body joints are used. `where`
/// names the track in messages; throws std::runtime_error when no frame has a result or the poses have neither 72 nor
/// 156, 162 or 165 columns.
BodyEstimate EstimateFromTrack(const Track& track, const std::string& where);

}  // namespace bodyloom
