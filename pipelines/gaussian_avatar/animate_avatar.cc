// SPDX-License-Identifier: Apache-2.0
#include "pipelines/gaussian_avatar/animate_avatar.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "data_tools/avatar/avatar_file.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "pipelines/animate/animation_limits.h"
#include "pipelines/animate/background.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"
#include "pipelines/gaussian_avatar/avatar_clip.h"
#include "pipelines/gaussian_avatar/avatar_page.h"
#include "pipelines/gaussian_avatar/avatar_scores.h"
#include "pipelines/gaussian_avatar/shown_avatar.h"
#include "pipelines/report_json.h"
#include "render/gaussian_avatar/avatar_image.h"
#include "render/view/follow_view.h"

namespace bodyloom {
namespace {

class AvatarAnimation {
 public:
  /// `avatar` null: the run is read.
  AvatarAnimation(const LearnedAvatar* avatar, const AnimateAvatarRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks), threads_(ThreadsFor(request.threads)), avatar_(avatar) {}

  AnimateAvatarSummary Run() {
    clock_.Begin("prepare");
    CheckRequest();
    if (avatar_ == nullptr) avatar_ = &read_.emplace(ReadLearnedAvatar(request_.run, request_.body));
    OpenTrack();
    WriteRestPly();
    clock_.Begin("draw");
    DrawFrames();
    if (clip_) ScoreFrames();
    return Finish();
  }

 private:
  [[nodiscard]] std::vector<std::string> OutputFiles() const {
    return {request_.out, request_.ply, request_.posed_ply, request_.report, request_.json};
  }

  void CheckRequest() const {
    if (request_.track.empty() && request_.data.empty()) throw RequestError("expected --track or --data");
    const bool turned = !request_.view_yaw.empty() || !request_.freeze.empty() || request_.size > 0;
    if (!request_.data.empty() && turned) {
      throw RequestError("--data compares with its images: not with --view-yaw, --freeze or --size");
    }
    if (!request_.report.empty() && !request_.view_yaw.empty()) {
      throw RequestError("--report turns by hand: not with --view-yaw");
    }
    if (!request_.set.empty() && turned) {
      throw RequestError("--set writes the track beside the images: not with --view-yaw, --freeze or --size");
    }
    if (!request_.mask.empty() && request_.data.empty()) throw RequestError("--mask goes with --data");
    for (const std::string& path : OutputFiles()) RequireWritable(path);
    const std::string track = request_.motion != nullptr ? "" : request_.track;
    RequireDistinct({track, request_.background, request_.mask, request_.data}, OutputFiles());
    RequireReadable(request_.background, "background");
    RequireReadable(request_.run, "run");
    if (request_.data.empty()) RequireReadable(track, "track");
    if (!request_.pictures.empty()) RequireWritableFolder(request_.pictures);
    if (request_.set.empty()) return;
    RequireWritableFolder(request_.set);
    RequireDistinct({request_.data, request_.run}, {request_.set});
  }

  void OpenTrack() {
    const std::string& from = request_.track.empty() ? request_.data : request_.track;
    ShownMotion motion;
    motion.where = from;
    motion.keeps_shape = request_.shape_of_track;
    motion.view_yaw = request_.view_yaw, motion.freeze = request_.freeze, motion.size = request_.size;
    if (!request_.data.empty()) {
      clip_.emplace(AvatarClipRequest{request_.data, request_.track, request_.mask, request_.body, threads_});
      motion.track = clip_->track();
      motion.keeps_shape = true;  // the person's images come with their own
    } else {
      motion.track = request_.motion != nullptr ? *request_.motion : ReadTrack(request_.track, MovingCamera::kTake);
    }
    motion.track = TrackOnBody(*avatar_->body, std::move(motion.track));
    if (!request_.report.empty() && motion.track.camera.model != CameraModel::kPinhole) {
      throw std::runtime_error(from + ": a track of a weakly perspective camera, expected a pinhole's for --report");
    }
    shown_.emplace(*avatar_, std::move(motion), threads_, callbacks_);
    if (clip_ && avatar_->file.garment) clip_->Wear({shown_->garment()});
    if (request_.report.empty()) return;
    const Track& track = shown_->track();
    page_step_ = AvatarPage::FrameStep(track.num_frames(), avatar_->file.num_bones());
    page_.emplace(avatar_->file.body, avatar_->body->data().faces, shown_->CameraAt(0), EstimatedUp(track),
                  (track.num_frames() + page_step_ - 1) / page_step_);
  }

  /// Frames of a track without times come at kFpsWithoutTimes.
  void AddToPage(int t, bool shows) {
    const std::vector<double>& times = shown_->track().motion.timestamps;
    const double seconds = fps_ > 0 ? times[t] - times.front() : t / kFpsWithoutTimes;
    if (shows) {
      page_->AddFrame(seconds, shown_->frame(), shown_->posed());
    } else {
      page_->AddEmptyFrame(seconds);
    }
  }

  void WritePage() {
    if (!page_) return;
    if (summary_.frames_without_fit == shown_->num_frames()) {
      throw std::runtime_error(request_.track + ": no frame has a fit, there is nothing to show in --report");
    }
    WriteFileAtomically(
        request_.report,
        page_->ToHtml("A person of Gaussians",
                      Concatenate(avatar_->file.body.size(), " Gaussians of ", request_.run, " in the motion of ",
                                  request_.track.empty() ? request_.data : request_.track)));
  }

  void WriteRestPly() const {
    if (request_.ply.empty()) return;
    AvatarFrame rest;
    rest.rest_joints = MatrixX3f::Zero(avatar_->file.num_bones(), 3);
    for (int j = 0; j < avatar_->file.num_bones(); ++j) {
      rest.bones.insert(rest.bones.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    }
    CameraGaussians gaussians;
    PoseGaussians(avatar_->file.body, avatar_->body->data().faces, rest, {.num_threads = threads_}, &gaussians);
    WriteGaussianPly(request_.ply, gaussians);
  }

  void Draw(int t) {
    const Stopwatch watch;
    const SplatImage& image = shown_->Draw(t);
    draw_ms_.push_back(1e3 * watch.seconds());
    pixels_.push_back(static_cast<double>(image.window().area()));
  }

  void DrawFrames() {
    const int count = shown_->num_frames();
    if (!request_.posed_ply.empty() && (request_.posed_frame < 0 || request_.posed_frame >= count)) {
      throw RequestError(Concatenate("--ply-frame ", request_.posed_frame, ": the clip has frames 0 to ", count - 1));
    }
    const int width = shown_->width(), height = shown_->height();
    Background background(request_.background, width, height);
    fps_ = FrameRateWithoutGaps(shown_->track().motion);
    const double fps = fps_ > 0 ? fps_ : kFpsWithoutTimes;
    std::unique_ptr<VideoWriter> video;
    if (!request_.out.empty()) {
      video = std::make_unique<VideoWriter>(request_.out, width, height, fps);
    }
    std::unique_ptr<RenderedDataset> set;
    if (!request_.set.empty()) {
      set = std::make_unique<RenderedDataset>(request_.set, shown_->track(), fps, true, false, SetCommand());
    }
    for (int t = 0; t < count; ++t) {
      callbacks_.Update("drawing", static_cast<double>(t) / count);
      const bool shows = shown_->HasResult(t);
      if (shows) Draw(t);
      if (!shows) ++summary_.frames_without_fit;
      clock_.Begin("write");
      if (!request_.pictures.empty()) WriteFrameImage(t, shows);
      if (page_ && t % page_step_ == 0) AddToPage(t, shows);
      if (video || set) {
        Image whole = background.Next();
        if (shows) LayOver(shown_->image(), &whole);
        if (video) video->Write(whole);
        if (set) set->Add(t, FrameOfSet(shows, std::move(whole)));
      }
      if (shows && !request_.posed_ply.empty() && t == request_.posed_frame) {
        WriteGaussianPly(request_.posed_ply, shown_->posed());
      }
      clock_.Begin("draw");
    }
    if (video) video->Finish();
    if (set) set->Finish();
    WritePage();
    if (!request_.posed_ply.empty() && !shown_->HasResult(request_.posed_frame)) {
      throw std::runtime_error(Concatenate(request_.track, ": frame ", request_.posed_frame, " has no fit to pose"));
    }
    summary_.frames = count;
  }

  [[nodiscard]] std::string SetCommand() const {
    std::string command = "bodyloom animate avatar --run " + request_.run;
    if (!request_.track.empty()) command += " --track " + request_.track;
    if (!request_.data.empty()) command += " --data " + request_.data;
    return command + " --set " + request_.set;
  }

  PersonFrame FrameOfSet(bool shows, Image whole) {
    PersonFrame frame;
    if (shows) frame.labels = LabelsOf(shown_->image(), shown_->GarmentShare(), whole.width, whole.height);
    frame.rgb = std::move(whole);
    return frame;
  }

  void WriteFrameImage(int t, bool shows) const {
    const int width = shown_->width(), height = shown_->height();
    const std::vector<uint8_t> nobody(shows ? 0 : 4 * static_cast<size_t>(width) * height, 0);
    WriteAlphaPng(FrameFile(request_.pictures, t), width, height,
                  shows ? WithAlpha(shown_->image(), width, height) : nobody);
  }

  void ScoreFrames() {
    clock_.Begin("score");
    AvatarScorer scorer;
    for (int t = 0; t < shown_->num_frames(); ++t) {
      const std::vector<TrainingView> views = clip_->ReadViews({t}, AvatarScores::kScoreMargin, false, callbacks_);
      if (views[0].window.empty()) continue;
      AvatarView view;
      view.camera = views[0].camera, view.window = views[0].window, view.options.num_threads = threads_;
      const SplatImage& image = shown_->Draw(views[0].frame, view);
      scorer.Add(views[0], image, shown_->GarmentShare());  // of the image just drawn, so not in one call with Draw()
    }
    summary_.scores = scorer.Means();
  }

  AnimateAvatarSummary Finish() {
    clock_.End();
    summary_.width = shown_->width(), summary_.height = shown_->height();
    summary_.gaussians = avatar_->file.body.size();
    if (!draw_ms_.empty()) summary_.draw_ms = Percentile(draw_ms_, 50), summary_.pixels = Percentile(pixels_, 50);
    summary_.seconds = clock_.seconds();
    summary_.total_seconds = clock_.total();
    for (const std::string& path : {request_.out, request_.pictures, request_.set, request_.ply, request_.posed_ply,
                                    request_.report, request_.json}) {
      if (!path.empty()) summary_.written.push_back(path);
    }
    nlohmann::ordered_json json = {{"frames", summary_.frames},
                                   {"frames_without_fit", summary_.frames_without_fit},
                                   {"picture", {summary_.width, summary_.height}},
                                   {"gaussians", summary_.gaussians},
                                   {"draw_ms_median", summary_.draw_ms},
                                   {"window_pixels_median", summary_.pixels},
                                   {"seconds", ToJson(summary_.seconds)}};
    if (summary_.scores) json["scores"] = ToJson(*summary_.scores);
    WriteReport(request_.json, json);
    return summary_;
  }

  const AnimateAvatarRequest& request_;
  const PipelineCallbacks& callbacks_;
  const int threads_;
  StageClock clock_;
  std::optional<LearnedAvatar> read_;
  const LearnedAvatar* avatar_;
  std::optional<AvatarClip> clip_;
  std::optional<ShownAvatar> shown_;
  std::optional<AvatarPage> page_;
  int page_step_ = 1;  ///< every so many-th frame is on it
  double fps_ = 0;     ///< of the track; 0: it does not say
  std::vector<double> draw_ms_, pixels_;
  AnimateAvatarSummary summary_;
};

}  // namespace

AnimateAvatarSummary AnimateAvatar(const AnimateAvatarRequest& request, const PipelineCallbacks& callbacks) {
  return AvatarAnimation(nullptr, request, callbacks).Run();
}

AnimateAvatarSummary AnimateLearnedAvatar(const LearnedAvatar& avatar, const AnimateAvatarRequest& request,
                                          const PipelineCallbacks& callbacks) {
  AnimateAvatarRequest named = request;
  named.run = avatar.run;
  return AvatarAnimation(&avatar, named, callbacks).Run();
}

}  // namespace bodyloom
