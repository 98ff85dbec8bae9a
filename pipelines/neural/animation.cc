// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/animation.h"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "data_tools/video/image_file.h"
#include "geometry/base/percentile.h"
#include "pipelines/files.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {

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

double MedianOf(std::span<const double> milliseconds) {
  return milliseconds.empty() ? 0 : Percentile(milliseconds, 50);
}

void WriteSheet(const std::string& path, const std::vector<Image>& pictures, int columns, int cell_height_px) {
  if (path.empty() || pictures.empty()) return;
  ContactSheetOptions layout;
  layout.columns = columns;
  layout.cell_height_px = cell_height_px;
  WriteImage(path, ContactSheet(pictures, layout));
}

void SayLines(const std::string& notes, const PipelineCallbacks& callbacks) {
  std::istringstream lines(notes);
  for (std::string line; std::getline(lines, line);) callbacks.Say(line);
}

}  // namespace bodyloom
