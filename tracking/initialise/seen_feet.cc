// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/initialise/seen_feet.h"

#include <algorithm>

#include "bodyloom/geometry/camera_path.h"
#include "bodyloom/tracking/initialise/lifter_input.h"
#include "bodyloom/tracking/kinematics.h"

namespace bodyloom {
namespace {

constexpr float kSeenConfidence = 0.3F;

}  // namespace

std::vector<std::array<FootPlace, 2>> SeenFeet(const SequenceProblem& problem, const std::vector<int>& frames,
                                               const std::vector<LiftedFrame>& lifted, const LiftedLandmarks& landmarks,
                                               const KeypointSequence& keypoints) {
  std::array<int, 2> column{-1, -1};
  for (int foot = 0; foot < 2; ++foot) {
    const std::string& name = LifterPointNames()[kLifterLeftAnkle + foot];
    const auto it = std::find(keypoints.names.begin(), keypoints.names.end(), name);
    if (it != keypoints.names.end()) column[foot] = static_cast<int>(it - keypoints.names.begin());
  }
  Kinematics kinematics;
  PointEvaluator points;
  std::vector<std::array<FootPlace, 2>> feet(frames.size());
  for (size_t i = 0; i < frames.size(); ++i) {
    const int t = frames[i];
    const FrameState& state = problem.states[i];
    kinematics.Set(*problem.layout.model, problem.betas, state.rotations, Eigen::Vector3d::Zero(), false);
    for (int foot = 0; foot < 2; ++foot) {
      FootPlace& place = feet[i][foot];
      place.ankle_m = points.Evaluate(kinematics, landmarks.points[kLifterLeftAnkle + foot], false) +
                      problem.layout.BodyPlace(state);
      if (const CameraPose* camera = problem.frames[i].camera_from_scene; camera != nullptr) {
        place.camera_m = CentreOf(*camera);
      }
      place.contact = lifted[t].contact[foot];
      place.seen = column[foot] >= 0 && keypoints.at(t, column[foot]).confidence >= kSeenConfidence;
    }
  }
  return feet;
}

}  // namespace bodyloom
