// SPDX-License-Identifier: Apache-2.0
/// Line plots with logarithmic axes as SVG, for the documentation.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

struct PlotLine {
  std::string name;
  std::vector<std::pair<double, double>> points;
  bool dashed = false;  ///< a limit, drawn without marks
  bool stairs = false;  ///< constant between points
};

struct Plot {
  std::string file;  ///< name without extension
  std::string title, x_label, y_label;
  bool log_x = true, log_y = true;
  std::vector<PlotLine> lines;
};

/// A stand-alone SVG of 640×420; points that are not finite, or not positive on a logarithmic axis, are left out.
std::string PlotSvg(const Plot& plot);

}  // namespace bodyloom
