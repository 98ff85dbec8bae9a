// SPDX-License-Identifier: Apache-2.0
/// Renders a person with a trained motion-dependent renderer in any motion; implements `bodyloom animate motion`.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "neural/motion/motion_frame.h"
#include "pipelines/animate/background.h"
#include "pipelines/animate/motion_errors.h"
#include "pipelines/animate/person_segmentation.h"
#include "pipelines/neural/animation.h"
#include "render/image/image.h"
#include "render/lighting/fit_lighting.h"

namespace bodyloom {

// Scores of a rendered clip against the images of the single-person dataset it was rendered for.

/// Scores; absent where not measured.
struct ClipScores {
  MotionScores windows;                              ///< of the person alone, in its window
  std::vector<MotionErrors::Quarter> by_similarity;  ///< empty without a clip to compare the motion with
  struct Composed {
    double psnr_db = 0;      ///< of the whole image
    double rim_psnr_db = 0;  ///< within CompositeScore::kRimPixels of the person's contour
  };
  std::optional<Composed> composed;  ///< over the dataset's own backgrounds
};

/// Accumulates the scores frame by frame.
class ClipScorer {
 public:
  /// `similarity` by frame, or empty (MotionErrors). `set`: the single-person dataset whose whole images are compared;
  /// empty: none. `image`: size of the images written.
  ClipScorer(std::vector<float> similarity, const std::string& set, ImageSize image);

  /// Adds the scores of frame t's window.
  void AddWindow(int t, const MotionFrameScores& scores) { errors_.Add(t, scores); }
  /// Adds frame t's whole image.
  void AddComposed(int t, const Image& composed);

  [[nodiscard]] const MotionErrors& errors() const { return errors_; }
  /// Final scores; `windows`: the renderer's scores of the same frames.
  [[nodiscard]] ClipScores Scores(const MotionScores& windows) const;

 private:
  MotionErrors errors_;
  std::optional<CompositeScore> composed_;
};

nlohmann::ordered_json ToJson(const ClipScores& scores);

/// One of `track` and `data` is given.
struct AnimateMotionRequest : AnimationRequest {
  std::string data;             ///< a dataset of the same person: its motion is shown and the result compared with its
                                ///< images, unless the view is turned, frames are frozen or the speed differs
  std::string iuv;              ///< with `data`: what its pixels show of the body (MotionDataRequest::iuv)
  std::string view_yaw;         ///< rotation of the view, degrees: "30", or "0:360" over the clip
  double speed = 1;             ///< playback speed factor
  bool shape_of_track = false;  ///< poses the track's shape, not that of the person who was trained on
  std::string freeze;           ///< "FRAME:COUNT": repeats the frame COUNT times; empty: none
  std::string background;       ///< an image, a video or a folder behind the person; empty: a plain backdrop
  std::string relight;          ///< new light (pipelines/animate/relight_frames.h); empty: unchanged
  bool true_normals = false;    ///< with `relight` and `data`: use the normals of `data`, not the networks'
  int warmup = 50;              ///< warm-up passes of the first frame through the network
  bool without_past = false;    ///< treat every frame as the first
  bool whole_window = false;    ///< the person may be farther from the body than clothes ever were in training
  std::string like;             ///< with `data`: a dataset or track whose motion each frame's is compared with; of the
                                ///< data that the run was trained on, the frames that it was trained on
  std::string frames;           ///< with `data`: a CSV to write, a line a frame (MotionErrors)
  std::string weights;          ///< with `data`: folder with alexnet and lpips_alex (weights_folder.h); empty: none
  std::string set;              ///< a single-person dataset to write, of the result; empty: none
  std::string set_command;      ///< the command that makes the dataset again, kept in it
};

struct AnimateMotionSummary : AnimationSummary {
  int window_width = 0, window_height = 0;             ///< of the networks' output, pixels
  int shrunk_width = 0, shrunk_height = 0;             ///< of the whole image at the networks' scale
  int64_t descriptors_kept = 0, projections_kept = 0;  ///< reused in frames without motion (MotionRenderer)
  std::optional<FitLightingSummary> light;             ///< of the clip, if it was estimated
  std::optional<ClipScores> scores;                    ///< against the images of `data`
};

/// Renders the request's frames. Throws RequestError for a contradictory request, std::runtime_error for files that
/// cannot be used, Cancelled. The stages of `callbacks` are "light", if the clip's light is estimated, and "rendering".
AnimateMotionSummary AnimateMotion(const AnimateMotionRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
