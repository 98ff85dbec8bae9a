// SPDX-License-Identifier: Apache-2.0
#include "tests/data_tools/fuzz_run_seeds.h"

#include "apps/neural/guided_run.h"
#include "apps/neural/motion_run.h"
#include "apps/neural/photo_run.h"

namespace bodyloom::fuzz {

void AddRunSeeds(std::map<std::string, std::vector<std::string>>* seeds) {
  MotionRun motion;
  motion.config.profile = MotionProfileNamed("tiny");
  motion.config.num_labels = 7;
  motion.pixels_per_metre = 60;
  motion.fps = 30;
  motion.past = 10;
  motion.config.motion_channels = 3 + 3 * motion.past;
  motion.reach = 3;
  PhotoRun photo;
  photo.config.profile = PhotoProfileNamed("tiny");
  GuidedRun guided;
  guided.config.profile = GuidedProfileNamed("tiny");
  (*seeds)["run_config"] = {MotionRunJson(motion), PhotoRunJson(photo), GuidedRunJson(guided)};
  (*seeds)["relight"] = {
      R"({"directional":[{"from":[0,1,1],"intensity":1,"colour":[1,0.9,0.8]}],"ambient":0.2,"estimate":true,)"
      R"("encoding":"srgb"})"};
}

}  // namespace bodyloom::fuzz
