// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/initial_poses.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "data_tools/estimates/body_estimate.h"
#include "data_tools/estimates/load_estimate.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kSmplJoints = 24, kSmplHandColumns = 6;

const PersonEstimate& ChoosePerson(const BodyEstimate& estimate, const InitialPosesRequest& request) {
  const int people = static_cast<int>(estimate.people.size());
  // A single person needs no search if the file covers the whole video or a single image.
  if (people == 1 && (estimate.num_frames > 0 || request.num_frames == 1)) return estimate.people[0];
  if (request.keypoints != nullptr) {
    const int seen = PersonSeenAs(estimate, *request.keypoints);
    if (seen >= 0) return estimate.people[static_cast<size_t>(seen)];
    ThrowFileError(request.path,
                   Concatenate(estimate.system, ": of ", people, people == 1 ? " person" : " people",
                               " in it nobody is where the detections have the person; are both of the same "
                               "video, frame for frame?"));
  }
  if (request.person >= people) {
    ThrowFileError(request.path, Concatenate(estimate.system, ": person ", request.person, " requested, but only ",
                                             people, " were found (0 is the largest)"));
  }
  return estimate.people[static_cast<size_t>(request.person)];
}

/// A pixel of another image is another line of sight; sizes that follow from principal points are not exact.
void CheckImageSize(const PersonEstimate& person, const InitialPosesRequest& request) {
  constexpr double kMaxOff = 0.02;
  const Camera &theirs = person.cameras.front(), &ours = request.camera;
  const auto differ = [](int a, int b) { return a > 0 && b > 0 && std::abs(a - b) > kMaxOff * b; };
  if (differ(theirs.width, ours.width) || differ(theirs.height, ours.height)) {
    ThrowFileError(request.path, Concatenate("made on images of ", theirs.width, "x", theirs.height, ", expected ",
                                             ours.width, "x", ours.height));
  }
}

void CheckFrames(const BodyEstimate& estimate, const PersonEstimate& person, const InitialPosesRequest& request) {
  const std::string clip = Concatenate("the ", request.num_frames, " of the detections");
  if (estimate.num_frames > 0 && estimate.num_frames != request.num_frames) {
    ThrowFileError(request.path, Concatenate(estimate.num_frames, " frames, expected ", clip));
  }
  if (person.frames.back() >= request.num_frames) {
    ThrowFileError(request.path, Concatenate(estimate.system, ", person ", person.name, ": frame ",
                                             person.frames.back(), " (from 0), expected none beyond ", clip));
  }
}

void TakeMotion(const BodyEstimate& estimate, const PersonEstimate& person, const InitialPosesRequest& request,
                InitialPoses* poses) {
  const BodyModel& body = *request.body;
  poses->has_shape = estimate.body == body.name();
  Eigen::VectorXd betas;
  if (poses->has_shape) betas = person.betas.head(std::min<Eigen::Index>(person.betas.size(), body.num_betas()));
  const Eigen::Vector3d pelvis = body.RestJoints(betas).row(0).transpose();
  poses->motion = EstimateInCamera(person, request.camera, request.num_frames,
                                   poses->has_shape ? pelvis : estimate.rest_pelvis, pelvis);
  poses->motion.betas = betas;
  for (int t = 0; t < request.num_frames; ++t) {
    if (!poses->motion.HasPose(t)) continue;
    ++poses->frames;
    // In a body with more joints, those after the common ones are not SMPL's hands.
    if (body.num_joints() > kSmplJoints) poses->motion.poses.row(t).tail<kSmplHandColumns>().setZero();
  }
}

}  // namespace

InitialPoses ReadInitialPoses(const InitialPosesRequest& request) {
  BodyEstimate estimate =
      LoadEstimate(request.path, {.image_width = request.camera.width, .image_height = request.camera.height});
  if (!estimate.has_places) {
    if (request.keypoints == nullptr) {
      ThrowFileError(request.path, estimate.system + ": its file does not tell where people are: give 2D joints, too");
    }
    PlaceByDetections(*request.keypoints, request.camera, request.path, &estimate);
  }
  CheckImageSize(estimate.people[0], request);
  const PersonEstimate& person = ChoosePerson(estimate, request);
  CheckFrames(estimate, person, request);
  InitialPoses poses;
  if (estimate.has_landmarks) {
    poses.landmarks = LandmarksInCamera(person, request.camera, request.num_frames);
    for (const MatrixX3d& frame : poses.landmarks) poses.frames += frame.rows() > 0 ? 1 : 0;
  } else {
    TakeMotion(estimate, person, request, &poses);
  }
  if (poses.frames == 0) ThrowFileError(request.path, estimate.system + ": no pose lies in front of the camera");
  poses.camera = request.camera;
  poses.system = estimate.system;
  poses.person = person.name;
  poses.people = static_cast<int>(estimate.people.size());
  return poses;
}

}  // namespace bodyloom
