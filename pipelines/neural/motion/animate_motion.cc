// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/motion/animate_motion.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/evaluation/motion_similarity.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/resample_track.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "neural/motion/motion_renderer.h"
#include "neural/training/training_run.h"
#include "pipelines/animate/background.h"
#include "pipelines/animate/relight_frames.h"
#include "pipelines/files.h"
#include "pipelines/neural/motion/animated_clip.h"
#include "pipelines/neural/motion/clip_scores.h"
#include "pipelines/neural/motion/motion_data.h"
#include "pipelines/neural/weights_folder.h"
#include "pipelines/report_json.h"
#include "pipelines/runs/motion_run.h"
#include "render/texture/planar_image.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kLargestSide = 4096;
constexpr const char *kPrepare = "prepare", *kLight = "light", *kMaps = "maps", *kNetwork = "network",
                     *kCompose = "compose and encode";

AnimatedClipRequest ClipOf(const AnimateMotionRequest& request) {
  return {request.track, request.data,           request.body,
          request.iuv,   request.view_yaw,       request.freeze,
          request.speed, request.shape_of_track, ThreadsFor(request.threads)};
}

void CheckRequest(const AnimateMotionRequest& request) {
  if (request.track.empty() == request.data.empty()) throw RequestError("expected one of --track and --data");
  RequireReadable(request.track, "track");
  RequireReadable(request.background, "background");
  RequireReadable(request.data, "single-person dataset");
  RequireReadable(request.relight, "light");
  RequireOutputs({request.track, request.background, request.body, request.relight},
                 {request.out, request.sheet, request.json, request.frames});
  RequireReadable(request.like, "single-person dataset or track");
  if (request.set.empty()) return;
  RequireWritableFolder(request.set);
  if (!request.view_yaw.empty()) throw RequestError("--set writes the track beside the pictures: not with --view-yaw");
  RequireDistinct({request.data, request.like}, {request.set});
}

/// Of the T frames of `like`: 1 where the run was trained on the frame; empty: it was trained on other data, or does
/// not say on which frames.
std::vector<char> TrainedOn(const MotionRun& run, const std::string& like, int T) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string own = run.track.empty() ? (fs::path(run.data) / "track.npz").string() : run.track;
  if (run.trained.empty() || !(fs::equivalent(like, run.data, ignored) || fs::equivalent(like, own, ignored)))
    return {};
  std::vector<char> trained(T);
  for (const auto& [first, last] : run.trained) {
    for (int t = std::max(0, first); t <= std::min(last, T - 1); ++t) trained[t] = 1;
  }
  return trained;
}

/// Of each frame to the nearest of `like`; empty without it.
std::vector<float> SimilarityTo(const AnimateMotionRequest& request, const Track& track, const MotionRun& run) {
  if (request.like.empty()) return {};
  Track others =
      std::filesystem::is_directory(request.like) ? SinglePersonDataset(request.like).track() : ReadTrack(request.like);
  try {
    std::vector<char> trained;
    if (IsAtRate(others, run.fps)) {
      trained = TrainedOn(run, request.like, others.num_frames());
    } else {
      others = ResampleTrack(others, run.fps);
    }
    return SimilarityToNearest(*BodyOrBuiltin(request.body), track, others, run.past, ThreadsFor(request.threads),
                               run.motion, trained);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(request.like + ": " + error.what());
  }
}

/// What is opened once and used by every stage.
class MotionAnimation {
 public:
  MotionAnimation(const AnimateMotionRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks), scored_(ClipOf(request).IsScored()) {
    // The report names all stages in this order, whichever comes first or not at all.
    for (const char* stage : {kPrepare, kLight, kMaps, kNetwork, kCompose}) clock_.Book(stage);
  }

  AnimateMotionSummary Run() {
    CheckRequest(request_);
    OpenRun();
    OpenClip();
    clock_.Book(kPrepare);
    if (relighter_ && relighter_->wants_frames()) EstimateLight();
    clock_.Book(kLight);
    RenderFrames();
    WriteSheet(request_.sheet, sheet_, sheet_columns_, clip_->frames().window().picture_height);
    if (!request_.frames.empty()) scorer_->errors().WriteCsv(request_.frames);
    AnimateMotionSummary summary = Summarise();
    WriteReport(request_.json, Report(summary));
    summary.total_seconds = clock_.total();
    return summary;
  }

 private:
  void OpenRun() {
    if (!request_.relight.empty()) relighter_ = std::make_unique<FrameRelighter>(ReadRelight(request_.relight));
    run_ = ReadMotionRun(request_.run);
    if (relighter_ && !run_.config.normals) {
      throw std::runtime_error(request_.run + ": was trained without surface normals, which --relight needs");
    }
  }

  void OpenClip() {
    clip_ = std::make_unique<AnimatedClip>(ClipOf(request_), run_);
    SayLines(clip_->notes(), callbacks_);
    const PersonWindow& window = clip_->frames().window();
    if (std::max({window.width, window.height, window.picture_width, window.picture_height}) > kLargestSide) {
      throw std::runtime_error(Concatenate(request_.track,
                                           ": at the size that the person was trained at the picture would have ",
                                           window.picture_width, "x", window.picture_height, " px, at most ",
                                           kLargestSide, " a side; the track's person is too small in its picture"));
    }
    if (!scored_ &&
        !(request_.like.empty() && request_.frames.empty() && request_.weights.empty() && request_.iuv.empty())) {
      throw RequestError(
          "--like, --frames, --weights and --iuv compare with the pictures of --data: not without it, nor with "
          "--view-yaw, --freeze or --speed");
    }
    if (request_.true_normals && !(relighter_ && scored_)) {
      throw RequestError(
          "--true-normals are those of --data, for --relight: not without both, nor with --view-yaw, "
          "--freeze or --speed");
    }
    if (request_.true_normals && !clip_->has_normals()) throw std::runtime_error(request_.data + ": has no normals");
    renderer_ = OpenRenderer(scored_);
  }

  [[nodiscard]] std::unique_ptr<MotionRenderer> OpenRenderer(bool score) const {
    MotionRendererOptions options;
    options.warmup_iterations = request_.warmup;
    options.reach = run_.reach, options.anywhere = request_.anywhere;
    options.num_threads = ThreadsFor(request_.threads), options.device = request_.device;
    options.score = score;
    if (score) {
      const WeightsFolder weights = ReadWeightsFolder(request_.weights);
      options.lpips = std::make_shared<const Lpips>(LpipsFrom(weights.alexnet, weights.lpips_heads));
      options.ssim = WindowSsim;
    }
    return std::make_unique<MotionRenderer>(CheckpointPath(request_.run), run_.config, options);
  }

  /// What the networks need of frame t, and its true normals where those are wanted.
  void FillWithNormals(int t, MotionFrame* frame) const {
    if (request_.true_normals) {
      clip_->Fill(t, frame);
    } else {
      clip_->FillMotion(t, frame);
    }
  }

  /// The light of the clip from its first frames, rendered for it.
  void EstimateLight() {
    const std::unique_ptr<MotionRenderer> renderer = OpenRenderer(false);
    MotionFrame frame;
    light_frames_ = std::min(FrameRelighter::kFrames, clip_->track().num_frames());
    for (int t = 0; t < light_frames_; ++t) {
      Update("light", t + 1);
      if (!clip_->track().HasResult(t)) continue;
      FillWithNormals(t, &frame);
      ForgetAcrossCuts(t, renderer.get());
      MotionPicture picture = renderer->Next(frame);
      if (request_.true_normals) picture.normals = frame.normals;
      relighter_->Observe(picture);
    }
    relighter_->Estimate();
  }

  void RenderFrames() {
    const Track& track = clip_->track();
    const PersonWindow& window = clip_->frames().window();
    picture_ = SizeOfPictures(window, track.camera, request_.full_size);
    Background background(request_.background, picture_.width, picture_.height);
    const double own_fps = FrameRateWithoutGaps(track.motion), fps = own_fps > 0 ? own_fps : run_.fps;
    if (scored_) {
      scorer_ = std::make_unique<ClipScorer>(SimilarityTo(request_, track, run_),
                                             request_.background.empty() ? "" : request_.data, picture_);
    }
    VideoWriter video(request_.out, picture_.width, picture_.height, fps);
    std::unique_ptr<RenderedDataset> set;
    if (!request_.set.empty()) {
      set = std::make_unique<RenderedDataset>(request_.set, track, fps, run_.config.shape, run_.config.normals,
                                              request_.set_command);
    }
    const std::vector<int> on_sheet = EvenlySpreadFrames(track.num_frames(), kSheetFrames);
    for (int t = 0; t < track.num_frames(); ++t) {
      Image composed = background.Next();
      MotionPicture picture;
      if (track.HasResult(t)) {
        picture = RenderFrame(t, &composed);
        if (!request_.sheet.empty() && std::binary_search(on_sheet.begin(), on_sheet.end(), t)) {
          AddToSheet(picture, composed);
        }
      } else {
        ++lost_;
      }
      video.Write(composed);
      if (set) set->Add(t, picture, window, composed);
      clock_.Book(kCompose);
      Update("rendering", light_frames_ + t + 1);
    }
    video.Finish();
    if (set) set->Finish();
    clock_.Book(kCompose);
  }

  /// Before frame t: what does not follow another frame has no past.
  void ForgetAcrossCuts(int t, MotionRenderer* renderer) const {
    const PersonFrames& frames = clip_->frames();
    if (t > 0 && frames.Segment(t) != frames.Segment(t - 1)) renderer->Restart();
    if (request_.without_past) renderer->ForgetPast();
  }

  /// The picture of frame t, laid into `composed`.
  MotionPicture RenderFrame(int t, Image* composed) {
    const PersonFrames& frames = clip_->frames();
    clip_->Fill(t, &frame_);
    ForgetAcrossCuts(t, renderer_.get());
    clock_.Book(kMaps);
    MotionPicture picture = renderer_->Next(frame_);
    const double network_s = clock_.Book(kNetwork);
    if (t > 0) network_ms_.push_back(1e3 * network_s);  // the first frame warms up
    if (scorer_) scorer_->AddWindow(t, renderer_->last_scores());
    if (request_.true_normals) picture.normals = frame_.normals;
    if (relighter_) relighter_->Apply(&picture);
    Composite(picture.image, picture.alpha, frames.window(), t, composed);
    if (scorer_) scorer_->AddComposed(t, *composed);
    return picture;
  }

  /// The pictures of a frame side by side.
  void AddToSheet(const MotionPicture& picture, const Image& composed) {
    const size_t before = sheet_.size();
    sheet_.push_back(composed);
    if (!picture.labels.empty()) sheet_.push_back(LabelsPicture(picture.labels, picture.width, picture.height));
    if (!picture.normals.empty()) sheet_.push_back(NormalPicture(picture.normals, picture.width, picture.height));
    sheet_columns_ = static_cast<int>(sheet_.size() - before);
  }

  [[nodiscard]] AnimateMotionSummary Summarise() const {
    const PersonWindow& window = clip_->frames().window();
    AnimateMotionSummary summary;
    summary.frames = clip_->track().num_frames();
    summary.frames_without_fit = lost_;
    summary.picture = picture_;
    summary.network_ms = MedianOf(network_ms_);
    summary.seconds = clock_.seconds();
    summary.written = FilesAmong({request_.out, request_.set, request_.sheet, request_.frames, request_.json});
    summary.window_width = window.width, summary.window_height = window.height;
    summary.shrunk_width = window.picture_width, summary.shrunk_height = window.picture_height;
    summary.descriptors_kept = renderer_->descriptors_kept();
    summary.projections_kept = renderer_->projections_kept();
    if (relighter_ && relighter_->wants_frames()) summary.light = relighter_->summary();
    if (scorer_) summary.scores = scorer_->Scores(renderer_->scores());
    return summary;
  }

  [[nodiscard]] nlohmann::ordered_json Report(const AnimateMotionSummary& summary) const {
    nlohmann::ordered_json json = {{"frames", summary.frames},
                                   {"frames_without_fit", summary.frames_without_fit},
                                   {"window", {summary.window_width, summary.window_height}},
                                   {"picture", {summary.picture.width, summary.picture.height}},
                                   {"network_ms_median", summary.network_ms},
                                   {"descriptors_kept", summary.descriptors_kept},
                                   {"projections_kept", summary.projections_kept},
                                   {"seconds", ToJson(summary.seconds)},
                                   {"output", request_.out}};
    if (relighter_) json["relight"] = relighter_->Json();
    if (summary.scores) json["scores"] = ToJson(*summary.scores);
    return json;
  }

  /// `done` frames of those rendered for the light and for the video.
  void Update(const char* stage, int done) const {
    callbacks_.Update(stage, static_cast<double>(done) / (light_frames_ + clip_->track().num_frames()));
  }

  const AnimateMotionRequest& request_;
  const PipelineCallbacks& callbacks_;
  const bool scored_;
  StageClock clock_;
  std::unique_ptr<FrameRelighter> relighter_;
  MotionRun run_;
  std::unique_ptr<AnimatedClip> clip_;
  std::unique_ptr<MotionRenderer> renderer_;
  std::unique_ptr<ClipScorer> scorer_;
  MotionFrame frame_;
  PictureSize picture_;
  std::vector<Image> sheet_;
  std::vector<double> network_ms_;
  int light_frames_ = 0, sheet_columns_ = 1, lost_ = 0;
};

}  // namespace

AnimateMotionSummary AnimateMotion(const AnimateMotionRequest& request, const PipelineCallbacks& callbacks) {
  return MotionAnimation(request, callbacks).Run();
}

}  // namespace bodyloom
