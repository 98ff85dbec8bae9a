// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/body_landmarks.h"

#include <algorithm>
#include <array>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/body/hand_skeleton.h"

namespace bodyloom {
namespace {

/// A landmark is a vertex of the topology at hand, or a joint.
struct Row {
  const char* name;
  int smpl_vertex, smplx_vertex, joint;  // −1: not this kind
};

constexpr Row kRows[] = {
    {"nose", 332, 9120, -1},           {"left_eye", 2800, 9448, -1},       {"right_eye", 6260, 9929, -1},
    {"left_ear", 583, 6, -1},          {"right_ear", 4071, 616, -1},       {"left_shoulder", -1, -1, 16},
    {"right_shoulder", -1, -1, 17},    {"left_elbow", -1, -1, 18},         {"right_elbow", -1, -1, 19},
    {"left_wrist", -1, -1, 20},        {"right_wrist", -1, -1, 21},        {"left_hip", -1, -1, 1},
    {"right_hip", -1, -1, 2},          {"left_knee", -1, -1, 4},           {"right_knee", -1, -1, 5},
    {"left_ankle", -1, -1, 7},         {"right_ankle", -1, -1, 8},         {"left_big_toe", 3216, 5770, -1},
    {"right_big_toe", 6617, 8463, -1}, {"left_small_toe", 3226, 5780, -1}, {"right_small_toe", 6624, 8474, -1},
    {"left_heel", 3387, 8846, -1},     {"right_heel", 6787, 8635, -1}};

/// Fingertips: thumb, index, middle, ring, pinky; left, right.
constexpr std::array<std::array<int, 5>, 2> kSmplTips = {
    {{2746, 2319, 2445, 2556, 2673}, {6191, 5782, 5905, 6016, 6133}}};
constexpr std::array<std::array<int, 5>, 2> kSmplxTips = {
    {{5361, 4933, 5058, 5169, 5286}, {8079, 7669, 7794, 7905, 8022}}};

}  // namespace

std::vector<Landmark> StandardLandmarks(const BodyModelData& body) {
  const auto V = body.v_template.rows();
  if ((V != 6890 && V != 10475) || body.parents.size() < 22) return {};
  std::vector<Landmark> landmarks;
  for (const Row& row : kRows) {
    Landmark landmark{row.name, {}, {}};
    if (row.joint < 0) {
      landmark.vertices = {V == 6890 ? row.smpl_vertex : row.smplx_vertex};
      landmark.weights = {1.0};
    } else {
      double sum = 0;
      for (SparseRows::InnerIterator it(body.J_regressor, row.joint); it; ++it) sum += it.value();
      for (SparseRows::InnerIterator it(body.J_regressor, row.joint); it; ++it) {
        landmark.vertices.push_back(static_cast<int>(it.col()));
        landmark.weights.push_back(it.value() / sum);
      }
    }
    landmarks.push_back(std::move(landmark));
  }
  const std::string last_finger = HandJointNames(HandSide::kRight).back();
  if (std::find(body.joint_names.begin(), body.joint_names.end(), last_finger) == body.joint_names.end()) {
    return landmarks;
  }
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
    const auto& tips = V == 6890 ? kSmplTips : kSmplxTips;
    const std::vector<Landmark> hand = HandLandmarks(body, side, tips[static_cast<size_t>(side)]);
    landmarks.insert(landmarks.end(), hand.begin(), hand.end());
  }
  return landmarks;
}

Eigen::Vector3d MeanPelvis(const std::string& body) {
  if (body == "smpl") return {-0.0018, -0.2233, 0.0282};
  BODYLOOM_CHECK(body == "smplx", "the pelvis of a body '", body, "', expected smpl or smplx");
  return {0.0031, -0.3514, 0.0120};
}

}  // namespace bodyloom
