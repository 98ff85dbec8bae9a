// SPDX-License-Identifier: Apache-2.0
/// Tracks the person before a camera, in a stream or in a file, as the frames come, and sends the poses on: to a web
/// page, by VMC over UDP, as JSON lines, or to the caller.
///
/// Three threads: one reads and decodes frames, one detects the person in the newest one, one solves (LiveTracker) and
/// sends. Frames that come while another is detected are dropped, all but the newest, so that the delay stays the same
/// on a machine that is too slow. Memory is bounded. With a pace of 0 the threads wait for each other instead and no
/// frame is dropped: the poses are then those of LiveTracker, the same bytes every time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "data_tools/video/live_video.h"
#include "geometry/base/callbacks.h"
#include "pipelines/live/live_state.h"
#include "pipelines/track/track_request.h"
#include "tracking/detection/frame_detector.h"

namespace bodyloom {

struct RunLiveRequest {
  RunLiveRequest() { track.solve.num_threads = 1; }  // the detector has the other processors

  /// `video` is the source (LiveSourceKindOf()). Used besides: body, prior, lifter, calibration, `turn_deg`, detector
  /// (one person is followed, without masks, hands and face), `min_confidence` and `solve`.
  TrackSettings track;
  LiveVideoOptions video;  ///< its `turn_deg` is that of `track`
  int lag = 2;             ///< LiveTrackerOptions::lag
  double max_seconds = 0;  ///< ends after so many seconds of the source; 0: never
  std::string listen;      ///< ADDRESS:PORT of the page (live_server.h); empty: none
  std::string osc;         ///< HOST:PORT that VMC is sent to (vmc_sender.h); empty: nowhere
  std::string jsonl;       ///< file for LiveJson() of every frame, "-": standard output; empty: none
  /// Called with every frame, from the thread that solves.
  std::function<void(const LiveState&)> on_frame;
  /// The detector of frames of one size; none: MakeFrameDetector(track.detector).
  std::function<std::unique_ptr<FrameDetector>()> make_detector;
};

struct RunLiveReport {
  std::string source;
  int width = 0, height = 0;
  double seconds = 0;   ///< by the clock, from the first frame to the last pose
  int64_t frames = 0;   ///< that arrived
  int64_t late = 0;     ///< of these, passed over because decoding them was behind (LiveVideo::late())
  int64_t dropped = 0;  ///< of these, passed over because a newer one came before they were looked at
  int64_t poses = 0;    ///< frames that were returned
  int64_t tracked = 0, interpolated = 0, lost = 0;  ///< of these, by status; weak ones count as tracked
  int64_t lines_dropped = 0;                        ///< JSON lines that nobody took in time
  int losses = 0;                                   ///< how many times the source was lost
  DelayPercentiles delay;                           ///< from a frame's arrival to its pose, the lag included
  DelayPercentiles detected;                        ///< from a frame's arrival to its landmarks
  double cpu_ms_per_frame = 0;                      ///< processor time of the process for each frame that was looked at
  double peak_memory_mb = 0;
};

/// Runs until the source ends, `max_seconds` have passed, or progress returns false, which ends it as the source's end
/// does. A camera or stream that is lost is looked for until it is found. Throws RequestError for a contradictory
/// request, std::runtime_error naming a file, address or source that cannot be used (a source only if it cannot be
/// opened at first, or if it holds no frame).
RunLiveReport RunLive(const RunLiveRequest& request, const PipelineCallbacks& callbacks = {});

/// Several lines of text ending in a newline.
std::string ToText(const RunLiveReport& report);

}  // namespace bodyloom
