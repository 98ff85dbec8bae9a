// SPDX-License-Identifier: Apache-2.0
#include "tests/data_tools/fuzz/fuzz_run_seeds.h"

#include "bodyloom/pipelines/runs/guided_run.h"
#include "bodyloom/pipelines/runs/motion_run.h"
#include "bodyloom/pipelines/runs/photo_run.h"

namespace bodyloom::fuzz {

namespace {

/// What a training run writes of itself beside its configuration: for people to read, so almost anything goes.
constexpr const char* kNotes =
    R"({"data":"people/dancer, first take","track":"","validate_data":"people/dancer, second take","train":[[0,119]],)"
    R"("validate":[[120,149]],"share":1.0,"seed":1,"steps":4000,"batch":4,"learning_rate":0.001,"weights":)"
    R"({"shape":10.0,"normals":1.0,"perceptual":1.0,"gan":0.01},"vgg16":"random-feature substitute","threads":2})";

}  // namespace

void AddRunSeeds(std::map<std::string, std::vector<std::string>>* seeds) {
  MotionRun motion;
  motion.config.profile = MotionProfileNamed("tiny");
  motion.config.num_labels = 7;
  motion.pixels_per_metre = 60;
  motion.fps = 30;
  motion.past = 10;
  motion.config.motion_channels = 3 + 3 * motion.past;
  motion.reach = 3;
  motion.motion.frame = SurfaceFrame::kWorld;
  motion.motion.camera_pose = LevelCamera();
  motion.betas = Eigen::Vector3d(0.5, -1, 2);
  motion.notes = kNotes;
  PhotoRun photo;
  photo.config.profile = PhotoProfileNamed("tiny");
  photo.notes = kNotes;
  GuidedRun guided;
  guided.config.profile = GuidedProfileNamed("tiny");
  guided.notes = kNotes;
  (*seeds)["run_config"] = {MotionRunJson(motion), PhotoRunJson(photo), GuidedRunJson(guided)};
  (*seeds)["relight"] = {
      R"({"directional":[{"from":[0,1,1],"intensity":1,"colour":[1,0.9,0.8]}],"ambient":0.2,"estimate":true,)"
      R"("encoding":"srgb"})"};
}

}  // namespace bodyloom::fuzz
