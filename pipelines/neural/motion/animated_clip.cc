// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/motion/animated_clip.h"

#include <stdexcept>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/motion/resample_track.h"
#include "data_tools/motion/track_io.h"
#include "geometry/base/check.h"
#include "geometry/scene/rig.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/animate/animation_limits.h"
#include "pipelines/body_of_track.h"
#include "pipelines/neural/motion/motion_data.h"
#include "render/uv_maps/posed_track.h"

namespace bodyloom {
namespace {

Track TrackOf(const AnimatedClipRequest& request, const BodyModel& body, double fps, std::string* notes) {
  const Track track = request.data.empty() ? WithStillCamera(body, ReadTrack(request.track, MovingCamera::kTake))
                                           : SinglePersonDataset(request.data).track();
  try {
    const bool at_rate = IsAtRate(track, fps);
    if (!at_rate) {
      *notes += Concatenate("the motion, ", RateText(track), ", is shown at the run's ", fps, " frames a second\n");
    }
    if (request.speed != 1) return PlayedAtSpeed(track, request.speed, at_rate ? 0 : fps);
    return at_rate ? track : ResampleTrack(track, fps);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(request.track + request.data + ": " + error.what());
  }
}

}  // namespace

AnimatedClip::AnimatedClip(const AnimatedClipRequest& request, const MotionRun& run) {
  if (request.IsScored()) {
    MotionDataRequest data;
    data.data = request.data, data.body = request.body;
    data.pixels_per_metre = run.pixels_per_metre;
    data.iuv = request.iuv;
    data.descriptor = run.config.descriptor;
    data.motion = run.motion;
    data.num_threads = request.threads;
    data_ = std::make_unique<MotionData>(data, run.config.profile, run.config.Multiple());
    RequireRate(data_->track(), run.fps, request.data, "its track.npz as --track is shown at that rate");
    return;
  }
  body_ = BodyOfTrack(request.body, request.data.empty() ? ReadTrack(request.track, MovingCamera::kTake)
                                                         : SinglePersonDataset(request.data).track());
  own_track_ = TrackOf(request, *body_, run.fps, &notes_);
  if (!request.shape_of_track) TakeShapeOf(run);
  const double size = PixelsPerMetre(*body_, *own_track_);
  if (!(size > 0)) {
    throw std::runtime_error(request.track + request.data + ": no frame has a result, nothing to animate");
  }
  PersonFramesOptions options;
  options.uv_size = run.config.profile.uv_size;
  options.past = run.past;
  options.motion = run.motion;
  options.window.scale = ScaleToSize(run.pixels_per_metre, size);
  options.window.multiple = run.config.Multiple();
  options.num_threads = request.threads;
  int num_frames = own_track_->num_frames(), first = 0, last = num_frames - 1;
  if (!request.freeze.empty()) {
    const Freeze freeze = ReadFreeze(request.freeze, num_frames);
    options.shown = FrozenAt(num_frames, freeze.frame, freeze.count);
    num_frames += freeze.count, first = freeze.frame, last = freeze.frame + freeze.count;
  }
  options.yaw_deg = ViewAngles(request.view_yaw, num_frames, first, last);
  own_frames_.emplace(*body_, *own_track_, options);
  if (run.config.descriptor == MotionDescriptor::kDense2d) own_dense_.emplace(*own_frames_, run.past);
}

void AnimatedClip::TakeShapeOf(const MotionRun& run) {
  if (!run.betas) {
    notes_ += "the run does not hold its person's shape (runs of earlier versions do not): the track's is posed\n";
    return;
  }
  try {
    Track shaped = WithShape(*body_, *own_track_, *run.betas);
    if (shaped.motion.betas != own_track_->motion.betas) {
      notes_ += "the track is of a person of another shape: its motion is carried over to the run's person\n";
    }
    own_track_ = std::move(shaped);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(std::string("the run's person or the track's does not fit the body (--body): ") +
                             error.what());
  }
}

void AnimatedClip::Fill(int t, MotionFrame* frame) const {
  if (data_) {
    data_->Fill(t, true, frame);
  } else {
    FillMotion(t, frame);
  }
}

void AnimatedClip::FillMotion(int t, MotionFrame* frame) const {
  if (data_) {
    data_->Fill(t, false, frame);
  } else {
    bodyloom::FillMotion(*own_frames_, own_dense_ ? &*own_dense_ : nullptr, nullptr, t, frame);
  }
}

}  // namespace bodyloom
