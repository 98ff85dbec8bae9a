// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/own/own_term.h"

#include <utility>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

OwnTerm OwnTerm::OnLandmarks(std::string name, std::vector<std::string> landmarks, CostOfFrame cost,
                             std::shared_ptr<ceres::LossFunction> loss) {
  return {std::move(name), Reads::kLandmarks, std::move(landmarks), false, {}, std::move(cost), std::move(loss)};
}

OwnTerm OwnTerm::OnPose(std::string name, bool translation, std::vector<int> joints, CostOfFrame cost,
                        std::shared_ptr<ceres::LossFunction> loss) {
  return {std::move(name), Reads::kPose, {}, translation, std::move(joints), std::move(cost), std::move(loss)};
}

OwnTerm OwnTerm::OnNeighbours(std::string name, std::vector<std::string> landmarks, CostOfFrame cost,
                              std::shared_ptr<ceres::LossFunction> loss) {
  return {std::move(name), Reads::kNeighbours, std::move(landmarks), false, {}, std::move(cost), std::move(loss)};
}

void CheckOwnTerm(const OwnTerm& term, const BodyModel& model) {
  BODYLOOM_CHECK(term.cost != nullptr, "own term '", term.name, "': no cost function");
  const bool pose = term.reads == OwnTerm::Reads::kPose;
  BODYLOOM_CHECK(pose ? term.translation || !term.joints.empty() : !term.landmarks.empty(), "own term '", term.name,
                 "': reads nothing; expected ", pose ? "the translation or joints" : "landmarks");
  for (const int joint : term.joints) {
    BODYLOOM_CHECK(joint >= 0 && joint < model.num_joints(), "own term '", term.name, "': joint ", joint,
                   ", the body '", model.name(), "' has joints 0 to ", model.num_joints() - 1);
  }
  for (const std::string& landmark : term.landmarks) {
    BODYLOOM_CHECK(model.FindLandmark(landmark) >= 0, "own term '", term.name, "': the body '", model.name(),
                   "' has no landmark '", landmark, "'");
  }
}

}  // namespace bodyloom
