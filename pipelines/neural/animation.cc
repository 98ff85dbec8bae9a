// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/animation.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "data_tools/video/image_file.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/percentile.h"
#include "pipelines/files.h"
#include "pipelines/report_json.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {

AnimationSummary WriteAnimation(const AnimationRequest& request, const Track& track, ImageSize image, double fps,
                                const PipelineCallbacks& callbacks, FramePainter* painter, std::vector<Image>* sheet,
                                int* columns) {
  AnimationSummary summary;
  summary.frames = track.num_frames();
  summary.image = image;
  VideoWriter video(request.out, image.width, image.height, fps);
  std::vector<int> on_sheet;
  if (!request.sheet.empty()) on_sheet = EvenlySpreadFrames(summary.frames, kSheetFrames);
  std::vector<double> network_ms;
  for (int t = 0; t < summary.frames; ++t) {
    Image composed = painter->NextBackground();
    const bool painted = track.HasResult(t);
    if (painted) {
      const double network_s = painter->Paint(t, &composed);
      if (t > 0) network_ms.push_back(1e3 * network_s);  // the first frame warms up
    } else {
      ++summary.frames_without_fit;
    }
    if (std::binary_search(on_sheet.begin(), on_sheet.end(), t)) {
      std::vector<Image> images = painter->ForSheet(t, painted, composed);
      if (!images.empty()) *columns = static_cast<int>(images.size());
      std::move(images.begin(), images.end(), std::back_inserter(*sheet));
    }
    video.Write(composed);
    painter->Written(t, painted, composed);
    const int before = painter->FramesBefore();
    callbacks.Update("rendering", static_cast<double>(before + t + 1) / (before + summary.frames));
  }
  video.Finish();
  if (!network_ms.empty()) summary.network_ms = Percentile(network_ms, 50);
  return summary;
}

nlohmann::ordered_json ReportOf(const AnimationSummary& summary, const std::string& out) {
  return {{"frames", summary.frames},
          {"frames_without_fit", summary.frames_without_fit},
          {"picture", {summary.image.width, summary.image.height}},
          {"network_ms_median", summary.network_ms},
          {"seconds", ToJson(summary.seconds)},
          {"output", out}};
}

void RequireOutputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  RequireDistinct(inputs, outputs);
  for (const std::string& path : outputs) RequireWritable(path);
}

std::vector<std::string> FilesAmong(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  std::copy_if(paths.begin(), paths.end(), std::back_inserter(files),
               [](const std::string& path) { return !path.empty(); });
  return files;
}

double FramesPerSecond(const Track& track, double otherwise) {
  const std::vector<double>& times = track.motion.timestamps;
  if (times.size() < 2 || !(times.back() > times.front())) return otherwise;
  return static_cast<double>(times.size() - 1) / (times.back() - times.front());
}

void WriteSheet(const std::string& path, const std::vector<Image>& images, int columns, int cell_height_px) {
  if (path.empty() || images.empty()) return;
  ContactSheetOptions layout;
  layout.columns = columns;
  layout.cell_height_px = cell_height_px;
  WriteImage(path, ContactSheet(images, layout));
}

void SayLines(const std::string& notes, const PipelineCallbacks& callbacks) {
  std::istringstream lines(notes);
  for (std::string line; std::getline(lines, line);) callbacks.Message(line);
}

}  // namespace bodyloom
