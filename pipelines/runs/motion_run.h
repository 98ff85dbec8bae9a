// SPDX-License-Identifier: Apache-2.0
/// Reads and writes config.json of a run of the motion-dependent renderer: everything needed to use its checkpoint.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/uv_maps/descriptor_options.h"
#include "neural/motion/motion_config.h"

namespace bodyloom {

struct MotionRun {
  MotionConfig config;
  double pixels_per_metre = 0;  ///< of the window: the person's scale in training
  double fps = 30;              ///< of the clip and of every animation
  int reach = 0;         ///< pixels that clothes reach beyond the body (neural/motion/motion_frame.h), 0: not known
  int past = 10;         ///< number of past frames in the descriptor
  SurfaceMotion motion;  ///< axes and velocities of the motion maps; older runs: the defaults of their time
  std::optional<Eigen::VectorXd> betas;      ///< the person's shape; absent in runs from before they held it
  std::string data, track;                   ///< training data, from `notes` when a run is read; empty: unknown
  std::vector<std::pair<int, int>> trained;  ///< training frames, first and last; empty: unknown
  std::string notes;                         ///< JSON object with further data: data, frames, options
};

/// Channels of the descriptor of `past` frames: 3 + 3·past of the surface, 6·past of dense2d.
int MotionChannels(MotionDescriptor descriptor, int past);

std::string MotionRunJson(const MotionRun& run);

/// Reads RUN/config.json. Throws std::runtime_error naming the file, the key and what was expected.
MotionRun ReadMotionRun(const std::string& run_dir);

}  // namespace bodyloom
