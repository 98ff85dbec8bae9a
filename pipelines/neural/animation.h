// SPDX-License-Identifier: Apache-2.0
/// Parts that the jobs which render a person with a trained network share.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "geometry/scene/track.h"
#include "pipelines/animate/background.h"
#include "render/image/image.h"

namespace bodyloom {

struct AnimationRequest {
  std::string run;             ///< folder of the trained run
  std::string track;           ///< the motion, .npz
  std::string body;            ///< the tracks' body; empty: the built-in body
  std::string out;             ///< the video to write, .mp4
  std::string sheet;           ///< a contact sheet to write; empty: none
  std::string json;            ///< a report with times to write; empty: none
  bool full_size = false;      ///< pictures as large as the track's; false: as large as the networks draw
  int threads = 0;             ///< 0: all cores
  std::string device = "cpu";  ///< where the networks run: "cpu" or "cuda"
};

inline constexpr int kSheetFrames = 6;  ///< of the clip, on a contact sheet

struct AnimationSummary {
  int frames = 0;
  int frames_without_fit = 0;  ///< of them: they show the background alone
  PictureSize picture;         ///< of the pictures written
  double network_ms = 0;       ///< median over frames of the network's time; 0 without a frame
  StageSeconds seconds;        ///< where the time went
  double total_seconds = 0;
  std::vector<std::string> written;  ///< the files, as the request names them
};

/// What makes the pictures of an animation, frame by frame in order.
class FramePainter {
 public:
  FramePainter() = default;
  FramePainter(const FramePainter&) = delete;
  FramePainter& operator=(const FramePainter&) = delete;
  virtual ~FramePainter() = default;

  /// What stands behind the person in the next frame.
  virtual const Image& NextBackground() = 0;
  /// Lays the person of frame t, which has a result, into `composed`. Returns the seconds that the networks took.
  virtual double Paint(int t, Image* composed) = 0;
  /// The pictures of frame t for the contact sheet; `painted`: the frame has a result.
  virtual std::vector<Image> ForSheet(int t, bool painted, const Image& composed) = 0;
  /// Frame t is in the video.
  virtual void Written(int /*t*/, bool /*painted*/, const Image& /*composed*/) {}
  /// Frames that were rendered before the first of the video, for the progress.
  [[nodiscard]] virtual int FramesBefore() const { return 0; }
};

/// Writes the request's video of the track's frames, of this size. Pictures of kSheetFrames frames are added to `sheet`
/// where the request wants one; *columns, if anything was added, is how many the last of them gave. In the summary:
/// frames, frames_without_fit, picture, network_ms (without the first frame, which warms up). The stage of `callbacks`
/// is "rendering".
AnimationSummary WriteAnimation(const AnimationRequest& request, const Track& track, PictureSize picture, double fps,
                                const PipelineCallbacks& callbacks, FramePainter* painter, std::vector<Image>* sheet,
                                int* columns);

/// {"frames", "frames_without_fit", "picture": [width, height], "network_ms_median", "seconds", "output"}
nlohmann::ordered_json ReportOf(const AnimationSummary& summary, const std::string& out);

/// Throws as RequireDistinct and RequireWritable (pipelines/files.h).
void RequireOutputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/// Those of the paths that are not empty.
std::vector<std::string> FilesAmong(const std::vector<std::string>& paths);

/// Mean rate of the track; `otherwise` with fewer than two frames, or two at the same time.
double FramesPerSecond(const Track& track, double otherwise);

/// Writes a contact sheet; nothing without a path or without pictures.
void WriteSheet(const std::string& path, const std::vector<Image>& pictures, int columns, int cell_height_px);

/// Each line of `notes`, all of which end in a newline, as a message.
void SayLines(const std::string& notes, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
