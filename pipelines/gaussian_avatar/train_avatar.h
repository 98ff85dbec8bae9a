// SPDX-License-Identifier: Apache-2.0
/// Trains a Gaussian avatar from files; implements `bodyloom train avatar`.
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
  int64_t steps = 6000;                      ///< number of training steps
  double minutes = 0;                        ///< above 0: training time, in place of steps
  int skin_side = 176;                       ///< side of the atlas that skin Gaussians lie on, texels
  int loose = 16000;                         ///< maximum number of Gaussians off the skin
  /// Train all steps: no early stopping when validation no longer improves
  /// (render/gaussian_avatar/learning/early_stopping.h). Without validation frames, or with `refine`, there is never
  /// early stopping.
  bool all_steps = false;
  uint64_t seed = 1;
  /// Detect a skirt, dress or coat (render/garment/clip_clothes.h); one that is found is simulated, in training and in
  /// animation.
  bool garment = true;
  /// Refine the poses of the training frames jointly with the avatar (render/gaussian_avatar/learning/pose_refiner.h).
  bool refine = false;
  /// After training, refine the poses of all frames with the avatar fixed, and write the track here, .npz; empty: do
  /// not.
  std::string refined_track;
  int refine_rounds = 30;  ///< passes over each frame in this refinement
  bool resume = false;     ///< resume the run in `out`
};

struct TrainAvatarSummary {
  bool stopped = false;  ///< cancelled; the run can be resumed
  int64_t steps = 0;
  int64_t cooldown_step = 0;    ///< first step of the cool-down of early stopping; 0: not stopped early
  int64_t best_step = 0;        ///< step with the best validation score, whose state is kept; 0: no validation
  double training_seconds = 0;  ///< in steps, with those of the training it continues
  int gaussians = 0, loose = 0, cloth = 0;
  double garment_length_m = 0;                       ///< of the garment found; 0: none
  double loss = 0;                                   ///< mean of the last 100 steps
  std::optional<AvatarScores> training, validation;  ///< of frames spread over the sets; absent: none, or stopped
  /// Scores of the same held-out frames in poses refined on their own images: how well the avatar fits them, not how
  /// well a track predicts them.
  std::optional<AvatarScores> validation_refined;
  StageSeconds seconds;  ///< of this call, not of the training it continues
  std::vector<std::string> written;
};

/// Writes into `out`: config.json, checkpoint.npz (periodically and at the end), avatar.npz, metrics.csv, report.json
/// and preview.png (held-out frames, truth beside result); with refined_track also that track and preview_refined.png,
/// the same frames in poses refined on them. A cancelled training ends with its checkpoint and sets `stopped`. Throws
/// RequestError for a request that contradicts itself or the existing run, std::runtime_error for files that cannot be
/// used and when a loss is not finite.
TrainAvatarSummary TrainAvatar(const TrainAvatarRequest& request, const PipelineCallbacks& callbacks = {});

/// Paths of the avatar and of the checkpoint in a run's folder.
std::string AvatarPath(const std::string& run);
std::string AvatarCheckpointPath(const std::string& run);

}  // namespace bodyloom
