// SPDX-License-Identifier: Apache-2.0
/// Shared parts of the jobs that render a person with a trained network.
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
  bool full_size = false;      ///< images as large as the track's; false: as large as the networks' output
  int threads = 0;             ///< 0: all cores
  std::string device = "cpu";  ///< device of the networks: "cpu" or "cuda"
};

inline constexpr int kSheetFrames = 6;  ///< number of frames on a contact sheet

struct AnimationSummary {
  int frames = 0;
  int frames_without_fit = 0;  ///< of them, without a person: background only
  ImageSize image;             ///< size of the images written
  double network_ms = 0;       ///< median over frames of the network's time; 0 without a frame
  StageSeconds seconds;        ///< time by stage
  double total_seconds = 0;
  std::vector<std::string> written;  ///< the files, as the request names them
};

/// Renders the images of an animation, frame by frame in order.
class FramePainter {
 public:
  FramePainter() = default;
  FramePainter(const FramePainter&) = delete;
  FramePainter& operator=(const FramePainter&) = delete;
  virtual ~FramePainter() = default;

  /// Background of the next frame.
  virtual const Image& NextBackground() = 0;
  /// Composites the person of frame t, which must have a result, over `composed`. Returns the networks' time in
  /// seconds.
  virtual double Paint(int t, Image* composed) = 0;
  /// Pictures of frame t for the contact sheet; `painted`: the frame has a result.
  virtual std::vector<Image> ForSheet(int t, bool painted, const Image& composed) = 0;
  /// Called after frame t was written to the video.
  virtual void Written(int /*t*/, bool /*painted*/, const Image& /*composed*/) {}
  /// Number of frames rendered before the first frame of the video, for the progress.
  [[nodiscard]] virtual int FramesBefore() const { return 0; }
};

/// Writes the request's video of the track's frames, of this size. If requested, pictures of kSheetFrames frames are
/// appended to `sheet` and *columns is set to the number of pictures of the last of them. Sets frames,
/// frames_without_fit, image and network_ms of the summary (without the first frame, which warms up). The stage of
/// `callbacks` is "rendering".
AnimationSummary WriteAnimation(const AnimationRequest& request, const Track& track, ImageSize image, double fps,
                                const PipelineCallbacks& callbacks, FramePainter* painter, std::vector<Image>* sheet,
                                int* columns);

/// {"frames", "frames_without_fit", "picture": [width, height], "network_ms_median", "seconds", "output"}
nlohmann::ordered_json ReportOf(const AnimationSummary& summary, const std::string& out);

/// Throws as RequireDistinct and RequireWritable (pipelines/files.h).
void RequireOutputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/// The paths that are not empty.
std::vector<std::string> FilesAmong(const std::vector<std::string>& paths);

/// Mean frame rate of the track; `otherwise` with fewer than two frames, or with equal first and last times.
double FramesPerSecond(const Track& track, double otherwise);

/// Writes a contact sheet, unless path or images are empty.
void WriteSheet(const std::string& path, const std::vector<Image>& images, int columns, int cell_height_px);

/// Sends each line of `notes` as a message; every line ends in a newline.
void SayLines(const std::string& notes, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
