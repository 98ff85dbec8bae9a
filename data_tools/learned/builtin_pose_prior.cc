// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/learned/pose_prior_io.h"

// Made by bodyloom_embed() in data_tools/CMakeLists.txt.
extern "C" {
extern const char bodyloom_pose_prior_begin[], bodyloom_pose_prior_end[];
}

namespace bodyloom {

const PosePrior& BuiltinPosePrior() {
  static const PosePrior prior = ReadPosePriorBytes(std::string(bodyloom_pose_prior_begin, bodyloom_pose_prior_end),
                                                    "assets/prior/pose_prior.npz (built in)");
  return prior;
}

}  // namespace bodyloom
