// SPDX-License-Identifier: Apache-2.0
/// User cost functions of every kind, for tests of their derivatives and of their effect on a track.
#pragma once

#include <ceres/autodiff_cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/loss_function.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/problem/user_term.h"

namespace bodyloom::user_term_kinds {

using Eigen::Vector3d;

/// r = (x − target)/σ of a point or a translation.
struct PullTo {
  Vector3d target;
  double sigma;
  template <typename T>
  bool operator()(const T* x, T* r) const {
    for (int c = 0; c < 3; ++c) r[c] = (x[c] - target[c]) / sigma;
    return true;
  }
};

/// The distance of two points, which is not linear in them.
struct Apart {
  double metres, sigma;
  template <typename T>
  bool operator()(const T* a, const T* b, T* r) const {
    const Eigen::Matrix<T, 3, 1> d(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    r[0] = (d.norm() - metres) / sigma;
    return true;
  }
};

/// The translation, and two joints with mirrored rotations, by two entries of these.
struct AlikeAndAt {
  Vector3d target;
  template <typename T>
  bool operator()(const T* translation, const T* left, const T* right, T* r) const {
    for (int c = 0; c < 3; ++c) r[c] = (translation[c] - target[c]) / 0.1;
    r[3] = (left[1] + right[1]) / 0.1;
    r[4] = (left[5] - right[5]) / 0.1;  // entry (1, 2): row by row
    return true;
  }
};

/// Two landmarks of two frames: the first keeps its velocity, the distance of the second to it is constant.
struct Moves {
  Vector3d step;
  template <typename T>
  bool operator()(const T* a0, const T* b0, const T* a1, const T* b1, T* r) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> A0(a0), B0(b0), A1(a1), B1(b1);
    for (int c = 0; c < 3; ++c) r[c] = (A1[c] - A0[c] - step[c]) / 0.02;
    r[3] = ((A1 - B1).squaredNorm() - (A0 - B0).squaredNorm()) / 0.03;
    return true;
  }
};

inline UserTerm OnLandmarks(const std::string& name, const std::vector<std::string>& landmarks,
                            UserTerm::CostOfFrame cost, std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  UserTerm term{.name = name, .cost = std::move(cost), .loss = std::move(loss)};
  for (const std::string& landmark : landmarks) term.inputs.push_back(TermInput::Landmark(landmark));
  return term;
}

inline UserTerm OnPose(const std::string& name, bool translation, const std::vector<int>& joints,
                       UserTerm::CostOfFrame cost, std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  UserTerm term{.name = name, .cost = std::move(cost), .loss = std::move(loss)};
  if (translation) term.inputs.push_back(TermInput::Translation());
  for (const int joint : joints) term.inputs.push_back(TermInput::Rotation(joint));
  return term;
}

inline UserTerm OnNeighbours(const std::string& name, const std::vector<std::string>& landmarks,
                             UserTerm::CostOfFrame cost, std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  UserTerm term = OnLandmarks(name, landmarks, std::move(cost), std::move(loss));
  for (const std::string& landmark : landmarks) term.inputs.push_back(TermInput::Landmark(landmark, 1));
  return term;
}

/// A surface point with a target pixel, which depends on shape and focal length: all parameters of a frame.
struct SeenAt {
  Eigen::Vector2d pixel;
  template <typename T>
  bool operator()(T const* const* blocks, T* r) const {
    const T *x = blocks[0], *betas = blocks[1], *focal = blocks[2];
    r[0] = (focal[0] * x[0] / x[2] + 640.0 - pixel.x()) / 5.0;
    r[1] = (focal[0] * x[1] / x[2] + 360.0 - pixel.y()) / 5.0;
    r[2] = (betas[0] - 0.5) / 0.3;
    return true;
  }
};

inline UserTerm Seen(const BodyModel& body) {
  const int B = body.num_betas();
  UserTerm term{.name = "seen"};
  term.inputs = {TermInput::Surface({body.num_faces() / 3, Vector3d(0.2, 0.5, 0.3)}), TermInput::Betas(),
                 TermInput::FocalLength()};
  term.cost = [B](int t) {
    auto cost = std::make_shared<ceres::DynamicAutoDiffCostFunction<SeenAt>>(new SeenAt{{650.0 + 3 * t, 340.0}});
    for (const int size : {3, B, 1}) cost->AddParameterBlock(size);
    cost->SetNumResiduals(3);
    return cost;
  };
  return term;
}

/// A wrist returns to its position and rotation two and five frames later.
struct ComesBack {
  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, const T* R0, const T* R5, T* r) const {
    for (int i = 0; i < 3; ++i) r[i] = (a[i] - b[i]) / 0.5;
    for (int i = 0; i < 3; ++i) r[3 + i] = (a[i] - c[i]) / 0.5;
    r[6] = R0[5] - R5[5];
    return true;
  }
};

inline UserTerm Loop(const BodyModel& body, std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  const int elbow = body.FindJoint("l_elbow");
  UserTerm term{.name = "loop", .loss = std::move(loss)};
  term.inputs = {TermInput::Landmark("left_wrist"), TermInput::Landmark("left_wrist", 2),
                 TermInput::Landmark("left_wrist", 5), TermInput::Rotation(elbow), TermInput::Rotation(elbow, 5)};
  term.cost = [](int t) -> std::shared_ptr<const ceres::CostFunction> {
    if (t > 2) return nullptr;
    return std::make_shared<ceres::AutoDiffCostFunction<ComesBack, 7, 3, 3, 3, 9, 9>>(new ComesBack);
  };
  return term;
}

inline UserTerm Pull(std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  return OnLandmarks(
      "pull", {"left_wrist"},
      [](int t) -> std::shared_ptr<const ceres::CostFunction> {
        if (t == 1) return nullptr;
        return std::make_shared<ceres::AutoDiffCostFunction<PullTo, 3, 3>>(
            new PullTo{Vector3d(0.4, -0.3 + 0.02 * t, 3.5), 0.05});
      },
      std::move(loss));
}

inline UserTerm Distance() {
  return OnLandmarks("distance", {"left_wrist", "right_ankle"}, [](int) {
    return std::make_shared<ceres::AutoDiffCostFunction<Apart, 1, 3, 3>>(new Apart{0.9, 0.2});
  });
}

inline UserTerm Pose(const BodyModel& body, CameraKnowledge knowledge = CameraKnowledge::kKnown) {
  const Vector3d target = knowledge == CameraKnowledge::kWeak ? Vector3d(5.4, 0.2, -0.1) : Vector3d(0.2, 0.1, 3.8);
  return OnPose("alike", true, {body.FindJoint("l_elbow"), body.FindJoint("r_elbow")}, [target](int) {
    return std::make_shared<ceres::AutoDiffCostFunction<AlikeAndAt, 5, 3, 9, 9>>(new AlikeAndAt{target});
  });
}

inline UserTerm Neighbours(std::shared_ptr<ceres::LossFunction> loss = nullptr) {
  return OnNeighbours(
      "moves", {"left_wrist", "nose"},
      [](int) {
        return std::make_shared<ceres::AutoDiffCostFunction<Moves, 4, 3, 3, 3, 3>>(new Moves{Vector3d(0.03, 0.01, 0)});
      },
      std::move(loss));
}

inline std::vector<UserTerm> AllKinds(const BodyModel& body, CameraKnowledge knowledge) {
  return {Pull(std::make_shared<ceres::CauchyLoss>(2.0)),
          Distance(),
          Pose(body, knowledge),
          Neighbours(std::make_shared<ceres::HuberLoss>(1.5)),
          Seen(body),
          Loop(body, std::make_shared<ceres::CauchyLoss>(3.0))};
}

/// A clip of the built-in body from 2D joints, tracked by an engine with these terms.
inline TrackSequenceResult TrackWith(const SynthClip& clip, SequenceSolver solver, const std::vector<UserTerm>& terms) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &clip.keypoints;
  input.prior = &BuiltinPosePrior();
  input.camera = clip.truth.camera;
  TrackSequenceOptions options;
  options.solver = solver;
  options.user_terms = terms;
  return FitClip(input, options);
}

}  // namespace bodyloom::user_term_kinds
