// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/train_motion.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/exit_code.h"
#include "apps/neural/motion_data.h"
#include "apps/neural/motion_preview.h"
#include "apps/neural/motion_run.h"
#include "apps/neural/motion_scores_text.h"
#include "apps/neural/training_options.h"
#include "apps/neural/training_session.h"
#include "apps/neural/weights_folder.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/motion/clothes_reach.h"
#include "bodyloom/neural/motion/train_motion.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kShareStretch = 32;  ///< frames: with less of the data, whole stretches of so many are kept

struct Request {
  MotionDataRequest data;
  std::string shape_loss = "ce", validate_data, out, profile = "cpu", weights;
  std::vector<std::string> without, train, validate;
  double share = 1;
  bool whole_window = false;
  TrainMotionOptions options;
};

/// "12-40" (last frame included) → [12, 41).
FrameRange ParseRange(const std::string& text, const char* option) {
  int first = 0, last = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d-%d%c", &first, &last, &rest) != 2 || first < 0 || last < first) {
    throw RequestError(Concatenate(option, " ", text, ": expected FIRST-LAST, such as 0-149"));
  }
  return {first, last + 1};
}

std::vector<FrameRange> Ranges(const std::vector<std::string>& texts, const char* option, int num_frames) {
  std::vector<FrameRange> ranges;
  for (const std::string& text : texts) {
    ranges.push_back(ParseRange(text, option));
    if (ranges.back().end > num_frames) {
      throw RequestError(Concatenate(option, " ", text, ": the clip has frames 0 to ", num_frames - 1));
    }
  }
  return ranges;
}

/// The ranges without frames that have no result, cut where the clock jumps: a recurrent network must not be led
/// across.
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
  std::vector<FrameRange> kept;
  for (int i = 0; i < static_cast<int>(count + 0.5); ++i) {
    kept.push_back(stretches[static_cast<size_t>(i * static_cast<double>(stretches.size()) / count)]);
  }
  return kept;
}

nlohmann::ordered_json RangesJson(const std::vector<FrameRange>& ranges) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const FrameRange& range : ranges) json.push_back({range.begin, range.end - 1});
  return json;
}

std::string Notes(const Request& request) {
  const TrainMotionOptions& o = request.options;
  const nlohmann::ordered_json json = {{"data", request.data.data},
                                       {"track", request.data.track},
                                       {"validate_data", request.validate_data},
                                       {"train", RangesJson(o.train)},
                                       {"validate", RangesJson(o.validation)},
                                       {"share", request.share},
                                       {"seed", o.seed},
                                       {"steps", o.steps},
                                       {"batch", o.batch},
                                       {"chain_length", o.chain_length},
                                       {"walks", o.walks},
                                       {"learning_rate", o.learning_rate},
                                       {"average", o.average},
                                       {"discriminator_rate", o.discriminator_rate},
                                       {"shape_loss", request.shape_loss},
                                       {"weights",
                                        {{"shape", o.shape_weight},
                                         {"normals", o.normal_weight},
                                         {"perceptual", o.perceptual_weight},
                                         {"gan", o.gan_weight}}},
                                       {"threads", o.num_threads}};
  return json.dump();
}

/// `validation`: of the clip that is for validation alone, null: there is none.
void ChooseFrames(const Request& request, const PersonFrames& frames, const PersonFrames* validation,
                  TrainMotionOptions* options) {
  const int T = frames.num_frames(), validation_frames = validation != nullptr ? validation->num_frames() : 0;
  options->train = Ranges(request.train, "--train", T);
  options->validation = Ranges(request.validate, "--validate", validation_frames > 0 ? validation_frames : T);
  if (validation_frames > 0 && options->validation.empty()) options->validation = {{0, validation_frames}};
  if (options->train.empty()) {
    // The end of the clip is kept for validation.
    const int last = options->validation.empty() ? T - std::max(1, T / 5) : T;
    options->train = {{0, last}};
    if (options->validation.empty() && last < T) options->validation = {{last, T}};
  }
  options->train = TakeShare(CutAtGaps(options->train, frames), request.share);
  options->validation = CutAtGaps(options->validation, validation != nullptr ? *validation : frames);
}

/// Of frames spread over the ranges.
int ReachOf(MotionData* data, const std::vector<FrameRange>& ranges) {
  if (data->labels() == LabelSource::kNone) return 0;
  constexpr int kFrames = 64;
  std::vector<int> all;
  for (const FrameRange& range : ranges) {
    for (int t = range.begin; t < range.end; ++t) all.push_back(t);
  }
  std::vector<MotionFrame> frames;
  for (const int i : EvenlySpreadFrames(static_cast<int>(all.size()), kFrames)) {
    MotionFrame frame;
    data->Fill(all[i], true, &frame);
    frame.motion = frame.uv = frame.image = frame.normals = {};
    frames.push_back(std::move(frame));
  }
  return ClothesReach(frames);
}

void Run(Request request) {
  TrainMotionOptions& options = request.options;
  MotionConfig& config = options.config;
  config.profile = MotionProfileNamed(request.profile);
  for (const std::string& part : request.without) {
    if (part == "shape") config.shape = false;
    if (part == "normal") config.normals = false;
    if (part == "motion") config.motion = false;
    if (part == "surface") config.surface = false;
    if (part == "texture") config.texture = false;
  }
  options.shape_by_cross_entropy = request.shape_loss == "ce";
  RequireReadable(request.data.data, "data");
  RequireReadable(request.data.track, "track");
  OpenTrainingRun(request.out, &options);
  request.data.num_threads = options.num_threads;
  options.vgg16 = ReadWeightsFolder(request.weights).vgg16;

  MotionData data(request.data, config.profile, config.Multiple());
  std::cout << data.notes();
  if (data.labels() == LabelSource::kNone && config.shape) {
    config.shape = false;
    std::cout << "no labels: trained without shape, on the whole window with its background\n";
  }
  if (!data.has_normals() && config.normals) {
    config.normals = false;
    std::cout << "no normals: trained without them\n";
  }
  config.motion_channels = data.frames().channels();
  std::unique_ptr<MotionData> validation;
  if (!request.validate_data.empty()) {
    MotionDataRequest other = request.data;
    other.data = request.validate_data;
    other.track.clear();
    other.pixels_per_metre = data.PixelsPerMetre();
    validation = std::make_unique<MotionData>(other, config.profile, config.Multiple());
    options.validation_source = [&](int t, bool with_truth, MotionFrame* frame) {
      validation->Fill(t, with_truth, frame);
    };
  }
  ChooseFrames(request, data.frames(), validation ? &validation->frames() : nullptr, &options);
  MotionRun run;
  options.reach = ReachOf(&data, options.train);
  config.around_body = !request.whole_window && options.reach > 0;
  run.config = config;
  run.pixels_per_metre = data.PixelsPerMetre();
  run.reach = options.reach;
  run.past = data.frames().options().past;
  run.notes = Notes(request);
  const std::vector<double>& times = data.track().motion.timestamps;
  if (times.size() > 1) run.fps = static_cast<double>(times.size() - 1) / (times.back() - times.front());
  options.config_json = MotionRunJson(run);
  WriteRunConfig(options);
  const PersonWindow& window = data.frames().window();
  std::cout << "window " << window.width << "x" << window.height << " px, " << run.pixels_per_metre
            << " px a metre; profile " << config.profile.name
            << (config.around_body ? Concatenate("; ", run.reach, " px around the body") : "; the whole window") << "\n"
            << std::flush;

  TrainingBar bar(options.steps);
  options.progress = [&](const TrainMotionProgress& progress) {
    return bar.Update(progress.step, {{"loss", progress.loss}, {"image", progress.image}},
                      progress.scores.frames > 0 ? &progress.scores.psnr_db : nullptr);
  };
  options.preview = [&](int step, const std::vector<MotionPreview>& previews) {
    if (!previews.empty()) WriteImage(PreviewPath(options, step), MotionPreviewSheet(previews));
  };
  const TrainMotionSummary summary =
      TrainMotion([&](int t, bool with_truth, MotionFrame* frame) { data.Fill(t, with_truth, frame); }, options);
  RequireFinite(summary, request.out);
  for (const std::string& loss : summary.losses_off) std::cout << "loss switched off: " << loss << "\n";
  if (options.perceptual_weight > 0 && summary.perceptual_stand_in) SayStandIn("perceptual loss", "VGG-16");
  SayStep(summary, options.steps);
  if (summary.scores.frames > 0) std::cout << "validation: " << ScoresText(summary.scores) << "\n";
  EndTrainingRun(summary, request.out);
}

}  // namespace

void AddTrainMotion(CLI::App& train, std::function<void()>* action) {
  CLI::App* verb = train.add_subcommand("motion", "Trains a renderer of one person's motion-dependent appearance");
  auto request = std::make_shared<Request>();
  TrainMotionOptions& options = request->options;
  verb->add_option("--data", request->data.data, "A person set (bodyloom synth-person), or a video or folder of images")
      ->required();
  verb->add_option("--track", request->data.track, "The clip's track (default: the person set's own)");
  verb->add_option("--out", request->out, "Folder of the run: config.json, checkpoint.bin, metrics.csv, previews")
      ->required();
  verb->add_option("--body", request->data.body, "The track's body (default: the built-in body)");
  verb->add_option("--part-labels", request->data.part_labels,
                   "For a video: DensePose's parts (.npz), for outline and classes");
  AddProfileOption(verb, &request->profile);
  verb->add_option("--without", request->without,
                   "Leave out a part, as the paper's ablations do; surface, texture: the decoders see neither UV "
                   "coordinates nor a "
                   "learned texture, as in the paper")
      ->check(CLI::IsMember({"shape", "normal", "motion", "surface", "texture"}));
  verb->add_option("--train", request->train, "Frames to train on, FIRST-LAST (default: the first four fifths)");
  verb->add_option("--validate", request->validate, "Frames to validate on (default: the last fifth)");
  verb->add_option("--validate-data", request->validate_data,
                   "Validate on another person set of the same person, in another motion");
  verb->add_option("--share", request->share, "Of the training frames that is used, in stretches of 32")
      ->check(CLI::Range(0.001, 1.0))
      ->capture_default_str();
  verb->add_option("--steps", options.steps, "Batches to train on")->capture_default_str();
  verb->add_option("--batch", options.batch, "Frames in a batch")->capture_default_str();
  verb->add_option("--chain", options.chain_length, "Frames that the recurrence runs on before it starts anew")
      ->capture_default_str();
  verb->add_option("--walks", options.walks,
                   "Stretches of the clip that every place of the batch goes through in turn, a frame each")
      ->capture_default_str();
  verb->add_flag("--whole-window", request->whole_window,
                 "The networks look at the whole window, not only at where the body is and as far as clothes reach");
  verb->add_option("--learning-rate", options.learning_rate, "At its highest")->capture_default_str();
  verb->add_option("--average", options.average,
                   "Keep the average of the weights over the last part of the run, this share of the steps old in the "
                   "mean (0: the last step's)")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  verb->add_option("--shape-loss", request->shape_loss, "Of the classes: cross entropy or absolute differences")
      ->check(CLI::IsMember({"ce", "l1"}))
      ->capture_default_str();
  verb->add_option("--patience", options.patience, "Stop after so many validations without a better one (0: never)")
      ->capture_default_str();
  verb->add_option("--weights", request->weights,
                   "Folder with trained networks: vgg16 (.pth or .safetensors) for the perceptual loss");
  AddTrainingOptions(verb, &options, "Of weights and order of frames");
  verb->footer(
      "Example:\n"
      "  bodyloom synth-person --motion dance.pkl --out dancer --frames 600\n"
      "  bodyloom train motion --data dancer --out run --steps 4000\n"
      "  bodyloom animate motion --run run --track other.npz --out other.mp4");
  verb->callback([request, action] { *action = [request] { Run(*request); }; });
}

}  // namespace bodyloom
