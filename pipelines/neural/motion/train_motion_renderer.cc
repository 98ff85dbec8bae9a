// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/motion/train_motion_renderer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "data_tools/motion/motion_tools.h"
#include "geometry/base/check.h"
#include "neural/motion/motion_frame.h"
#include "pipelines/clip_span.h"
#include "pipelines/describe/describe_clip.h"
#include "pipelines/files.h"
#include "pipelines/neural/animation.h"
#include "pipelines/neural/training_session.h"
#include "pipelines/neural/weights_folder.h"
#include "pipelines/runs/motion_run.h"
#include "render/texture/planar_image.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kShareStretch = 32;  ///< frames: with less of the data, whole stretches of so many are kept
constexpr int kReachFrames = 64;   ///< that ReachOf looks at, at most

void RequireAllInClip(const std::vector<FrameRange>& ranges, const char* option, int num_frames) {
  for (const FrameRange& range : ranges) RequireInClip({range.begin, range.end - 1}, option, num_frames);
}

std::vector<FrameRange> CutAtGaps(const std::vector<FrameRange>& ranges, const PersonFrames& frames) {
  std::vector<FrameRange> cut;
  for (const FrameRange& range : ranges) {
    int begin = range.begin;
    for (int t = range.begin; t < range.end; ++t) {
      if (t + 1 < range.end && frames.Segment(t + 1) == frames.Segment(t)) continue;
      if (frames.Segment(t) >= 0) cut.push_back({begin, t + 1});
      begin = t + 1;
    }
  }
  return cut;
}

/// Of every so many stretches the first.
std::vector<FrameRange> TakeShare(const std::vector<FrameRange>& ranges, double share) {
  if (share >= 1) return ranges;
  std::vector<FrameRange> stretches;
  for (const FrameRange& range : ranges) {
    for (int begin = range.begin; begin < range.end; begin += kShareStretch) {
      stretches.push_back({begin, std::min(range.end, begin + kShareStretch)});
    }
  }
  const double count = std::max(1.0, share * static_cast<double>(stretches.size()));
  const auto num_kept = static_cast<int>(std::lround(count));
  std::vector<FrameRange> kept;
  kept.reserve(static_cast<size_t>(num_kept));
  for (int i = 0; i < num_kept; ++i) {
    kept.push_back(stretches[static_cast<size_t>(i * static_cast<double>(stretches.size()) / count)]);
  }
  return kept;
}

nlohmann::ordered_json RangesJson(const std::vector<FrameRange>& ranges) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const FrameRange& range : ranges) json.push_back({range.begin, range.end - 1});
  return json;
}

std::string Notes(const TrainMotionRendererRequest& request, const TrainMotionOptions& o) {
  const nlohmann::ordered_json json = {{"data", request.data.data},
                                       {"track", request.data.track},
                                       {"iuv", request.data.iuv},
                                       {"mask", request.data.mask},
                                       {"part_labels", request.data.part_labels},
                                       {"validate_data", request.validate_data},
                                       {"train", RangesJson(o.train)},
                                       {"validate", RangesJson(o.validation)},
                                       {"share", request.frames.share},
                                       {"seed", o.seed},
                                       {"steps", o.steps},
                                       {"batch", o.batch},
                                       {"rollout_length", o.rollout_length},
                                       {"rollouts", o.rollouts},
                                       {"learning_rate", o.learning_rate},
                                       {"average", o.average},
                                       {"discriminator_rate", o.discriminator_rate},
                                       {"shape_loss", o.shape_by_cross_entropy ? "ce" : "l1"},
                                       {"weights",
                                        {{"shape", o.shape_weight},
                                         {"normals", o.normal_weight},
                                         {"perceptual", o.perceptual_weight},
                                         {"gan", o.gan_weight}}},
                                       {"threads", o.num_threads}};
  return json.dump();
}

/// The parts that the data has no truth for are left out.
void LeaveOutUnknown(const MotionData& data, MotionConfig* config, const PipelineCallbacks& callbacks) {
  if (!data.has_labels() && config->shape) {
    config->shape = false;
    callbacks.Message("no labels: trained without shape, on the whole window with its background");
  }
  if (!data.has_normals() && config->normals) {
    config->normals = false;
    callbacks.Message("no normals: trained without them");
  }
}

/// The clip that is for validation alone, at the same size; nullptr: there is none.
std::unique_ptr<MotionData> ValidationData(const TrainMotionRendererRequest& request, const MotionDataRequest& like,
                                           const MotionData& data, const MotionConfig& config) {
  if (request.validate_data.empty()) return nullptr;
  if (!like.iuv.empty() && like.iuv != kOwnIuv) {
    throw RequestError("--iuv DIR holds the images of --data alone: with --validate-data expected \"own\"");
  }
  MotionDataRequest other = like;
  other.data = request.validate_data;
  other.track.clear();
  other.pixels_per_metre = data.PixelsPerMetre();
  auto validation = std::make_unique<MotionData>(other, config.profile, config.Multiple());
  const double fps = FrameRateWithoutGaps(data.track().motion);
  if (fps > 0) RequireRate(validation->track(), fps, request.validate_data, "make it at that rate");
  return validation;
}

/// Run description, with everything needed to use the checkpoint.
MotionRun RunOf(const TrainMotionRendererRequest& request, const TrainMotionOptions& options, const MotionData& data) {
  MotionRun run;
  run.config = options.config;
  run.pixels_per_metre = data.PixelsPerMetre();
  run.reach = options.reach;
  run.past = data.frames().options().past;
  run.motion = data.frames().options().motion;
  run.notes = Notes(request, options);
  const double fps = FrameRateWithoutGaps(data.track().motion);
  if (fps > 0) run.fps = fps;
  run.betas = data.track().motion.betas;
  return run;
}

void SayWhatIsTrained(const MotionRun& run, const PersonWindow& window, const PipelineCallbacks& callbacks) {
  callbacks.Message(Concatenate(
      "window ", window.width, "x", window.height, " px, ", run.pixels_per_metre, " px a metre; profile ",
      run.config.profile.name, "; ",
      run.config.descriptor == MotionDescriptor::kDense2d
          ? Concatenate("dense UV coordinates and keypoints of ", run.past, " frames")
          : Concatenate("velocities ", VelocityName(run.motion), " in the ", ToString(run.motion.frame), " frame"),
      run.config.around_body ? Concatenate("; ", run.reach, " px around the body") : "; the whole window"));
}

std::vector<Image> RowOf(const MotionPreview& p) {
  const auto or_black = [&](const auto& truth, auto image_of) {
    return truth.empty() ? Image(p.width, p.height) : image_of(truth, p.width, p.height);
  };
  std::vector<Image> row = {ImageFromPlanes(p.true_image, p.width, p.height),
                            ImageFromPlanes(p.image, p.width, p.height)};
  if (!p.labels.empty()) {
    row.push_back(or_black(p.true_labels, LabelsImage));
    row.push_back(LabelsImage(p.labels, p.width, p.height));
  }
  if (!p.normals.empty()) {
    row.push_back(or_black(p.true_normals, NormalImage));
    row.push_back(NormalImage(p.normals, p.width, p.height));
  }
  return row;
}

}  // namespace

TrainingFrames ChooseFrames(const TrainingFramesRequest& request, const PersonFrames& frames,
                            const PersonFrames* validation) {
  const int T = frames.num_frames(), validation_frames = validation != nullptr ? validation->num_frames() : 0;
  RequireAllInClip(request.train, "--train", T);
  RequireAllInClip(request.validate, "--validate", validation_frames > 0 ? validation_frames : T);
  TrainingFrames chosen = {request.train, request.validate};
  if (validation_frames > 0 && chosen.validation.empty()) chosen.validation = {{0, validation_frames}};
  if (chosen.train.empty()) {
    // The end of the clip is kept for validation.
    const int last = chosen.validation.empty() ? T - std::max(1, T / 5) : T;
    chosen.train = {{0, last}};
    if (chosen.validation.empty() && last < T) chosen.validation = {{last, T}};
  }
  chosen.train = TakeShare(CutAtGaps(chosen.train, frames), request.share);
  chosen.validation = CutAtGaps(chosen.validation, validation != nullptr ? *validation : frames);
  return chosen;
}

int ReachOf(MotionData* data, const std::vector<FrameRange>& ranges) {
  if (!data->has_labels()) return 0;
  std::vector<int> all;
  for (const FrameRange& range : ranges) {
    for (int t = range.begin; t < range.end; ++t) all.push_back(t);
  }
  std::vector<MotionFrame> frames;
  for (const int i : EvenlySpreadFrames(static_cast<int>(all.size()), kReachFrames)) {
    MotionFrame frame;
    data->Fill(all[i], true, &frame);
    frame.motion = frame.dense = frame.uv = frame.image = frame.normals = {};
    frames.push_back(std::move(frame));
  }
  return ClothesReach(frames);
}

TrainMotionSummary TrainMotionRenderer(const TrainMotionRendererRequest& request, const PipelineCallbacks& callbacks) {
  TrainMotionOptions options = request.options;
  MotionConfig& config = options.config;
  RequireReadable(request.data.data, "data");
  RequireReadable(request.data.track, "track");
  RequireReadable(request.data.mask, "mask");
  RequireReadable(request.data.part_labels, "part labels");
  OpenTrainingRun(request.out, &options);
  WeightsFolder weights = ReadWeightsFolder(request.weights);
  options.vgg16 = std::move(weights.vgg16);
  options.alexnet = std::move(weights.alexnet), options.lpips_heads = std::move(weights.lpips_heads);
  options.ssim = WindowSsim;

  MotionDataRequest data_request = request.data;
  data_request.num_threads = options.num_threads;
  data_request.descriptor = config.descriptor;
  SetAxesPose(request.cameras, request.view, request.data.track, &data_request.motion);
  if (std::string why; !data_request.motion.IsValid(&why)) throw RequestError(why);
  MotionData data(data_request, config.profile, config.Multiple());
  SayLines(data.notes(), callbacks);
  LeaveOutUnknown(data, &config, callbacks);
  config.motion_channels = MotionChannels(config.descriptor, data.frames().options().past);
  const std::unique_ptr<MotionData> validation = ValidationData(request, data_request, data, config);
  if (validation) {
    options.validation_source = [&](int t, bool with_truth, MotionFrame* frame) {
      validation->Fill(t, with_truth, frame);
    };
  }
  const TrainingFrames chosen =
      ChooseFrames(request.frames, data.frames(), validation ? &validation->frames() : nullptr);
  options.train = chosen.train, options.validation = chosen.validation;
  options.reach = ReachOf(&data, options.train);
  config.around_body = !request.whole_window && options.reach > 0;
  const MotionRun run = RunOf(request, options, data);
  options.config_json = MotionRunJson(run);
  WriteRunConfig(options);
  SayWhatIsTrained(run, data.frames().window(), callbacks);

  FollowTraining(options.steps, callbacks, &options);
  options.preview = [&](int step, const std::vector<MotionPreview>& previews) {
    std::vector<std::vector<Image>> rows;
    for (const MotionPreview& preview : previews) rows.push_back(RowOf(preview));
    if (!previews.empty()) WritePreview(options, step, rows, previews.back().height);
  };
  const TrainMotionSummary summary =
      TrainMotion([&](int t, bool with_truth, MotionFrame* frame) { data.Fill(t, with_truth, frame); }, options);
  RequireFinite(summary, request.out);
  return summary;
}

}  // namespace bodyloom
