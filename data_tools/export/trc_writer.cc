// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/export/trc_writer.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

std::string TrcText(const std::string& name, const MarkerTrajectories& markers) {
  const size_t T = markers.positions.size(), M = markers.names.size();
  BODYLOOM_CHECK(T > 0 && M > 0 && markers.seconds.size() == T, "TRC: ", T, " frames of ", M, " markers at ",
                 markers.seconds.size(), " times");
  char text[256];
  std::string out = "PathFileType\t4\t(X/Y/Z)\t" + name + "\n" +
                    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
                    "OrigNumFrames\n";
  std::snprintf(text, sizeof text, "%.6g\t%.6g\t%zu\t%zu\tm\t%.6g\t0\t%zu\n", markers.fps, markers.fps, T, M,
                markers.fps, T);
  out += text;
  out += "Frame#\tTime\t";
  for (const std::string& marker : markers.names) out += marker + "\t\t\t";
  out += "\n\t\t";
  for (size_t m = 1; m <= M; ++m) {
    const std::string number = std::to_string(m);
    out += "X" + number + "\tY" + number + "\tZ" + number + "\t";
  }
  out += "\n";
  for (size_t t = 0; t < T; ++t) {
    BODYLOOM_CHECK(markers.positions[t].rows() == Eigen::Index(M), "TRC: frame ", t, " has ",
                   markers.positions[t].rows(), " markers, expected ", M);
    std::snprintf(text, sizeof text, "%zu\t%.7f", t, markers.seconds[t]);
    out += text;
    for (Eigen::Index m = 0; m < Eigen::Index(M); ++m) {
      const Eigen::RowVector3d p = markers.positions[t].row(m);
      if (p.allFinite()) {
        std::snprintf(text, sizeof text, "\t%.7f\t%.7f\t%.7f", p.x(), p.y(), p.z());
        out += text;
      } else {
        out += "\t\t\t";
      }
    }
    out += "\n";
  }
  return out;
}

void WriteTrc(const std::string& path, const MarkerTrajectories& markers) {
  WriteFileAtomically(path, TrcText(std::filesystem::path(path).filename().string(), markers));
}

}  // namespace bodyloom
