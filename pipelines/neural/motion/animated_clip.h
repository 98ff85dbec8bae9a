// SPDX-License-Identifier: Apache-2.0
/// The clip that the motion-dependent renderer animates: a track, or a single-person dataset whose images the result is
/// compared with.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "data_tools/descriptors/person_frames.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "neural/motion/motion_frame.h"
#include "pipelines/neural/motion/motion_data.h"
#include "pipelines/runs/motion_run.h"

namespace bodyloom {

struct AnimatedClipRequest {
  std::string track;     ///< the motion, .npz; empty: that of `data`
  std::string data;      ///< a single-person dataset of the same person; empty: `track` alone
  std::string body;      ///< the track's body; empty: the built-in body
  std::string iuv;       ///< with `data`: as MotionDataRequest::iuv
  std::string view_yaw;  ///< how far the view is turned (pipelines/animate/animation_limits.h)
  std::string freeze;    ///< frames shown repeatedly (pipelines/animate/animation_limits.h); empty: none
  double speed = 1;      ///< playback speed factor
  /// Use the track's own shape instead of that of the run's person (geometry/scene/track_edits.h).
  bool shape_of_track = false;
  int threads = 1;

  /// True if the result is compared with the images of `data`, which needs the original view and timing.
  [[nodiscard]] bool IsScored() const { return !data.empty() && view_yaw.empty() && freeze.empty() && speed == 1; }
};

class AnimatedClip {
 public:
  /// Prepares the clip at the scale of the person in training and at the run's frame rate, as the network's input
  /// includes past frames: a track at another rate is resampled (data_tools/motion/resample_track.h), a clip to be
  /// scored is rejected. The body has the shape of the run's person, unless the clip is scored (its images come with
  /// their own track), the request says otherwise or the run does not store it. Throws std::runtime_error naming the
  /// file that cannot be used or has nothing to animate, RequestError for `view_yaw` and `freeze`.
  AnimatedClip(const AnimatedClipRequest& request, const MotionRun& run);

  /// Frames as shown; repeated frames count repeatedly.
  [[nodiscard]] const Track& track() const { return data_ ? data_->track() : own_frames_->track(); }
  [[nodiscard]] const PersonFrames& frames() const { return data_ ? data_->frames() : *own_frames_; }
  /// Lines for the user about a rate and shape other than the track's.
  [[nodiscard]] const std::string& notes() const { return notes_; }
  /// True if Fill() gives normals.
  [[nodiscard]] bool has_normals() const { return data_ && data_->has_normals(); }
  /// Fills the network's input of frame t, with the truth if the clip is scored.
  void Fill(int t, MotionFrame* frame) const;
  /// The same without the truth.
  void FillMotion(int t, MotionFrame* frame) const;

 private:
  void TakeShapeOf(const MotionRun& run);

  std::unique_ptr<MotionData> data_;
  std::shared_ptr<const BodyModel> body_;
  std::optional<Track> own_track_;  ///< before frames are repeated
  std::optional<PersonFrames> own_frames_;
  std::optional<DenseHistory> own_dense_;
  std::string notes_;
};

}  // namespace bodyloom
