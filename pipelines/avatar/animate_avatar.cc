// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/avatar/animate_avatar.h"
#include "bodyloom/pipelines/avatar/avatar_scores_json.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "bodyloom/data_tools/avatar/alpha_png.h"
#include "bodyloom/data_tools/avatar/avatar_file.h"
#include "bodyloom/data_tools/avatar/gaussian_ply.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/freeze_track.h"
#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/data_tools/motion/shape_track.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/frame_file.h"
#include "bodyloom/data_tools/video/video_writer.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/geometry/base/percentile.h"
#include "bodyloom/pipelines/avatar/avatar_clip.h"
#include "bodyloom/pipelines/avatar/avatar_labels.h"
#include "bodyloom/pipelines/avatar/avatar_page.h"
#include "bodyloom/pipelines/avatar/motion_maps.h"
#include "bodyloom/pipelines/avatar/train_avatar.h"
#include "bodyloom/pipelines/avatar/worn_garment.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/people/animation_limits.h"
#include "bodyloom/pipelines/people/background.h"
#include "bodyloom/pipelines/people/freeze.h"
#include "bodyloom/pipelines/people/rendered_dataset.h"
#include "bodyloom/pipelines/people/view_angles.h"
#include "bodyloom/pipelines/report_json.h"
#include "bodyloom/render/follow_view.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// Lays a picture into one of the whole size.
void LayOver(const SplatPicture& picture, Image* whole) {
  const PixelBox& window = picture.window();
  const std::span<const float> alpha = picture.plane(SplatPicture::kAlpha);
  for (int c = 0; c < 3; ++c) {
    const std::span<const float> plane = picture.plane(static_cast<SplatPicture::Plane>(2 - c));
    for (int y = window.y_begin; y < window.y_end; ++y) {
      for (int x = window.x_begin; x < window.x_end; ++x) {
        const size_t i = window.IndexOf(x, y);
        uint8_t& to = whole->pixel(x, y)[c];
        const float value = 255 * plane[i] + (1 - alpha[i]) * static_cast<float>(to);
        to = static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
      }
    }
  }
}

/// Straight colours and alpha in a picture of the whole size.
std::vector<uint8_t> WithAlpha(const SplatPicture& picture, int width, int height) {
  std::vector<uint8_t> bgra(4 * static_cast<size_t>(width) * height, 0);
  const PixelBox& window = picture.window();
  for (int y = window.y_begin; y < window.y_end; ++y) {
    for (int x = window.x_begin; x < window.x_end; ++x) {
      const size_t i = window.IndexOf(x, y);
      const float alpha = picture.plane(SplatPicture::kAlpha)[i];
      uint8_t* to = bgra.data() + 4 * (static_cast<size_t>(y) * width + x);
      const auto byte = [](float v) { return static_cast<uint8_t>(std::lround(255 * std::clamp(v, 0.0F, 1.0F))); };
      to[3] = byte(alpha);
      if (to[3] == 0) continue;
      for (int c = 0; c < 3; ++c) to[c] = byte(picture.plane(static_cast<SplatPicture::Plane>(2 - c))[i] / alpha);
    }
  }
  return bgra;
}

class AvatarAnimation {
 public:
  AvatarAnimation(const AnimateAvatarRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks), threads_(ThreadsFor(request.threads)) {}

  AnimateAvatarSummary Run() {
    clock_.Begin("prepare");
    CheckRequest();
    OpenAvatar();
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
      throw RequestError("--data compares with its pictures: not with --view-yaw, --freeze or --size");
    }
    if (!request_.report.empty() && !request_.view_yaw.empty()) {
      throw RequestError("--report turns by hand: not with --view-yaw");
    }
    if (!request_.set.empty() && turned) {
      throw RequestError("--set writes the track beside the pictures: not with --view-yaw, --freeze or --size");
    }
    if (!request_.mask.empty() && request_.data.empty()) throw RequestError("--mask goes with --data");
    for (const std::string& path : OutputFiles()) RequireWritable(path);
    RequireDistinct({request_.track, request_.background, request_.mask, request_.data}, OutputFiles());
    RequireReadable(request_.background, "background");
    RequireReadable(request_.run, "run");
    if (!request_.pictures.empty()) RequireWritableFolder(request_.pictures);
    if (request_.set.empty()) return;
    RequireWritableFolder(request_.set);
    RequireDistinct({request_.data, request_.run}, {request_.set});
  }

  void OpenAvatar() {
    const std::string path = fs::is_directory(request_.run) ? AvatarPath(request_.run) : request_.run;
    avatar_ = ReadAvatar(path);
    body_ = BodyOrBuiltin(request_.body);
    if (avatar_.num_joints != body_->num_joints() || avatar_.num_vertices != body_->num_vertices() ||
        avatar_.num_faces != body_->num_faces()) {
      throw std::runtime_error(Concatenate(path, ": was learned on a body of ", avatar_.num_joints, " joints, ",
                                           avatar_.num_vertices, " vertices and ", avatar_.num_faces,
                                           " faces, the one given (--body) has ", body_->num_joints(), ", ",
                                           body_->num_vertices(), " and ", body_->num_faces()));
    }
  }

  void OpenTrack() {
    const std::string& from = request_.track.empty() ? request_.data : request_.track;
    if (!request_.data.empty()) {
      clip_.emplace(AvatarClipRequest{request_.data, request_.track, request_.mask, request_.body, threads_});
      track_ = clip_->track();
    } else {
      RequireReadable(request_.track, "track");
      track_ = ReadTrack(request_.track);
    }
    try {
      // The person's pictures come with their own shape.
      if (!request_.shape_of_track && !clip_) track_ = WithShape(*body_, track_, avatar_.betas);
      int first = 0, last = track_.num_frames() - 1;
      std::vector<int> shown;
      moving_ = track_;
      if (!request_.freeze.empty()) {
        const Freeze freeze = ReadFreeze(request_.freeze, track_.num_frames());
        shown = FrozenAt(track_.num_frames(), freeze.frame, freeze.count);
        track_ = FramesInOrder(track_, shown);
        first = freeze.frame, last = freeze.frame + freeze.count;
      }
      const int longer = std::max(track_.camera.width, track_.camera.height);
      const double scale = request_.size > 0 && longer > 0 ? static_cast<double>(request_.size) / longer : 1;
      posed_ = std::make_unique<PosedAvatar>(
          *body_, track_, ViewAngles(request_.view_yaw, track_.num_frames(), first, last), scale, threads_, from);
      Dress(shown);
      if (avatar_.motion) OpenMotion(std::move(shown));
    } catch (const RequestError&) {
      throw;
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(from + ": " + error.what());
    }
    if (posed_->width() < 2 || posed_->height() < 2 ||
        std::max(posed_->width(), posed_->height()) > kLongestPictureSide) {
      throw std::runtime_error(Concatenate(from, ": pictures of ", posed_->width(), "x", posed_->height(),
                                           ", expected sides of 2 to ", kLongestPictureSide));
    }
    if (request_.report.empty()) return;
    if (track_.camera.model != CameraModel::kPinhole) {
      throw std::runtime_error(from + ": a track of a weakly perspective camera, expected a pinhole's for --report");
    }
    page_step_ = AvatarPage::FrameStep(track_.num_frames(), avatar_.num_bones());
    page_.emplace(avatar_.body, body_->data().faces, posed_->CameraAt(0), EstimatedUp(track_),
                  (track_.num_frames() + page_step_ - 1) / page_step_, motion_.has_value());
  }

  void Dress(const std::vector<int>& shown) {
    if (!avatar_.garment) return;
    const WornGarment worn = CutAnew(*body_, avatar_.betas, *avatar_.garment, request_.run);
    GarmentBones bones = worn.Along(moving_, callbacks_);
    if (clip_) clip_->Wear(bones);
    posed_->Wear(std::move(bones), shown);
  }

  /// Frames of a track without times come at kFpsWithoutTimes.
  void AddToPage(int t, bool shows) {
    const std::vector<double>& times = track_.motion.timestamps;
    const double seconds = fps_ > 0 ? times[t] - times.front() : t / kFpsWithoutTimes;
    if (shows) {
      page_->AddFrame(seconds, frame_, painter_.posed(), offsets_);
    } else {
      page_->AddEmptyFrame(seconds);
    }
  }

  void WritePage() {
    if (!page_) return;
    if (summary_.frames_without_fit == track_.num_frames()) {
      throw std::runtime_error(request_.track + ": no frame has a fit, there is nothing to show in --report");
    }
    WriteFileAtomically(
        request_.report,
        page_->ToHtml("A person of Gaussians",
                      Concatenate(avatar_.body.size(), " Gaussians of ", request_.run, " in the motion of ",
                                  request_.track.empty() ? request_.data : request_.track)));
  }

  void OpenMotion(std::vector<int> shown) {
    const AvatarMotionFile& file = *avatar_.motion;
    if (file.options.maps != AvatarMotionMaps::kChannels) {
      throw std::runtime_error(Concatenate(request_.run, ": its network of the motion wants ", file.options.maps,
                                           " maps, expected ", int{AvatarMotionMaps::kChannels},
                                           "; it is of another version of this program"));
    }
    motion_.emplace(*body_, file.options);
    motion_->Anchor(avatar_.body);
    maps_.emplace(*body_, moving_, file.options.side, file.fps, std::move(shown), threads_);
    of_frame_.resize(motion_->num_values());
  }

  void AddMotion(int t) {
    if (!motion_) return;
    maps_->Maps(t, of_frame_);
    motion_->Compute(avatar_.motion->parameters, of_frame_, threads_, &offsets_);
  }

  void WriteRestPly() const {
    if (request_.ply.empty()) return;
    AvatarFrame rest;
    rest.rest_joints = MatrixX3f::Zero(avatar_.num_bones(), 3);
    for (int j = 0; j < avatar_.num_bones(); ++j) {
      rest.bones.insert(rest.bones.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    }
    CameraGaussians gaussians;
    PoseGaussians(avatar_.body, body_->data().faces, rest, {}, {.num_threads = threads_}, &gaussians);
    WriteGaussianPly(request_.ply, gaussians);
  }

  void Draw(int t) {
    const Stopwatch watch;
    posed_->MakeFrame(t, &frame_);
    AddMotion(t);
    const AvatarView view = posed_->ViewAt(t);
    painter_.Draw(avatar_.body, body_->data().faces, frame_, offsets_, view);
    draw_ms_.push_back(1e3 * watch.seconds());
    pixels_.push_back(static_cast<double>(view.window.area()));
  }

  void DrawFrames() {
    const int count = track_.num_frames();
    if (!request_.posed_ply.empty() && (request_.posed_frame < 0 || request_.posed_frame >= count)) {
      throw RequestError(Concatenate("--ply-frame ", request_.posed_frame, ": the clip has frames 0 to ", count - 1));
    }
    const int width = posed_->width(), height = posed_->height();
    Background background(request_.background, width, height);
    fps_ = FrameRateWithoutGaps(track_.motion);
    const double fps = fps_ > 0 ? fps_ : kFpsWithoutTimes;
    std::unique_ptr<VideoWriter> video;
    if (!request_.out.empty()) {
      video = std::make_unique<VideoWriter>(request_.out, width, height, fps);
    }
    std::unique_ptr<RenderedDataset> set;
    if (!request_.set.empty()) {
      set = std::make_unique<RenderedDataset>(request_.set, track_, fps, true, false, SetCommand());
    }
    for (int t = 0; t < count; ++t) {
      callbacks_.Update("drawing", static_cast<double>(t) / count);
      const bool shows = posed_->HasResult(t);
      if (shows) Draw(t);
      if (!shows) ++summary_.frames_without_fit;
      clock_.Begin("write");
      if (!request_.pictures.empty()) WritePicture(t, shows);
      if (page_ && t % page_step_ == 0) AddToPage(t, shows);
      if (video || set) {
        Image whole = background.Next();
        if (shows) LayOver(painter_.picture(), &whole);
        if (video) video->Write(whole);
        if (set) set->Add(t, FrameOfSet(shows, std::move(whole)));
      }
      if (shows && !request_.posed_ply.empty() && t == request_.posed_frame) {
        WriteGaussianPly(request_.posed_ply, painter_.posed());
      }
      clock_.Begin("draw");
    }
    if (video) video->Finish();
    if (set) set->Finish();
    WritePage();
    if (!request_.posed_ply.empty() && !posed_->HasResult(request_.posed_frame)) {
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
    if (shows) frame.labels = LabelsOf(painter_.picture(), GarmentShare(), whole.width, whole.height);
    frame.rgb = std::move(whole);
    return frame;
  }

  void WritePicture(int t, bool shows) const {
    const int width = posed_->width(), height = posed_->height();
    const std::vector<uint8_t> nobody(shows ? 0 : 4 * static_cast<size_t>(width) * height, 0);
    WriteAlphaPng(FrameFile(request_.pictures, t), width, height,
                  shows ? WithAlpha(painter_.picture(), width, height) : nobody);
  }

  /// Of the picture last drawn; empty: no garment is worn.
  [[nodiscard]] std::vector<float> GarmentShare() {
    return avatar_.garment ? painter_.ShareOf(GaussianKind::kCloth, avatar_.body) : std::vector<float>();
  }

  void ScoreFrames() {
    clock_.Begin("score");
    AvatarScorer scorer;
    for (int t = 0; t < track_.num_frames(); ++t) {
      const std::vector<TrainingView> views = clip_->ReadViews({t}, AvatarScores::kScoreMargin, false, callbacks_);
      if (views[0].window.empty()) continue;
      AvatarView view;
      view.camera = views[0].camera, view.window = views[0].window, view.options.num_threads = threads_;
      AddMotion(t);
      painter_.Draw(avatar_.body, body_->data().faces, views[0].frame, offsets_, view);
      scorer.Add(views[0], painter_.picture(), GarmentShare());
    }
    summary_.scores = scorer.Means();
  }

  AnimateAvatarSummary Finish() {
    clock_.End();
    summary_.width = posed_->width(), summary_.height = posed_->height();
    summary_.gaussians = avatar_.body.size();
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
  AvatarFile avatar_;
  std::shared_ptr<const BodyModel> body_;
  std::optional<AvatarClip> clip_;
  Track track_;
  Track moving_;  ///< in which no time stands still; for the garment and the network of the motion
  std::unique_ptr<PosedAvatar> posed_;
  std::optional<AvatarMotion> motion_;
  std::optional<AvatarMotionMaps> maps_;
  std::vector<float> of_frame_;
  GaussianOffsets offsets_;
  AvatarFrame frame_;
  AvatarPainter painter_;
  std::optional<AvatarPage> page_;
  int page_step_ = 1;  ///< every so many-th frame is on it
  double fps_ = 0;     ///< of the track; 0: it does not say
  std::vector<double> draw_ms_, pixels_;
  AnimateAvatarSummary summary_;
};

}  // namespace

AnimateAvatarSummary AnimateAvatar(const AnimateAvatarRequest& request, const PipelineCallbacks& callbacks) {
  return AvatarAnimation(request, callbacks).Run();
}

}  // namespace bodyloom
