// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/animate_motion.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/neural/background.h"
#include "apps/neural/composite.h"
#include "apps/neural/composite_score.h"
#include "apps/neural/freeze_option.h"
#include "apps/neural/motion_data.h"
#include "apps/neural/motion_errors.h"
#include "apps/neural/motion_preview.h"
#include "apps/neural/motion_run.h"
#include "apps/neural/motion_scores_text.h"
#include "apps/neural/relight_frames.h"
#include "apps/neural/result_set.h"
#include "apps/neural/view_angles.h"
#include "apps/progress.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/datasets/person_set.h"
#include "bodyloom/data_tools/descriptors/person_frames.h"
#include "bodyloom/data_tools/descriptors/posed_track.h"
#include "bodyloom/data_tools/evaluation/motion_similarity.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/freeze_track.h"
#include "bodyloom/data_tools/motion/play_track.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/data_tools/video/video_writer.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/neural/metrics/temporal_lpips.h"
#include "bodyloom/neural/motion/motion_renderer.h"
#include "bodyloom/neural/motion/motion_scores.h"
#include "bodyloom/neural/motion/train_motion.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kLargestSide = 4096;

struct Request {
  std::string run, track, data, out, body, background, sheet, json, view_yaw, relight, frames, like, set, freeze;
  int threads = 0, warmup = 50;
  double speed = 1;
  std::string device = "cpu";
  bool anywhere = false, full_size = false, without_past = false;
};

/// What makes the set of --set again.
std::string CommandLine(const Request& request) {
  std::string line = "bodyloom animate motion";
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) line += std::string(" ") + option + " " + value;
  };
  add("--run", request.run), add("--track", request.track), add("--data", request.data), add("--body", request.body);
  add("--background", request.background), add("--relight", request.relight);
  if (request.speed != 1) add("--speed", Concatenate(request.speed));
  add("--freeze", request.freeze);
  if (request.warmup != Request().warmup) add("--warmup", Concatenate(request.warmup));
  line += request.anywhere ? " --anywhere" : "";
  line += request.without_past ? " --without-past" : "";
  line += request.full_size ? " --full-size" : "";
  add("--out", request.out), add("--set", request.set);
  return line;
}

/// The pictures of a frame side by side, for the contact sheet.
void AddToSheet(const MotionPicture& picture, const Image& composed, std::vector<Image>* pictures) {
  pictures->push_back(composed);
  if (!picture.labels.empty()) pictures->push_back(LabelsPicture(picture.labels, picture.width, picture.height));
  if (!picture.normals.empty()) pictures->push_back(NormalPicture(picture.normals, picture.width, picture.height));
}

/// LPIPS and tLPIPS of the windows, both on black.
class Likeness {
 public:
  static constexpr int kSmallest = 32;  ///< pixels a side that LPIPS' network takes
  void Add(const MotionPicture& picture, const MotionFrame& truth) {
    temporal_.Add(PictureOf(picture.image, picture.width, picture.height),
                  PictureOf(truth.image, truth.width, truth.height));
  }
  void Restart() { temporal_.Restart(); }
  [[nodiscard]] TemporalLpipsMean Mean() const { return temporal_.Mean(); }

 private:
  Lpips lpips_;
  TemporalLpips temporal_{lpips_};
};

/// What is animated: a track, or a person set whose pictures the result is compared with.
struct Clip {
  std::unique_ptr<MotionData> data;
  std::shared_ptr<const BodyModel> body;
  std::optional<Track> own_track;  ///< before anything is shown more than once
  std::optional<PersonFrames> own_frames;
  [[nodiscard]] const Track& track() const { return data ? data->track() : own_frames->track(); }
  [[nodiscard]] const PersonFrames& frames() const { return data ? data->frames() : *own_frames; }
  void Fill(int t, MotionFrame* frame) const {
    if (data) {
      data->Fill(t, true, frame);
    } else {
      FillMotion(*own_frames, t, frame);
    }
  }
};

/// Whether the result is compared: from another side or in another time there is nothing to compare with.
bool IsScored(const Request& request) {
  return !request.data.empty() && request.view_yaw.empty() && request.freeze.empty() && request.speed == 1;
}

void OpenClip(const Request& request, const MotionRun& run, int threads, Clip* clip) {
  if (IsScored(request)) {
    MotionDataRequest data;
    data.data = request.data, data.body = request.body;
    data.pixels_per_metre = run.pixels_per_metre;
    data.num_threads = threads;
    clip->data = std::make_unique<MotionData>(data, run.config.profile, run.config.Multiple());
    return;
  }
  clip->own_track = request.data.empty() ? ReadTrack(request.track) : PersonSet(request.data).track();
  if (request.speed != 1) {
    try {
      clip->own_track = PlayedAtSpeed(*clip->own_track, request.speed);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(request.track + request.data + ": --speed: " + error.what());
    }
  }
  clip->body = BodyOrBuiltin(request.body);
  const double size = PixelsPerMetre(*clip->body, *clip->own_track);
  if (!(size > 0)) {
    throw std::runtime_error(request.track + request.data + ": no frame has a result, nothing to animate");
  }
  PersonFramesOptions options;
  options.uv_size = run.config.profile.uv_size;
  options.past = run.past;
  options.window.scale = ScaleToSize(run.pixels_per_metre, size);
  options.window.multiple = run.config.Multiple();
  options.num_threads = threads;
  int num_frames = clip->own_track->num_frames(), first = 0, last = num_frames - 1;
  if (!request.freeze.empty()) {
    const Freeze freeze = ReadFreeze(request.freeze, num_frames);
    options.shown = FrozenAt(num_frames, freeze.frame, freeze.count);
    num_frames += freeze.count, first = freeze.frame, last = freeze.frame + freeze.count;
  }
  options.yaw_deg = ViewAngles(request.view_yaw, num_frames, first, last);
  clip->own_frames.emplace(*clip->body, *clip->own_track, options);
}

/// The light of the clip from its first frames, rendered for it.
void EstimateLight(const Clip& clip, MotionRenderer* renderer, FrameRelighter* relighter) {
  Progress progress("light");
  MotionFrame frame;
  const int count = std::min(FrameRelighter::kFrames, clip.track().num_frames());
  for (int t = 0; t < count; ++t) {
    ThrowIfInterrupted();
    progress.Update("rendering", static_cast<double>(t + 1) / count);
    if (!clip.track().HasResult(t)) continue;
    FillMotion(clip.frames(), t, &frame);
    relighter->Observe(renderer->Next(frame));
  }
  relighter->Estimate();
}

/// Of each frame to the nearest of --like; empty without it.
std::vector<float> SimilarityTo(const Request& request, const Track& track, int past, int threads) {
  if (request.like.empty()) return {};
  const Track others =
      std::filesystem::is_directory(request.like) ? PersonSet(request.like).track() : ReadTrack(request.like);
  try {
    return SimilarityToNearest(*BodyOrBuiltin(request.body), track, others, past, threads);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(request.like + ": " + error.what());
  }
}

nlohmann::ordered_json ScoresJson(const MotionScores& s) {
  return {{"frames", s.frames},         {"image_l1", s.image_l1},   {"psnr_db", s.psnr_db},
          {"label_iou", s.label_iou},   {"class_iou", s.class_iou}, {"foreground_iou", s.foreground_iou},
          {"normal_deg", s.normal_deg}, {"flicker", s.flicker}};
}

void Run(const Request& request) {
  const StageClock clock;
  double counted_s = 0;
  // Stages come around every frame: their times are summed.
  std::vector<std::pair<const char*, double>> seconds = {
      {"prepare", 0}, {"light", 0}, {"maps", 0}, {"network", 0}, {"compose and encode", 0}};
  const auto lap = [&](int stage) {
    const double now_s = clock.total(), took_s = now_s - counted_s;
    seconds[stage].second += took_s;
    counted_s = now_s;
    return took_s;
  };
  if (request.track.empty() == request.data.empty()) throw RequestError("expected one of --track and --data");
  RequireReadable(request.track, "track");
  RequireReadable(request.background, "background");
  RequireReadable(request.data, "person set");
  RequireReadable(request.relight, "light");
  RequireDistinct({request.track, request.background, request.body, request.relight},
                  {request.out, request.sheet, request.json, request.frames});
  for (const std::string& path : {request.out, request.sheet, request.json, request.frames}) RequireWritable(path);
  RequireReadable(request.like, "person set or track");
  if (!request.set.empty()) {
    RequireWritableFolder(request.set);
    if (!request.view_yaw.empty())
      throw RequestError("--set writes the track beside the pictures: not with --view-yaw");
    RequireDistinct({request.data, request.like}, {request.set});
  }
  std::unique_ptr<FrameRelighter> relighter;
  if (!request.relight.empty()) relighter = std::make_unique<FrameRelighter>(ReadRelight(request.relight));
  const MotionRun run = ReadMotionRun(request.run);
  if (relighter && !run.config.normals) {
    throw std::runtime_error(request.run + ": was trained without surface normals, which --relight needs");
  }
  const int threads = request.threads > 0 ? request.threads : static_cast<int>(std::thread::hardware_concurrency());
  Clip clip;
  OpenClip(request, run, threads, &clip);
  const Track& track = clip.track();
  const PersonFrames& frames = clip.frames();
  const PersonWindow& window = frames.window();
  if (std::max({window.width, window.height, window.picture_width, window.picture_height}) > kLargestSide) {
    throw std::runtime_error(Concatenate(request.track,
                                         ": at the size that the person was trained at the picture would "
                                         "have ",
                                         window.picture_width, "x", window.picture_height, " px, at most ",
                                         kLargestSide, " a side; the track's person is too small in its picture"));
  }
  const bool scored = IsScored(request);
  if (!scored && !(request.like.empty() && request.frames.empty())) {
    throw RequestError(
        "--like and --frames compare with the pictures of --data: not without it, --view-yaw, --freeze or --speed");
  }
  MotionRenderer renderer(CheckpointPath(request.run), run.config,
                          {request.warmup, run.reach, request.anywhere, scored, threads, request.device});
  lap(0);
  if (relighter && relighter->wants_frames()) {
    MotionRenderer before(CheckpointPath(request.run), run.config,
                          {request.warmup, run.reach, request.anywhere, false, threads, request.device});
    EstimateLight(clip, &before, relighter.get());
  }
  lap(1);
  const PictureSize size = SizeOfPictures(window, track.camera, request.full_size);
  Background background(request.background, size.width, size.height);
  const double fps = track.num_frames() > 1
                         ? (track.num_frames() - 1) / (track.motion.timestamps.back() - track.motion.timestamps.front())
                         : run.fps;
  MotionErrors errors(SimilarityTo(request, track, run.past, threads));
  VideoWriter video(request.out, size.width, size.height, fps);
  std::optional<ResultSet> set;
  if (!request.set.empty()) {
    set.emplace(request.set, track, fps, run.config.shape, run.config.normals, CommandLine(request));
  }
  const std::vector<int> on_sheet = EvenlySpreadFrames(track.num_frames(), 6);
  std::vector<Image> sheet;
  std::vector<double> network_ms;
  std::optional<Likeness> likeness;
  if (scored && std::min(window.width, window.height) >= Likeness::kSmallest) likeness.emplace();
  std::optional<CompositeScore> composite;
  if (scored && !request.background.empty()) {
    composite.emplace(request.data, size.width, size.height);
  }
  int lost = 0, sheet_columns = 1;
  {
    Progress progress("animate");
    MotionFrame frame;
    for (int t = 0; t < track.num_frames(); ++t) {
      ThrowIfInterrupted();
      Image composed = background.Next();
      MotionPicture picture;
      if (track.HasResult(t)) {
        clip.Fill(t, &frame);
        const bool is_cut = t > 0 && frames.Segment(t) != frames.Segment(t - 1);
        if (is_cut || request.without_past) renderer.Restart();
        if (is_cut && likeness) likeness->Restart();
        lap(2);
        picture = renderer.Next(frame);
        const double network_s = lap(3);
        if (scored) errors.Add(t, renderer.last_l1());
        if (likeness) likeness->Add(picture, frame);
        if (t > 0) network_ms.push_back(1e3 * network_s);  // the first frame warms up
        if (relighter) relighter->Apply(&picture);
        Composite(picture.image, picture.alpha, window, t, &composed);
        if (composite) composite->Add(t, composed);
      } else {
        ++lost;
      }
      video.Write(composed);
      if (set) set->Add(t, picture, window, composed);
      if (!request.sheet.empty() && std::binary_search(on_sheet.begin(), on_sheet.end(), t) && track.HasResult(t)) {
        const size_t before = sheet.size();
        AddToSheet(picture, composed, &sheet);
        sheet_columns = static_cast<int>(sheet.size() - before);
      }
      lap(4);
      progress.Update("rendering", static_cast<double>(t + 1) / track.num_frames());
    }
    video.Finish();
    if (set) set->Finish();
  }
  lap(4);
  if (!sheet.empty()) {
    ContactSheetOptions layout;
    layout.columns = sheet_columns;
    layout.cell_height_px = window.picture_height;
    WriteImage(request.sheet, ContactSheet(sheet, layout));
  }
  const MotionScores scores = renderer.scores();
  const std::vector<MotionErrors::Quarter> quarters = errors.Quarters();
  if (!request.frames.empty()) errors.WriteCsv(request.frames);
  std::sort(network_ms.begin(), network_ms.end());
  const double median_ms = network_ms.empty() ? 0 : network_ms[network_ms.size() / 2];
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const auto& [stage, stage_s] : seconds) stages[stage] = stage_s;
  if (!request.json.empty()) {
    nlohmann::ordered_json json = {{"frames", track.num_frames()},
                                   {"frames_without_fit", lost},
                                   {"window", {window.width, window.height}},
                                   {"picture", {size.width, size.height}},
                                   {"network_ms_median", median_ms},
                                   {"descriptors_kept", renderer.descriptors_kept()},
                                   {"projections_kept", renderer.projections_kept()},
                                   {"seconds", stages},
                                   {"output", request.out}};
    if (relighter) json["relight"] = relighter->Json();
    if (scored) json["scores"] = ScoresJson(scores);
    if (!quarters.empty()) json["scores"]["by_similarity"] = ToJson(quarters);
    if (likeness) {
      json["scores"]["lpips"] = likeness->Mean().lpips;
      json["scores"]["tlpips"] = likeness->Mean().tlpips;
      json["scores"]["lpips_is_stand_in"] = likeness->Mean().stand_in;
    }
    if (composite) {
      json["scores"]["whole_picture_psnr_db"] = composite->psnr_db();
      json["scores"]["rim_psnr_db"] = composite->rim_psnr_db();
    }
    WriteFileAtomically(request.json, json.dump(2) + "\n");
  }
  std::printf("%d frames, window %dx%d px of a %dx%d picture, network %.0f ms a frame, %.1f frames/s in all\n",
              track.num_frames(), window.width, window.height, window.picture_width, window.picture_height, median_ms,
              track.num_frames() / std::max(1e-9, clock.total()));
  if (lost > 0) std::printf("%d frames have no fit and show the background\n", lost);
  if (relighter && relighter->wants_frames() && !relighter->summary().IsUsable()) {
    std::printf("light of the clip not found (%s): taken as even\n", ToString(relighter->summary().status).c_str());
  }
  if (renderer.descriptors_kept() > 0) {
    std::printf("%lld frames did not move: their descriptors were not computed again\n",
                static_cast<long long>(renderer.descriptors_kept()));
  }
  if (scored) {
    std::printf("against %s: %s\n", request.data.c_str(), ScoresText(scores).c_str());
  }
  if (composite) {
    std::printf("over %s: PSNR %.2f dB of the whole picture, %.2f dB within %d px of the outline\n",
                request.background.c_str(), composite->psnr_db(), composite->rim_psnr_db(), CompositeScore::kRimPixels);
  }
  for (const MotionErrors::Quarter& quarter : quarters) {
    std::printf("  %d frames of similarity %.3f and more: L1 %.4f\n", quarter.frames, quarter.least_similarity,
                quarter.image_l1);
  }
  if (likeness) {
    const TemporalLpipsMean mean = likeness->Mean();
    std::printf("LPIPS %.4f, tLPIPS %.5f%s\n", mean.lpips, mean.tlpips,
                mean.stand_in ? " (stand-in network: compares with nothing but itself)" : "");
  }
  std::printf("wrote %s\n", request.out.c_str());
}

}  // namespace

void AddAnimateMotion(CLI::App& animate, std::function<void()>* action) {
  CLI::App* verb =
      animate.add_subcommand("motion", "Renders a person that `bodyloom train motion` learned, in any motion");
  auto request = std::make_shared<Request>();
  verb->add_option("--run", request->run, "Folder of the trained run")->required();
  verb->add_option("--track", request->track, "The motion: a track, .npz (default: that of --data)");
  verb->add_option("--data", request->data,
                   "A person set of the same person: the result is compared with its pictures (not with --view-yaw, "
                   "--freeze or --speed)");
  verb->add_option("--out", request->out, "The video, .mp4")->required();
  verb->add_option("--body", request->body, "The track's body (default: the built-in body)");
  verb->add_option("--view-yaw", request->view_yaw,
                   "Turns the view about the person's vertical, degrees; FROM:TO turns it over the clip");
  verb->add_option("--speed", request->speed, "Plays the motion so many times as fast: clothes move differently")
      ->check(CLI::Range(0.05, 20.0))
      ->capture_default_str();
  verb->add_option(
      "--freeze", request->freeze,
      "FRAME:COUNT: time stands still at that frame for so many more, while --view-yaw FROM:TO turns the view");
  verb->add_option("--background", request->background, "Image, video or folder of images behind the person");
  CLI::Option* full_size = verb->add_flag("--full-size", request->full_size, kFullSizeHelp);
  verb->add_option("--set", request->set,
                   "Also a person set: pictures, labels and normals without loss, for `bodyloom metrics`")
      ->type_name("DIR")
      ->needs(full_size);
  verb->add_option("--relight", request->relight,
                   "Other light: an environment image (equirectangular), or JSON with lights (docs/relighting.md)");
  verb->add_option("--warmup", request->warmup, "Passes of the first frame through the network before it counts")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000));
  verb->add_flag("--without-past", request->without_past,
                 "Every frame as if it were the first, warmed up from nothing: what its own motion says, not what the "
                 "renderer's last pictures do");
  verb->add_flag("--anywhere", request->anywhere,
                 "The person may be farther from the body than clothes ever were in training");
  verb->add_option(
      "--like", request->like,
      "A person set, or a track: with --data, the error by how much each frame's motion is like one there");
  verb->add_option("--frames", request->frames, "With --data: a line of CSV a frame, error and similarity");
  verb->add_option("--sheet", request->sheet, "Contact sheet of six frames: picture, labels, normals");
  verb->add_option("--json", request->json, "Report with times");
  verb->add_option("--threads", request->threads, "0: all cores")->check(CLI::NonNegativeNumber);
  verb->add_option("--device", request->device, "Where the networks run")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
  verb->footer("Example:\n  bodyloom animate motion --run run --track dance.npz --out dance.mp4 --view-yaw 0:360");
  verb->callback([request, action] { *action = [request] { Run(*request); }; });
}

}  // namespace bodyloom
