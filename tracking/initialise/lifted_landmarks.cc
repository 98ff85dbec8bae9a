// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/initialise/lifted_landmarks.h"

#include "bodyloom/tracking/initialise/lifter_input.h"

namespace bodyloom {

bool LiftedLandmarks::IsUsable() const {
  for (const int k : {int{kLifterLeftShoulder}, int{kLifterLeftHip}, int{kLifterLeftKnee}, int{kLifterLeftAnkle}}) {
    if (!known[k] || !known[k + 1]) return false;
  }
  return true;
}

LiftedLandmarks CompileLiftedLandmarks(const BodyModel& model, int num_betas) {
  LiftedLandmarks result;
  for (int k = 0; k < kLifterPoints; ++k) {
    const int index = model.FindLandmark(LifterPointNames()[k]);
    if (index < 0) continue;
    const Landmark& landmark = model.data().landmarks[index];
    result.points[k] = CompilePoint(model, landmark.vertices, landmark.weights, num_betas);
    result.known[k] = true;
  }
  return result;
}

}  // namespace bodyloom
