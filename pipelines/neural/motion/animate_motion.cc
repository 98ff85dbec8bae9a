// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/motion/animate_motion.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/evaluation/motion_similarity.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/resample_track.h"
#include "data_tools/motion/track_io.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "neural/motion/motion_renderer.h"
#include "neural/training/training_run.h"
#include "pipelines/animate/relight_frames.h"
#include "pipelines/files.h"
#include "pipelines/neural/motion/animated_clip.h"
#include "pipelines/neural/motion/motion_data.h"
#include "pipelines/neural/weights_folder.h"
#include "pipelines/report_json.h"
#include "pipelines/runs/motion_run.h"
#include "render/texture/planar_image.h"

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
  if (!request.view_yaw.empty()) throw RequestError("--set writes the track beside the images: not with --view-yaw");
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

/// Resources that are opened once and used by all stages.
class MotionAnimation : public FramePainter {
 public:
  MotionAnimation(const AnimateMotionRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks), scored_(ClipOf(request).IsScored()) {
    // The report names all stages in this order, whichever comes first or not at all.
    for (const char* stage : {kPrepare, kLight, kMaps, kNetwork, kCompose}) clock_.Record(stage);
  }

  AnimateMotionSummary Run() {
    CheckRequest(request_);
    OpenRun();
    OpenClip();
    clock_.Record(kPrepare);
    if (relighter_ && relighter_->wants_frames()) EstimateLight();
    clock_.Record(kLight);
    AnimateMotionSummary summary = RenderFrames();
    WriteSheet(request_.sheet, sheet_, sheet_columns_, clip_->frames().window().image_height);
    if (!request_.frames.empty()) scorer_->errors().WriteCsv(request_.frames);
    WriteReport(request_.json, Report(summary));
    summary.total_seconds = clock_.total();
    return summary;
  }

  const Image& NextBackground() override { return background_->Next(); }

  double Paint(int t, Image* composed) override {
    clip_->Fill(t, &frame_);
    ForgetAcrossCuts(t, renderer_.get());
    clock_.Record(kMaps);
    shown_ = renderer_->Next(frame_);
    const double network_s = clock_.Record(kNetwork);
    if (scorer_) scorer_->AddWindow(t, renderer_->last_scores());
    if (request_.true_normals) shown_.normals = frame_.normals;
    if (relighter_) relighter_->Apply(&shown_);
    Composite(shown_.image, shown_.alpha, clip_->frames().window(), t, composed);
    if (scorer_) scorer_->AddComposed(t, *composed);
    return network_s;
  }

  std::vector<Image> ForSheet(int /*t*/, bool painted, const Image& composed) override {
    if (!painted) return {};
    std::vector<Image> images = {composed};
    const int width = shown_.width, height = shown_.height;
    if (!shown_.labels.empty()) images.push_back(LabelsImage(shown_.labels, width, height));
    if (!shown_.normals.empty()) images.push_back(NormalImage(shown_.normals, width, height));
    return images;
  }

  void Written(int t, bool painted, const Image& composed) override {
    if (set_) set_->Add(t, painted ? shown_ : MotionImage(), clip_->frames().window(), composed);
    clock_.Record(kCompose);
  }

  [[nodiscard]] int FramesBefore() const override { return light_frames_; }

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
    if (std::max({window.width, window.height, window.image_width, window.image_height}) > kLargestSide) {
      throw std::runtime_error(Concatenate(
          request_.track, ": at the size that the person was trained at the image would have ", window.image_width, "x",
          window.image_height, " px, at most ", kLargestSide, " a side; the track's person is too small in its image"));
    }
    if (!scored_ &&
        !(request_.like.empty() && request_.frames.empty() && request_.weights.empty() && request_.iuv.empty())) {
      throw RequestError(
          "--like, --frames, --weights and --iuv compare with the images of --data: not without it, nor with "
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
    options.reach = run_.reach, options.whole_window = request_.whole_window;
    options.num_threads = ThreadsFor(request_.threads), options.device = request_.device;
    options.score = score;
    if (score) {
      const WeightsFolder weights = ReadWeightsFolder(request_.weights);
      options.lpips = std::make_shared<const Lpips>(LpipsFrom(weights.alexnet, weights.lpips_heads));
      options.ssim = WindowSsim;
    }
    return std::make_unique<MotionRenderer>(CheckpointPath(request_.run), run_.config, options);
  }

  /// Fills the networks' input of frame t, and its true normals if requested.
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
      callbacks_.Update("light", (t + 1.0) / (light_frames_ + clip_->track().num_frames()));
      if (!clip_->track().HasResult(t)) continue;
      FillWithNormals(t, &frame);
      ForgetAcrossCuts(t, renderer.get());
      MotionImage image = renderer->Next(frame);
      if (request_.true_normals) image.normals = frame.normals;
      relighter_->Observe(image);
    }
    relighter_->Estimate();
  }

  AnimateMotionSummary RenderFrames() {
    const Track& track = clip_->track();
    const PersonWindow& window = clip_->frames().window();
    const ImageSize image = SizeOfImages(window, track.camera, request_.full_size);
    background_.emplace(request_.background, image.width, image.height);
    const double own_fps = FrameRateWithoutGaps(track.motion), fps = own_fps > 0 ? own_fps : run_.fps;
    if (scored_) {
      scorer_ = std::make_unique<ClipScorer>(SimilarityTo(request_, track, run_),
                                             request_.background.empty() ? "" : request_.data, image);
    }
    if (!request_.set.empty()) {
      set_ = std::make_unique<RenderedDataset>(request_.set, track, fps, run_.config.shape, run_.config.normals,
                                               request_.set_command);
    }
    AnimateMotionSummary summary;
    static_cast<AnimationSummary&>(summary) =
        WriteAnimation(request_, track, image, fps, callbacks_, this, &sheet_, &sheet_columns_);
    if (set_) set_->Finish();
    clock_.Record(kCompose);
    summary.seconds = clock_.seconds();
    summary.written = FilesAmong({request_.out, request_.set, request_.sheet, request_.frames, request_.json});
    summary.window_width = window.width, summary.window_height = window.height;
    summary.shrunk_width = window.image_width, summary.shrunk_height = window.image_height;
    summary.descriptors_kept = renderer_->descriptors_kept();
    summary.projections_kept = renderer_->projections_kept();
    if (relighter_ && relighter_->wants_frames()) summary.light = relighter_->summary();
    if (scorer_) summary.scores = scorer_->Scores(renderer_->scores());
    return summary;
  }

  /// Before frame t: what does not follow another frame has no past.
  void ForgetAcrossCuts(int t, MotionRenderer* renderer) const {
    const PersonFrames& frames = clip_->frames();
    if (t > 0 && frames.Segment(t) != frames.Segment(t - 1)) renderer->Restart();
    if (request_.without_past) renderer->ForgetPast();
  }

  [[nodiscard]] nlohmann::ordered_json Report(const AnimateMotionSummary& summary) const {
    nlohmann::ordered_json json = ReportOf(summary, request_.out);
    json["window"] = {summary.window_width, summary.window_height};
    json["descriptors_kept"] = summary.descriptors_kept;
    json["projections_kept"] = summary.projections_kept;
    if (relighter_) json["relight"] = relighter_->Json();
    if (summary.scores) json["scores"] = ToJson(*summary.scores);
    return json;
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
  std::optional<Background> background_;
  std::unique_ptr<RenderedDataset> set_;
  MotionFrame frame_;  ///< painted last
  MotionImage shown_;  ///< of it
  std::vector<Image> sheet_;
  int light_frames_ = 0, sheet_columns_ = 1;
};

}  // namespace

nlohmann::ordered_json ToJson(const ClipScores& scores) {
  const MotionScores& s = scores.windows;
  nlohmann::ordered_json json = {{"frames", s.frames},
                                 {"image_l1", s.image_l1},
                                 {"psnr_db", s.psnr_db},
                                 {"label_iou", s.label_iou},
                                 {"class_iou", s.class_iou},
                                 {"foreground_iou", s.foreground_iou},
                                 {"normal_deg", s.normal_deg},
                                 {"flicker", s.flicker},
                                 {"ssim", s.ssim},
                                 {"ssim_preset", ToText(kWindowSsim)},
                                 {"lpips", s.lpips},
                                 {"tlpips", s.tlpips},
                                 {"lpips_of_random_features", s.lpips_random_features}};
  if (!scores.by_similarity.empty()) json["by_similarity"] = ToJson(scores.by_similarity);
  if (scores.composed) {
    json["whole_picture_psnr_db"] = scores.composed->psnr_db;
    json["rim_psnr_db"] = scores.composed->rim_psnr_db;
  }
  return json;
}

ClipScorer::ClipScorer(std::vector<float> similarity, const std::string& set, ImageSize image)
    : errors_(std::move(similarity)) {
  if (!set.empty()) composed_.emplace(set, image.width, image.height);
}

void ClipScorer::AddComposed(int t, const Image& composed) {
  if (composed_) composed_->Add(t, composed);
}

ClipScores ClipScorer::Scores(const MotionScores& windows) const {
  ClipScores scores;
  scores.windows = windows;
  scores.by_similarity = errors_.Quarters();
  if (composed_) scores.composed = ClipScores::Composed{composed_->psnr_db(), composed_->rim_psnr_db()};
  return scores;
}

AnimateMotionSummary AnimateMotion(const AnimateMotionRequest& request, const PipelineCallbacks& callbacks) {
  return MotionAnimation(request, callbacks).Run();
}

}  // namespace bodyloom
