// SPDX-License-Identifier: Apache-2.0
#include "tests/data_tools/fuzz/fuzz_run_seeds.h"

#include "pipelines/batch/batch_clip.h"
#include "pipelines/runs/motion_run.h"
#include "pipelines/runs/run_config.h"

namespace bodyloom::fuzz {

namespace {

/// Free-form notes of a training run beside its configuration; readers must accept almost any content.
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
  ClipRecord record;
  record.id = "dance_01";
  record.verb = "track";
  record.status = ClipStatus::kDone;
  record.hash = std::string(64, 'a');
  record.seconds = 1.5;
  record.frames = 240;
  record.people = 1;
  record.frames_by_status = {{"tracked", 239}, {"lost", 1}};
  record.reprojection_median_px = 1.25;
  (*seeds)["clip_record"] = {ToLine(record)};
  (*seeds)["manifest"] = {
      R"({"id": "dance_01", "detections": "dance_01.json", "image-size": "1920x1080", "fps": 59.94})"
      "\n"
      R"({"id": "street", "video": "/data/street.mp4", "people": 2, "no-ground": true})"
      "\n",
      R"({"id":"a","verb":"track","video":"a.mp4","prior":"none"})"
      "\r\n\r\n"
      R"({"id":"b","part-labels":"b.npz"})"};
  (*seeds)["relight"] = {
      R"({"directional":[{"from":[0,1,1],"intensity":1,"colour":[1,0.9,0.8]}],"ambient":0.2,"estimate":true,)"
      R"("encoding":"srgb"})"};
}

}  // namespace bodyloom::fuzz
