// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/run_live.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/mailbox.h"
#include "geometry/base/stopwatch.h"
#include "pipelines/detect/detect_people.h"
#include "pipelines/files.h"
#include "pipelines/live/live_outputs.h"
#include "pipelines/live/live_state.h"
#include "pipelines/report_text.h"
#include "pipelines/track/scene_inputs.h"
#include "tracking/live/live_ground.h"
#include "tracking/live/live_tracker.h"
#include "tracking/live/track_live.h"

namespace bodyloom {
namespace {

using LiveClock = LiveImage::Clock;

constexpr auto kPoll = std::chrono::milliseconds(50);
/// Frames whose landmarks wait for the solve: it is faster than the detector, but begins a shot in a tenth of a second.
constexpr size_t kWaitingLandmarks = 8;

double MillisecondsSince(LiveClock::time_point from) {
  return std::chrono::duration<double, std::milli>(LiveClock::now() - from).count();
}

/// A frame in which the person was looked for.
struct Landmarks {
  double seconds = 0;
  LiveClock::time_point arrived;
  int width = 0, height = 0;
  std::shared_ptr<const KeypointConvention> convention;
  std::vector<Keypoint> points;  ///< all missing where nobody was found
};

void CheckRequest(const RunLiveRequest& request) {
  const TrackSettings& track = request.track;
  CheckTrackSettings(track);
  if (track.video.empty()) throw RequestError("the source is required: a camera, a stream or a video");
  if (!track.turn_deg) throw RequestError("--rotate auto looks at a whole video: say --rotate 90, 180 or 270");
  if (!track.camera_path.empty() || track.camera == "weak") {
    throw RequestError("live tracking is for a perspective camera that stands still");
  }
  if (track.stature_m > 0) throw RequestError("live tracking does not use --stature: leave it out");
  if (request.lag < 0 || request.lag > 60) {
    throw RequestError(Concatenate("a lag of ", request.lag, " frames, expected 0 to 60"));
  }
  RequirePoseModels(track.detector);
  RequireDistinct({track.video, track.cameras, track.body, track.prior, track.lifter},
                  {request.jsonl == "-" ? "" : request.jsonl});
  if (request.jsonl != "-") RequireWritable(request.jsonl);
}

FrameDetectorOptions DetectorOptionsOf(const RunLiveRequest& request) {
  FrameDetectorOptions options = request.track.detector;
  options.blazepose.masks = false;
  if (options.pose_model.empty()) options.blazepose.max_people = 1;
  options.hands_and_faces = HandsAndFaceChoice::kOff;
  return options;
}

/// Mean distance of the landmarks that both have, relative to the larger one's extent; infinite where there are none.
double DistanceOf(const std::vector<Keypoint>& a, const DetectedPerson& b) {
  double sum = 0;
  int count = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    if (!(a[k].confidence > 0 && b.points[k].confidence > 0)) continue;
    sum += std::hypot(a[k].x - b.points[k].x, a[k].y - b.points[k].y);
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::infinity();
}

/// Follows one of the people of each frame: whoever is nearest to the person followed so far, at first the largest.
class FollowedPerson {
 public:
  const DetectedPerson* Choose(const std::vector<FramePerson>& people) {
    const DetectedPerson* chosen = nullptr;
    double best = 0;
    for (const FramePerson& each : people) {
      const ImageRectangle box = VisibleRectangle(each.person);
      const double size = std::hypot(box.x1 - box.x0, box.y1 - box.y0);
      const double score = last_.empty() ? size : -DistanceOf(last_, each.person);
      if (chosen == nullptr || score > best) chosen = &each.person, best = score;
    }
    if (chosen != nullptr) last_ = chosen->points;
    if (chosen == nullptr && ++frames_without_ > 30) last_.clear();
    if (chosen != nullptr) frames_without_ = 0;
    return chosen;
  }

 private:
  std::vector<Keypoint> last_;
  int frames_without_ = 0;
};

/// Detector of frames of one size.
class LiveDetector {
 public:
  explicit LiveDetector(const RunLiveRequest& request) : request_(request) { Make(); }

  Landmarks Detect(const LiveImage& frame) {
    if (width_ != 0 && (width_ != frame.image.width || height_ != frame.image.height)) Make();
    width_ = frame.image.width;
    height_ = frame.image.height;
    const std::vector<std::vector<FramePerson>> people = detector_->Detect({&frame.image, 1});
    Landmarks found = {frame.seconds, frame.arrived, width_, height_, convention_, {}};
    found.points.resize(convention_->names.size());
    const DetectedPerson* person = followed_.Choose(people[0]);
    for (size_t k = 0; person != nullptr && k < found.points.size(); ++k) {
      const Keypoint& p = person->points[k];
      const bool is_seen = p.confidence > 0 && std::isfinite(p.x) && std::isfinite(p.y) &&
                           double(p.confidence) >= request_.track.min_confidence;
      if (is_seen) found.points[k] = {p.x, p.y, std::min(1.0F, p.confidence)};
    }
    return found;
  }

 private:
  void Make() {
    detector_ = request_.make_detector ? request_.make_detector() : MakeFrameDetector(DetectorOptionsOf(request_));
    convention_ = std::make_shared<const KeypointConvention>(detector_->convention());
    followed_ = {};
  }

  const RunLiveRequest& request_;
  std::unique_ptr<FrameDetector> detector_;
  std::shared_ptr<const KeypointConvention> convention_;
  FollowedPerson followed_;
  int width_ = 0, height_ = 0;
};

/// Tracker of frames of one size, and their ground.
class LiveSolver {
 public:
  LiveSolver(const RunLiveRequest& request, const Landmarks& first)
      : width_(first.width),
        height_(first.height),
        scene_(SceneOf(request, first)),
        tracker_(InputOf(scene_, *first.convention), OptionsOf(request, scene_, *first.convention)),
        ground_(*scene_.body) {}

  [[nodiscard]] bool Fits(const Landmarks& frame) const { return frame.width == width_ && frame.height == height_; }

  std::optional<LiveState> Push(const Landmarks& frame) {
    arrived_.push_back(frame.arrived);
    LiveObservations seen;
    seen.timestamp = frame.seconds;
    seen.keypoints = frame.points;
    std::optional<LiveFrame> out = tracker_.Push(seen);
    if (!out) return std::nullopt;
    return StateOf(std::move(*out));
  }
  std::vector<LiveState> Finish() {
    std::vector<LiveState> states;
    for (LiveFrame& frame : tracker_.Finish()) states.push_back(StateOf(std::move(frame)));
    return states;
  }

 private:
  static SceneInputs SceneOf(const RunLiveRequest& request, const Landmarks& first) {
    SceneRequest scene = request.track;
    scene.video = "";
    scene.turn_deg = 0;
    scene.image_width = first.width;
    scene.image_height = first.height;
    SceneInputs inputs = LoadSceneInputs(scene);
    UseFocal(scene, &inputs.camera.camera);
    return inputs;
  }
  static LiveTrackerInput InputOf(const SceneInputs& scene, const KeypointConvention& convention) {
    LiveTrackerInput input = LiveInputFor(scene.ForTracker());
    input.landmarks = convention.names;
    return input;
  }
  static LiveTrackerOptions OptionsOf(const RunLiveRequest& request, const SceneInputs& scene,
                                      const KeypointConvention& convention) {
    LiveTrackerOptions options;
    options.lag = request.lag;
    options.solve = request.track.solve;
    options.solve.camera_knowledge = scene.camera_knowledge;
    options.solve.straight_knees_weight = StraightKneesWeight(request.track, convention.name);
    return options;
  }

  LiveState StateOf(LiveFrame frame) {
    LiveState state;
    state.body = scene_.body;
    state.rest_joints = scene_.body->RestJoints(frame.betas);
    if (frame.status != FrameStatus::kLost) {
      state.pose = {frame.state.rotations, frame.state.translation};
      state.joints = PoseSkeleton(*scene_.body, state.rest_joints, state.pose).joints;
    }
    state.world = ground_.Add(frame, state.joints);
    state.frame = std::move(frame);
    state.delay_ms = MillisecondsSince(arrived_.front());
    arrived_.pop_front();
    return state;
  }

  int width_, height_;
  SceneInputs scene_;
  LiveTracker tracker_;
  LiveGround ground_;
  std::deque<LiveClock::time_point> arrived_;  ///< of the frames that are not returned yet
};

class LiveRun {
 public:
  LiveRun(const RunLiveRequest& request, const PipelineCallbacks& callbacks)
      : request_(request),
        callbacks_(callbacks),
        when_full_(request.video.pace == 0 && LiveSourceKindOf(request.track.video) == LiveSourceKind::kFile
                       ? WhenFull::kWait
                       : WhenFull::kDropOldest),
        outputs_({.page_address = request.listen,
                  .page_title = request.track.video,
                  .vmc_address = request.osc,
                  .jsonl = request.jsonl,
                  .on_frame = request.on_frame},
                 when_full_),
        detector_(request),
        video_(request.track.video, VideoOptionsOf(request)),
        images_(1, when_full_),
        landmarks_(kWaitingLandmarks, when_full_) {}

  RunLiveReport Run() {
    if (!outputs_.url().empty()) callbacks_.Message("page     " + outputs_.url());
    StageClock clock;
    {
      std::vector<std::jthread> threads;
      for (void (LiveRun::*work)() : {&LiveRun::ReadFrames, &LiveRun::DetectFrames, &LiveRun::SolveFrames}) {
        threads.emplace_back([this, work] { Guard(work); });
      }
      WaitForEnd();
    }
    SayMessages();
    if (error_) std::rethrow_exception(error_);
    report_.source = request_.track.video;
    report_.late = video_.late();
    report_.frames = read_ + report_.late;
    report_.dropped = images_.num_dropped() + landmarks_.num_dropped();
    report_.lines_dropped = outputs_.Finish();
    if (report_.frames == 0) throw std::runtime_error(request_.track.video + ": no frame that can be decoded");
    report_.delay = delays_.Percentiles();
    report_.detected = detected_delays_.Percentiles();
    clock.Record("live");
    report_.cpu_ms_per_frame =
        1000 * clock.processor_seconds().front().second / double(std::max<int64_t>(1, looked_at_));
    report_.peak_memory_mb = double(PeakMemoryBytes()) / 1e6;
    return report_;
  }

 private:
  static LiveVideoOptions VideoOptionsOf(const RunLiveRequest& request) {
    LiveVideoOptions options = request.video;
    options.turn_deg = request.track.turn_deg.value_or(0);
    return options;
  }

  /// Runs a thread's work; the first failure of any ends all.
  void Guard(void (LiveRun::*work)()) {
    try {
      (this->*work)();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
    // Whoever ends, ends those before it, and after them those behind it.
    if (work != &LiveRun::ReadFrames) video_.Stop();
    images_.Close();
    if (work != &LiveRun::ReadFrames) landmarks_.Close();
    const std::lock_guard lock(mutex_);
    ++ended_;
    changed_.notify_all();
  }

  void ReadFrames() {
    LiveImage frame;
    bool lost = false;
    for (;;) {
      const LiveVideo::Event event = video_.Read(&frame);
      if (event == LiveVideo::Event::kEnd) return;
      if (event == LiveVideo::Event::kLost) {
        if (!lost) {
          Say(video_.message() + "; looking for it");
          ++report_.losses;
        }
        lost = true;
        continue;
      }
      if (lost) Say(request_.track.video + ": found again");
      lost = false;
      if (request_.max_seconds > 0 && frame.seconds > request_.max_seconds) return;
      ++read_;
      if (!images_.Put(std::move(frame))) return;
      frame = {};
    }
  }

  void DetectFrames() {
    while (std::optional<LiveImage> frame = images_.Take()) {
      Landmarks found = detector_.Detect(*frame);
      ++looked_at_;
      detected_delays_.Add(MillisecondsSince(frame->arrived));
      if (!landmarks_.Put(std::move(found))) return;
    }
  }

  void SolveFrames() {
    std::unique_ptr<LiveSolver> solver;
    const Stopwatch watch;
    while (std::optional<Landmarks> frame = landmarks_.Take()) {
      if (solver != nullptr && !solver->Fits(*frame)) {
        for (const LiveState& state : solver->Finish()) Send(state);
        solver.reset();
      }
      if (solver == nullptr) solver = std::make_unique<LiveSolver>(request_, *frame);
      report_.width = frame->width;
      report_.height = frame->height;
      std::optional<LiveState> state = solver->Push(*frame);
      if (!state) continue;
      delays_.Add(state->delay_ms);
      if (!Send(std::move(*state))) return;
    }
    if (solver == nullptr) return;
    for (LiveState& state : solver->Finish()) Send(std::move(state));
    report_.seconds = watch.seconds();
  }

  bool Send(LiveState state) {
    state.dropped = images_.num_dropped() + landmarks_.num_dropped() + video_.late();
    ++report_.poses;
    switch (state.frame.status) {
      case FrameStatus::kInterpolated:
        ++report_.interpolated;
        break;
      case FrameStatus::kLost:
        ++report_.lost;
        break;
      default:
        ++report_.tracked;
    }
    return outputs_.Send(state);
  }

  void WaitForEnd() {
    for (;;) {
      {
        std::unique_lock lock(mutex_);
        if (changed_.wait_for(lock, kPoll, [this] { return ended_ == 3; })) return;
      }
      SayMessages();
      if (!callbacks_.ReportProgress("live", 0)) video_.Stop();
    }
  }

  /// From any thread; said by the caller's.
  void Say(std::string line) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(line));
  }
  void SayMessages() {
    std::vector<std::string> lines;
    {
      const std::lock_guard lock(mutex_);
      lines.swap(messages_);
    }
    for (const std::string& line : lines) callbacks_.Message(line);
  }

  const RunLiveRequest& request_;
  const PipelineCallbacks& callbacks_;
  const WhenFull when_full_;
  LiveOutputs outputs_;
  LiveDetector detector_;
  LiveVideo video_;
  Mailbox<LiveImage> images_;
  Mailbox<Landmarks> landmarks_;
  RunLiveReport report_;  ///< losses: of the thread that reads; the rest of the one that solves
  DelayCounts delays_, detected_delays_;
  std::atomic<int64_t> read_ = 0, looked_at_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> messages_;
  std::exception_ptr error_;
  int ended_ = 0;
};

}  // namespace

RunLiveReport RunLive(const RunLiveRequest& request, const PipelineCallbacks& callbacks) {
  CheckRequest(request);
  return std::make_unique<LiveRun>(request, callbacks)->Run();
}

std::string ToText(const RunLiveReport& report) {
  std::string text = Concatenate("source   ", report.source, ", ", report.width, "x", report.height, ", ",
                                 report.frames, " frames in ", Fixed(report.seconds, 1), " s");
  if (report.losses > 0) text += Concatenate(", lost ", report.losses, " times");
  text += Concatenate("\npassed   ", report.late + report.dropped, " frames: ", report.dropped,
                      " because a newer one was there, ", report.late, " because they came late\n");
  text += Concatenate("poses    ", report.poses, ": ", report.tracked, " tracked, ", report.interpolated,
                      " interpolated, ", report.lost, " lost");
  if (report.lines_dropped > 0) text += Concatenate("; ", report.lines_dropped, " lines that nobody took");
  text += "\ndelay    " + ToText(report.delay) + ", from arrival to pose\n";
  text += "         " + ToText(report.detected) + ", to the landmarks\n";
  text += "cost     " + Fixed(report.cpu_ms_per_frame, 1) + " ms of processor time a frame, " +
          Fixed(report.peak_memory_mb, 0) + " MB of memory at most\n";
  return text;
}

}  // namespace bodyloom
