// SPDX-License-Identifier: Apache-2.0
#include "pipelines/prior/learn_prior.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/load_motion.h"

namespace bodyloom {

LearnPriorReport LearnPrior(const LearnPriorRequest& request, const PipelineCallbacks& callbacks) {
  std::vector<Motion> motions;
  double seconds = 0;
  for (const std::string& file : FilesBelow(request.motions)) {
    callbacks.Update("read", 0);
    try {
      std::vector<std::string> warnings;
      Motion motion = LoadMotion(file, {}, nullptr, &warnings);
      for (const std::string& warning : warnings) callbacks.Message(warning);
      seconds += motion.timestamps.back() - motion.timestamps.front();
      motions.push_back(std::move(motion));
    } catch (const std::runtime_error& error) {  // licences, skeletons and readmes lie among the motions
      callbacks.Message(std::string("left out: ") + error.what());
    }
  }
  callbacks.Update("learn", 0);
  const PosePrior prior = LearnPosePrior(motions, BuiltinBody(), request.options);
  WritePosePrior(request.out, prior);
  LearnPriorReport report;
  report.motions = static_cast<int>(motions.size());
  report.minutes = seconds / 60;
  report.components = prior.num_components();
  report.joints = static_cast<int>(prior.joints.size());
  report.out = request.out;
  return report;
}

}  // namespace bodyloom
