// SPDX-License-Identifier: Apache-2.0
#include "pipelines/gaussian_avatar/train_avatar.h"
#include "pipelines/gaussian_avatar/avatar_scores.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "data_tools/avatar/avatar_file.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/uv_maps/uv_texels.h"
#include "pipelines/clip_span.h"
#include "pipelines/files.h"
#include "pipelines/report_json.h"
#include "pipelines/report_text.h"
#include "pipelines/runs/run_config.h"
#include "render/garment/clip_clothes.h"
#include "render/gaussian_avatar/cloth_bones.h"
#include "render/gaussian_avatar/learning/loose_gaussians.h"
#include "render/gaussian_avatar/learning/pose_refiner.h"
#include "render/gaussian_avatar/skin_gaussians.h"
#include "render/gaussian_avatar/worn_garment.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAvatarProgram = "bodyloom train avatar";
constexpr int kTrainingMargin = 12;        ///< pixels around person and body that are learned from
constexpr double kCheckpointSeconds = 60;  ///< between checkpoints
constexpr int kMetricsEvery = 50;          ///< steps a line of metrics.csv
constexpr size_t kLossSteps = 100;         ///< that the loss is the mean of
constexpr int kScoredFrames = 64;          ///< of either kind, at most
constexpr int kJudgedFrames = 16;          ///< held out, in the course of training, at most
constexpr int kHeldOutShown = 4;
constexpr const char* kGarmentFit = "garment_fit";  ///< in config.json
constexpr int kClothRuns = 3;                       ///< of the garment's simulation, that are learned from in turn
constexpr int64_t kMaxSteps = 100000000;

std::string InRun(const std::string& run, const char* name) { return (fs::path(run) / name).string(); }

std::vector<int> Spread(const std::vector<int>& frames, int maximum) {
  std::vector<int> some;
  for (const int i : EvenlySpreadFrames(static_cast<int>(frames.size()), maximum)) some.push_back(frames[i]);
  return some;
}

/// One sitting of a training.
class AvatarTraining {
 public:
  AvatarTraining(const TrainAvatarRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks) {
    request_.clip.threads = ThreadsFor(request.clip.threads);
  }

  TrainAvatarSummary Run() {
    OpenRun();
    clock_.Begin("read");
    clip_.emplace(request_.clip);
    split_ = ReadTrainingSplit(request_.train, request_.validate, clip_->track().num_frames());
    if (request_.resume) TakeCheckpoint();
    clock_.Begin("garment");
    Dress();
    clock_.Begin("read");
    options_ = Options();
    views_ = clip_->ReadViews(split_.train, kTrainingMargin, true, callbacks_);
    if (IsWatched()) {
      held_out_ = clip_->ReadViews(Spread(split_.validation, kJudgedFrames), kTrainingMargin, true, callbacks_);
    }
    clock_.Begin("begin");
    refiner_.emplace(clip_->body(), clip_->track().motion.betas, TrackedPoses(clip_->body(), clip_->track()),
                     PoseRefinerOptions());
    if (!request_.resume) Begin();
    clock_.Begin("train");
    Train();
    clock_.Begin("write");
    WriteRun();
    if (!summary_.stopped) Judge();
    if (!summary_.stopped && !request_.refined_track.empty()) RefineAll();
    clock_.End();
    return Finish();
  }

 private:
  void OpenRun() {
    if (!request_.clip.data.empty()) RequireReadable(request_.clip.data, "data");
    RequireWritable(request_.refined_track);
    RequireDistinct({request_.clip.data, request_.clip.track, request_.clip.mask}, {request_.refined_track});
    RequireWritableFolder(request_.out);
    const bool is_there = fs::exists(AvatarCheckpointPath(request_.out));
    if (request_.resume && !is_there) throw RequestError(request_.out + " holds no run to go on with");
    if (!request_.resume && is_there) {
      throw RequestError(request_.out + " holds a run already; go on with it by --resume, or choose another --out");
    }
  }

  [[nodiscard]] AvatarTrainerOptions Options() const {
    AvatarTrainerOptions options;
    options.steps = request_.minutes > 0 ? kMaxSteps : request_.steps;
    options.seconds = 60 * request_.minutes;
    options.seed = request_.seed;
    options.num_threads = request_.clip.threads;
    if (std::string why; !options.IsValid(&why)) throw RequestError(why);
    return options;
  }

  /// Options that must not change when a training is resumed.
  [[nodiscard]] std::string OptionsText() const {
    nlohmann::ordered_json json = {{"steps", request_.steps},   {"minutes", request_.minutes},
                                   {"seed", request_.seed},     {"skin_side", request_.skin_side},
                                   {"loose", request_.loose},   {"train", split_.train},
                                   {"data", request_.clip.data}};
    if (request_.refine) json["refine"] = true;  // runs of earlier versions name neither
    if (request_.all_steps) json["all_steps"] = true;
    if (request_.garment) json["garment"] = true;
    return json.dump();
  }

  /// In the garment of the clip, or that of the run that is gone on with.
  void Dress() {
    const Eigen::VectorXd& betas = clip_->track().motion.betas;
    std::optional<AvatarGarment>& garment = checkpoint_.avatar.garment;
    if (!request_.resume && request_.garment) {
      const ClipClothes clothes = FitClipClothes(
          clip_->body(), clip_->track(), split_.train, [this](int t) { return clip_->MaskAt(t); },
          request_.clip.threads, callbacks_);
      if (clothes.garment.length_m > 0) garment = GarmentOf(clip_->body(), betas, clothes);
      garment_report_ = {{"frames", clothes.frames},
                         {"found_in", clothes.found_in},
                         {"mask_error_tight", clothes.mask_error_tight},
                         {"mask_error_with_garment", clothes.mask_error_with_garment}};
    }
    if (request_.resume && fs::exists(RunConfigPath(request_.out))) {  // what was found when it was begun
      const nlohmann::json config = ReadRunConfig(request_.out, kAvatarProgram);
      if (config.contains(kGarmentFit)) garment_report_ = config[kGarmentFit];
    }
    if (!garment) return;
    worn_.emplace(CutAnew(clip_->body(), betas, *garment, AvatarCheckpointPath(request_.out)));
    clip_->Wear(worn_->RunsAlong(clip_->track(), kClothRuns, request_.clip.threads, callbacks_));
  }

  void Begin() {
    callbacks_.Update("placing Gaussians", 0);
    const Eigen::VectorXd& betas = clip_->track().motion.betas;
    const UvTexelTable texels =
        BuildUvTexelTable(clip_->body(), {.width = request_.skin_side, .height = request_.skin_side, .gutter = 0});
    GaussianBody body = SkinGaussians(clip_->body(), betas, texels);
    LooseGaussiansOptions loose;
    loose.count = request_.loose, loose.seed = request_.seed, loose.num_threads = request_.clip.threads;
    if (worn_) {
      AppendGaussians(ClothGaussians(clip_->body(), betas, worn_->mesh(), worn_->nodes()), &body);
      const auto heights = worn_->nodes().places().col(1);
      loose.covered_from_m = static_cast<float>(heights.minCoeff());
      loose.covered_to_m = static_cast<float>(heights.maxCoeff());
    }
    AppendGaussians(LooseGaussians(clip_->body(), betas, views_, loose), &body);
    checkpoint_.avatar.betas = betas;
    checkpoint_.avatar.num_joints = clip_->body().num_joints();
    checkpoint_.avatar.num_vertices = clip_->body().num_vertices();
    checkpoint_.avatar.num_faces = clip_->body().num_faces();
    checkpoint_.state = AvatarTrainingState::Of(std::move(body));
    if (request_.refine) checkpoint_.state.poses.Reset(refiner_->num_frames(), refiner_->num_joints());
    checkpoint_.options = OptionsText();
    WriteConfig();
  }

  void TakeCheckpoint() {
    const std::string path = AvatarCheckpointPath(request_.out);
    checkpoint_ = ReadAvatarCheckpoint(path);
    if (checkpoint_.avatar.had_network) {
      throw RequestError(path +
                         ": was begun with a network of the motion, which this version no longer has; begin anew");
    }
    if (checkpoint_.options != OptionsText()) {
      throw RequestError(path +
                         ": was begun with other data, frames, steps, minutes, seed, --skin, --loose, --refine, "
                         "--all-steps or --without; config.json beside it says with which");
    }
    std::string why;
    const int nodes = checkpoint_.avatar.num_bones() - checkpoint_.avatar.num_joints;
    if (!checkpoint_.state.body.IsValid(clip_->body().num_joints() + nodes, clip_->body().num_faces(), &why)) {
      throw std::runtime_error(path + ": of another body (--body): " + why);
    }
    const int num_frames = clip_->track().num_frames();
    if (request_.refine && checkpoint_.state.poses.values.rows() != num_frames) {
      throw std::runtime_error(Concatenate(path, ": pose_values of ", checkpoint_.state.poses.values.rows(),
                                           " frames, the track has ", num_frames));
    }
    // Lines after the checkpoint are dropped, as these steps are repeated.
    std::istringstream lines(fs::exists(MetricsPath()) ? ReadFileBytes(MetricsPath()) : "");
    for (std::string line; std::getline(lines, line);) {
      if (line.empty() || std::atoll(line.c_str()) > checkpoint_.state.step) continue;
      metrics_ += line + "\n";
    }
  }

  /// Of the whole job, to report by.
  [[nodiscard]] double LearningShare() const { return request_.refined_track.empty() ? 1 : 0.5; }

  /// With corrected poses the person gets better in those alone, and frames held out have none.
  [[nodiscard]] bool IsWatched() const { return !request_.all_steps && !request_.refine; }

  void Train() {
    AvatarTrainer trainer(clip_->body().data().faces, views_, options_, request_.refine ? &*refiner_ : nullptr);
    trainer.SetValidationViews(held_out_);
    AvatarTrainingState& state = checkpoint_.state;
    if (metrics_.empty()) metrics_ = "step,loss,cost,drawn,relocated,held_out,seconds\n";
    std::deque<double> losses;
    double kept_at = state.seconds;
    int relocated = 0;
    while (!trainer.IsDone(state)) {
      const AvatarStep step = trainer.Step(&state);
      if (!std::isfinite(step.loss))
        throw std::runtime_error(Concatenate(request_.out, ": the loss of step ", state.step, " is no number"));
      losses.push_back(step.loss);
      if (losses.size() > kLossSteps) losses.pop_front();
      relocated += step.relocated;
      summary_.loss = std::accumulate(losses.begin(), losses.end(), 0.0) / static_cast<double>(losses.size());
      if (state.step % kMetricsEvery == 0) {
        const std::vector<double>& held_out = state.held_out.losses;
        metrics_ += Concatenate(state.step, ",", summary_.loss, ",", step.cost, ",", step.drawn, ",", relocated, ",",
                                held_out.empty() ? "" : Fixed(held_out.back(), 6), ",", Fixed(state.seconds, 2), "\n");
        relocated = 0;
      }
      if (!callbacks_.ReportProgress("loss " + Fixed(summary_.loss, 4), LearningShare() * trainer.Progress(state))) {
        summary_.stopped = true;
        break;
      }
      if (state.seconds - kept_at > kCheckpointSeconds) {
        WriteAvatarCheckpoint(AvatarCheckpointPath(request_.out), checkpoint_);
        kept_at = state.seconds;
      }
    }
    summary_.seconds = trainer.stage_seconds();
  }

  void WriteRun() {
    WriteAvatarCheckpoint(AvatarCheckpointPath(request_.out), checkpoint_);
    AvatarFile avatar = checkpoint_.avatar;
    avatar.body = checkpoint_.state.ResultBody();
    WriteAvatar(AvatarPath(request_.out), avatar);
    WriteFileAtomically(MetricsPath(), metrics_);
  }

  /// Moves the poses of all frames with the person as it is, scores the held-out ones and writes the track.
  void RefineAll() {
    clock_.Begin("refine");
    std::vector<int> all(clip_->track().num_frames());
    std::iota(all.begin(), all.end(), 0);
    views_ = clip_->ReadViews(all, kTrainingMargin, true, callbacks_);
    const auto shown =
        std::count_if(views_.begin(), views_.end(), [](const auto& view) { return !view.window.empty(); });
    AvatarTrainerOptions options = options_;
    options.learn_person = false, options.refine_from = 0;
    options.steps = request_.refine_rounds * shown, options.seconds = 0;
    AvatarTrainer trainer(clip_->body().data().faces, views_, options, &*refiner_);
    AvatarTrainingState state = AvatarTrainingState::Of(checkpoint_.state.ResultBody());
    state.poses = checkpoint_.state.poses;
    if (state.poses.values.rows() == 0) state.poses.Reset(refiner_->num_frames(), refiner_->num_joints());
    while (!trainer.IsDone(state)) {
      trainer.Step(&state);
      if (!callbacks_.ReportProgress("refining the track",
                                     LearningShare() + (1 - LearningShare()) * trainer.Progress(state))) {
        summary_.stopped = true;
        return;
      }
    }
    if (!split_.validation.empty()) {
      summary_.validation_refined = ScoreOf(split_.validation, state.poses, "preview_refined.png");
    }
    Track refined = RefinedTrack(clip_->body(), clip_->track(), *refiner_, state.poses);
    refined.camera = clip_->camera_of_file();
    WriteTrack(request_.refined_track, refined);
  }

  AvatarScores ScoreOf(const std::vector<int>& frames, const PoseCorrections& poses, const char* preview) {
    const std::vector<int> some = Spread(frames, kScoredFrames);
    const std::vector<TrainingView> views = clip_->ReadViews(some, AvatarScores::kScoreMargin, false, callbacks_);
    const std::vector<int> shown = EvenlySpreadFrames(static_cast<int>(some.size()), kHeldOutShown);
    AvatarScorer scorer;
    AvatarPainter painter;
    std::vector<Image> sheet;
    const GaussianBody& body = checkpoint_.state.ResultBody();
    for (size_t i = 0; i < views.size(); ++i) {
      if (views[i].window.empty()) continue;
      AvatarView view;
      view.camera = views[i].camera, view.window = views[i].window;
      view.options.num_threads = request_.clip.threads;
      AvatarFrame frame = views[i].frame;
      if (poses.values.rows() > 0) {
        refiner_->MakeFrame(views[i].time, poses, request_.clip.threads, &frame);
        CarryBones(views[i].frame, &frame);
      }
      painter.Draw(body, clip_->body().data().faces, frame, view);
      scorer.Add(views[i], painter.image(), GarmentIn(&painter));
      if (preview == nullptr || !std::binary_search(shown.begin(), shown.end(), static_cast<int>(i))) continue;
      sheet.push_back(TrueWindow(views[i]));
      sheet.push_back(DrawnWindow(painter.image()));
    }
    if (!sheet.empty()) {
      ContactSheetOptions layout;
      layout.columns = 4, layout.cell_height_px = 640;
      WriteImage(InRun(request_.out, preview), ContactSheet(sheet, layout));
    }
    return scorer.Means();
  }

  std::vector<float> GarmentIn(AvatarPainter* painter) const {
    if (!worn_) return {};
    return painter->ShareOf(GaussianKind::kCloth, checkpoint_.state.ResultBody());
  }

  void Judge() {
    clock_.Begin("score");
    constexpr const char* kPreview = "preview.png";
    const bool has_validation = !split_.validation.empty();
    summary_.training = ScoreOf(split_.train, checkpoint_.state.poses, has_validation ? nullptr : kPreview);
    // Held-out frames have no correction: they are judged by the track that they came with.
    if (has_validation) summary_.validation = ScoreOf(split_.validation, checkpoint_.state.poses, kPreview);
  }

  void WriteConfig() const {
    nlohmann::ordered_json json = {{"program", kAvatarProgram},       {"version", 1},
                                   {"data", request_.clip.data},      {"track", request_.clip.track},
                                   {"mask", request_.clip.mask},      {"body", request_.clip.body},
                                   {"train", split_.train},           {"validate", split_.validation},
                                   {"steps", request_.steps},         {"minutes", request_.minutes},
                                   {"skin_side", request_.skin_side}, {"loose", request_.loose},
                                   {"seed", request_.seed},           {"refine", request_.refine},
                                   {"garment", request_.garment},     {"all_steps", request_.all_steps}};
    if (!garment_report_.is_null()) json[kGarmentFit] = garment_report_;
    WriteFileAtomically(RunConfigPath(request_.out), json.dump(1) + "\n");
  }

  TrainAvatarSummary Finish() {
    const AvatarTrainingState& state = checkpoint_.state;
    summary_.steps = state.step;
    summary_.cooldown_step = state.held_out.cooldown_step;
    summary_.best_step = state.kept ? state.kept->step : 0;
    summary_.training_seconds = state.seconds;
    summary_.gaussians = state.ResultBody().size();
    const std::vector<GaussianKind>& kinds = state.ResultBody().kinds;
    summary_.loose = static_cast<int>(std::count(kinds.begin(), kinds.end(), GaussianKind::kLoose));
    summary_.cloth = static_cast<int>(std::count(kinds.begin(), kinds.end(), GaussianKind::kCloth));
    if (checkpoint_.avatar.garment) summary_.garment_length_m = checkpoint_.avatar.garment->cut.length_m;
    for (const auto& stage : clock_.seconds()) summary_.seconds.push_back(stage);
    summary_.written = {AvatarPath(request_.out), AvatarCheckpointPath(request_.out), MetricsPath()};
    if (!request_.refined_track.empty() && !summary_.stopped) summary_.written.push_back(request_.refined_track);
    nlohmann::ordered_json json = {{"steps", summary_.steps},         {"training_seconds", summary_.training_seconds},
                                   {"gaussians", summary_.gaussians}, {"loose", summary_.loose},
                                   {"loss", summary_.loss},           {"seconds", ToJson(summary_.seconds)}};
    if (summary_.best_step > 0) json["best_step"] = summary_.best_step;
    if (summary_.cooldown_step > 0) json["cooldown_step"] = summary_.cooldown_step;
    if (summary_.cloth > 0) json["cloth"] = summary_.cloth;
    if (!garment_report_.is_null()) json["garment"] = garment_report_;
    if (summary_.training) json["training"] = ToJson(*summary_.training);
    if (summary_.validation) json["validation"] = ToJson(*summary_.validation);
    if (summary_.validation_refined) json["validation_poses_refined_on_them"] = ToJson(*summary_.validation_refined);
    WriteReport(InRun(request_.out, "report.json"), json);
    return summary_;
  }

  [[nodiscard]] std::string MetricsPath() const { return InRun(request_.out, "metrics.csv"); }

  TrainAvatarRequest request_;
  const PipelineCallbacks& callbacks_;
  StageClock clock_;
  std::optional<AvatarClip> clip_;
  TrainingSplit split_;
  std::vector<TrainingView> views_, held_out_;
  AvatarTrainerOptions options_;
  std::optional<PoseRefiner> refiner_;
  std::optional<WornGarment> worn_;
  nlohmann::ordered_json garment_report_;
  AvatarCheckpoint checkpoint_;
  std::string metrics_;
  TrainAvatarSummary summary_;
};

}  // namespace

std::string AvatarPath(const std::string& run) { return InRun(run, "avatar.npz"); }
std::string AvatarCheckpointPath(const std::string& run) { return InRun(run, "checkpoint.npz"); }

TrainAvatarSummary TrainAvatar(const TrainAvatarRequest& request, const PipelineCallbacks& callbacks) {
  return AvatarTraining(request, callbacks).Run();
}

}  // namespace bodyloom
