// SPDX-License-Identifier: Apache-2.0
/// Learns a person of Gaussians from files: what `bodyloom train avatar` does.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "pipelines/gaussian_avatar/avatar_clip.h"
#include "pipelines/gaussian_avatar/avatar_scores.h"

namespace bodyloom {

struct TrainAvatarRequest {
  AvatarClipRequest clip;                    ///< threads: 0: all cores
  std::vector<std::string> train, validate;  ///< frames (pipelines/clip_span.h)
  std::string out;                           ///< folder of the run
  int64_t steps = 6000;                      ///< that training takes
  double minutes = 0;                        ///< above 0: it takes so long instead
  int skin_side = 176;                       ///< texels of a side of the atlas that skin Gaussians lie on
  int loose = 16000;                         ///< Gaussians off the skin, at most
  /// Do not end earlier where more steps no longer help the frames for validation
  /// (render/gaussian_avatar/learning/held_out_curve.h). Without such frames, and with `refine`, no training does.
  bool all_steps = false;
  uint64_t seed = 1;
  /// Look for a skirt, dress or coat (render/garment/clip_clothes.h); one that is found is simulated, in training and
  /// whenever the person is shown.
  bool garment = true;
  /// Correct the poses of the frames learned from while the person is learned
  /// (render/gaussian_avatar/learning/pose_refiner.h).
  bool refine = false;
  /// In the end correct those of all frames, with the person as it is, and write the track here, .npz; empty: do not.
  std::string refined_track;
  int refine_rounds = 30;  ///< how often a frame comes then
  bool resume = false;     ///< go on with the run in `out`
};

struct TrainAvatarSummary {
  bool stopped = false;  ///< cancelled; the run can be gone on with
  int64_t steps = 0;
  int64_t landing_step = 0;  ///< since when it was brought to an early end; 0: it was not
  int64_t best_step = 0;  ///< after which the person was best on frames held out, as it is left; 0: nobody asked them
  double training_seconds = 0;  ///< in steps, over all sittings
  int gaussians = 0, loose = 0, cloth = 0;
  double garment_length_m = 0;                       ///< of what was found; 0: none
  double loss = 0;                                   ///< mean of the last steps, at most 100 of them
  std::optional<AvatarScores> training, validation;  ///< of frames spread over them; absent: none, or stopped
  /// Of the same held-out frames, but in poses that were refined on their own pictures: how well the person fits them,
  /// not how well a track predicts them.
  std::optional<AvatarScores> validation_refined;
  StageSeconds seconds;  ///< of this sitting
  std::vector<std::string> written;
};

/// Writes into `out`: config.json, checkpoint.npz (now and then and at the end), avatar.npz, metrics.csv, report.json
/// and preview.png (held-out frames, truth beside result); with refined_track also that and preview_refined.png, the
/// same frames in poses refined on them. A cancelled training ends with its checkpoint and says so.
/// Throws RequestError for a request that contradicts itself or the run that is there, std::runtime_error for files
/// that cannot be used and when a loss is not finite.
TrainAvatarSummary TrainAvatar(const TrainAvatarRequest& request, const PipelineCallbacks& callbacks = {});

/// Of the run in a folder.
std::string AvatarPath(const std::string& run);
std::string AvatarCheckpointPath(const std::string& run);

}  // namespace bodyloom
