// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/run_estimate.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "pipelines/report_json.h"
#include "pipelines/report_text.h"
#include "pipelines/track/chosen_people.h"
#include "pipelines/track/detected_people.h"
#include "pipelines/track/track_inputs.h"

namespace bodyloom {
namespace {

// Processor seconds of the reference machine, an AMD EPYC (Zen 5); docs/lab/run_speed.md, "How cost grows".
constexpr double kJointsFrameS = 0.0026;    ///< a person and frame of one fit
constexpr double kMaskFrameS = 0.015;       ///< with its mask, of which fifteen a second are used
constexpr double kMaskPixelFrameS = 0.012;  ///< … of a person of 1000 pixels, by the square of the height
constexpr double kMasksPerSecond = 15;
constexpr double kOverlayFrameS = 0.004, kOverlayMegapixelS = 0.015, kOverlayPersonS = 0.004;
constexpr double kStartS = 0.6;        ///< the program's start and end
constexpr double kProductsS = 0.030;   ///< SecondsOfProducts()
constexpr double kSharedTimes = 0.75;  ///< wall-clock time = processor time / threads to this power

// Memory in bytes.
constexpr double kBaseBytes = 330e6, kBytesOfPixel = 60, kOverlayBytesOfPixel = 120;
constexpr double kBytesOfPersonFrame = 45e3, kBytesOfMask = 180e3;
constexpr double kFramesInWhole = 2000, kBytesOfFurtherFrame = 13e3;  ///< longer clips are solved in windows

double ProcessorSeconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

/// Processor time of a fixed piece of work: products of matrices that stay in the cache.
double SecondsOfProducts() {
  constexpr int kSize = 96, kTimes = 400;
  const Eigen::MatrixXd A = Eigen::MatrixXd::Constant(kSize, kSize, 1.0 / kSize);
  Eigen::MatrixXd B = A, C = A;
  const double start = ProcessorSeconds();
  for (int i = 0; i < kTimes; ++i) {
    C.noalias() = A * B;
    B.swap(C);
  }
  // The sum is one of ones: it is read so that the products are computed.
  return B.allFinite() ? ProcessorSeconds() - start : 0;
}

/// The settings with a span of `seconds` from its beginning.
TrackSettings Beginning(TrackSettings track, double seconds) {
  const double end = track.from_s + seconds;
  track.to_s = track.to_s < 0 ? end : std::min(track.to_s, end);
  return track;
}

/// Several people are fitted again, without masks but in the last fit, with the focal length and the ground of all;
/// finding what hides them costs as much as a fit without masks.
int NumFits(const RunWork& work) { return work.people_px.size() > 1 ? 4 : 1; }

std::string BriefReport(const RunPlan& plan) {
  const RunWork& work = plan.work;
  std::string stages;
  double sum = 0;
  for (const auto& [stage, seconds] : plan.estimate.processor_seconds) sum += seconds;
  for (const auto& [stage, seconds] : plan.estimate.processor_seconds) {
    stages += Concatenate(stages.empty() ? "" : ", ", stage, " ", Fixed(plan.estimate.seconds * seconds / sum, 1));
  }
  return Concatenate("about ", Fixed(plan.estimate.seconds, plan.estimate.seconds < 10 ? 1 : 0), " s (", stages, "), ",
                     Fixed(1e-9 * double(plan.estimate.peak_memory_bytes), 2), " GB, for ", work.num_frames,
                     " frames of ", work.width, "x", work.height, " with ", work.people_px.size(),
                     work.people_px.size() == 1 ? " person" : " people");
}

}  // namespace

RunEstimate EstimateRun(const RunWork& work) {
  BODYLOOM_CHECK(work.num_frames > 0 && work.fps > 0 && work.width > 0 && work.height > 0 && work.threads > 0 &&
                     work.detect_s > 0 && work.machine > 0,
                 "estimate: ", work.num_frames, " frames of ", work.width, "x", work.height, " at ", work.fps,
                 " a second, expected positive numbers");
  const double frames = work.num_frames, megapixels = 1e-6 * work.width * work.height;
  const double masked = work.masks ? std::min(1.0, kMasksPerSecond / work.fps) : 0;
  double joints_s = 0, masks_s = 0;
  for (const double height_px : work.people_px) {
    const double size = 1e-3 * height_px;
    joints_s += kJointsFrameS;
    masks_s += masked * (kMaskFrameS + kMaskPixelFrameS * size * size);
  }
  const double people = static_cast<double>(work.people_px.size());
  RunEstimate estimate;
  estimate.processor_seconds = {
      {"detect", work.detect_start_s + frames * work.detect_s},
      {"track", work.machine * (kStartS + frames * (NumFits(work) * joints_s + masks_s))},
  };
  if (work.overlay) {
    estimate.processor_seconds.emplace_back(
        "overlay",
        work.machine * frames * (kOverlayFrameS + kOverlayMegapixelS * megapixels + kOverlayPersonS * people));
  }
  for (const auto& [stage, seconds] : estimate.processor_seconds) estimate.seconds += seconds;
  estimate.seconds /= std::pow(work.threads, kSharedTimes);
  const double bytes_of_pixel = kBytesOfPixel + (work.overlay ? kOverlayBytesOfPixel : 0);
  const double whole = std::min(frames, kFramesInWhole);
  estimate.peak_memory_bytes = static_cast<size_t>(
      kBaseBytes + bytes_of_pixel * 1e6 * megapixels +
      people * (whole * (kBytesOfPersonFrame + masked * kBytesOfMask) + (frames - whole) * kBytesOfFurtherFrame));
  return estimate;
}

RunPlan PlanRun(const TrackPeopleClipRequest& request, const PipelineCallbacks& callbacks) {
  CheckTrackPeopleRequest(request);
  CheckTrackSettings(request.track);
  RequireFiles(request.track, request.track.detector);
  TrackSettings track = WithTurn(request.track, callbacks);
  track.detector.hands_and_faces = HandsFor(request, {}, *BodyOrBuiltin(track.body));
  RunPlan plan;
  RunWork& work = plan.work;
  {
    const FrameSource frames(track.video, DetectionOf(track).span);
    work.num_frames = std::max(1, frames.num_frames());
    work.fps = frames.fps();
    work.width = frames.info().width;
    work.height = frames.info().height;
  }
  const double start = ProcessorSeconds();
  DetectForTracking(Beginning(track, 0), callbacks, request.max_people);
  const double one_frame = ProcessorSeconds();
  TrackPeopleRequest second = request;
  second.track = Beginning(track, 1);
  const DetectedClip clip = DetectForTracking(second.track, callbacks, request.max_people);
  const double all_frames = ProcessorSeconds();
  const auto count = static_cast<double>(clip.people.frames.size());
  work.detect_start_s = one_frame - start;
  // One frame in thirty is searched for new people, as the first one is.
  work.detect_s =
      std::max(1e-4, count > 1 ? (all_frames - one_frame - 0.5 * work.detect_start_s) / count : work.detect_start_s);
  work.masks = DetectsMasks(track);
  work.overlay = request.overlay;
  work.threads = ThreadsFor(track.solve.num_threads);
  work.machine = SecondsOfProducts() / kProductsS;
  for (const FoundPerson& person : FoundPeople(clip.people, LinkPeople(clip.people))) {
    if (2 * person.frames >= static_cast<int>(count)) work.people_px.push_back(person.height_px);
  }
  const size_t most = request.person ? 1 : request.max_people > 0 ? size_t(request.max_people) : work.people_px.size();
  if (work.people_px.empty()) work.people_px.push_back(0.5 * work.height);
  work.people_px.resize(std::clamp<size_t>(most, 1, work.people_px.size()));
  plan.estimate = EstimateRun(work);
  return plan;
}

std::string ToText(const RunPlan& plan) {
  return BriefReport(plan) + "\n" +
         Concatenate("measured on the first second: ", Fixed(1e3 * plan.work.detect_s, 1),
                     " ms of processor time a frame to detect; this machine takes ", Fixed(plan.work.machine, 2),
                     " times the reference's time, ", plan.work.threads, " threads\n");
}

std::string ToJson(const RunPlan& plan) {
  nlohmann::ordered_json json = {{"frames", plan.work.num_frames},
                                 {"fps", plan.work.fps},
                                 {"image_size", {plan.work.width, plan.work.height}},
                                 {"people_px", plan.work.people_px},
                                 {"masks", plan.work.masks},
                                 {"overlay", plan.work.overlay},
                                 {"threads", plan.work.threads},
                                 {"machine", plan.work.machine},
                                 {"processor_seconds", ToJson(plan.estimate.processor_seconds)},
                                 {"total_seconds", plan.estimate.seconds},
                                 {"peak_memory_bytes", plan.estimate.peak_memory_bytes}};
  return json.dump(2) + "\n";
}

}  // namespace bodyloom
