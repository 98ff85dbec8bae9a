// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/geometry/joint_influence.h"

namespace bodyloom {

std::vector<int> StrongestJoints(const BodyModel& body) {
  std::vector<int> strongest(body.num_vertices(), 0);
  for (int v = 0; v < body.num_vertices(); ++v) {
    double most = -1;
    for (int k = body.influence_begin()[v]; k < body.influence_begin()[v + 1]; ++k) {
      if (body.influence_weight()[k] > most)
        most = body.influence_weight()[k], strongest[v] = body.influence_joint()[k];
    }
  }
  return strongest;
}

std::vector<double> WeightsBelow(const BodyModel& body, const std::vector<std::string>& joints) {
  std::vector<bool> counts(body.num_joints(), false);
  for (const std::string& name : joints) {
    const int joint = body.FindJoint(name);
    if (joint >= 0) counts[joint] = true;
  }
  for (int j = 1; j < body.num_joints(); ++j) counts[j] = counts[j] || counts[body.parents()[j]];
  std::vector<double> weights(body.num_vertices(), 0.0);
  for (int v = 0; v < body.num_vertices(); ++v) {
    for (int k = body.influence_begin()[v]; k < body.influence_begin()[v + 1]; ++k) {
      if (counts[body.influence_joint()[k]]) weights[v] += body.influence_weight()[k];
    }
  }
  return weights;
}

}  // namespace bodyloom
