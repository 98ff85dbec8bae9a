// SPDX-License-Identifier: Apache-2.0
/// Learns a pose prior from a folder of motions (data_tools/learned/pose_prior_learning.h).
#pragma once

#include <string>

#include "data_tools/learned/pose_prior_learning.h"
#include "geometry/base/callbacks.h"

namespace bodyloom {

struct LearnPriorRequest {
  std::string motions;  ///< a motion file, or a folder of them
  std::string out;      ///< the prior, .npz
  LearnPosePriorOptions options;
};

struct LearnPriorReport {
  int motions = 0;  ///< learned from
  double minutes = 0;
  int components = 0, joints = 0;  ///< of the prior
  std::string out;
};

/// Learns from every file that holds a motion; others are skipped with a message. Throws std::runtime_error naming a
/// file that cannot be used, Cancelled.
LearnPriorReport LearnPrior(const LearnPriorRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
