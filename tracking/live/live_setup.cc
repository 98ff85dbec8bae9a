// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_setup.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "tracking/problem/input_checks.h"
#include "tracking/terms/straight_knees.h"

namespace bodyloom {

using Eigen::VectorXd;

LiveSetup::LiveSetup(const LiveTrackerInput& given, const LiveTrackerOptions& chosen) : input(given), options(chosen) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "live: ", why);
  BODYLOOM_CHECK(input.body != nullptr, "live: no body");
  BODYLOOM_CHECK(!input.landmarks.empty() || input.dense, "live: neither 2D joints nor dense keypoints are announced");
  BODYLOOM_CHECK(input.camera.width > 0 && input.camera.height > 0, "live: the image size is not known");
  const BodyModel& model = *input.body;
  TrackSequenceInput numbers;
  numbers.body = input.body;
  numbers.camera = input.camera;
  numbers.focal_prior = input.focal_prior;
  CheckNumbers(numbers, options.solve);
  threads = ThreadsFor(options.solve.num_threads);
  const int num_betas = options.solve.estimate_shape ? std::min(model.num_betas(), 10) : 0;
  KeypointSequence names;
  names.names = input.landmarks;
  if (!input.landmarks.empty()) landmarks = FindObservedLandmarks(model, &names, num_betas);
  const std::vector<int> active =
      FindActiveJoints(model, landmarks, input.dense, options.solve.skip_unneeded, false, options.solve.user_terms);
  Camera camera = input.camera;
  if (options.solve.camera_knowledge != CameraKnowledge::kKnown) {
    const FocalPrior focal = input.focal_prior.value_or(FocalPrior::ForImage(camera.width, camera.height));
    camera = MakePinhole(camera.width, camera.height, std::exp(focal.log_mean));
  }
  layout = FrameLayout::Make(model, options.solve.camera_knowledge, camera, active, num_betas);
  for (const UserTerm& term : options.solve.user_terms) {
    user_inputs.push_back(CompileInputs(term, model, layout.num_betas));
  }
  if (input.prior != nullptr && input.prior->num_components() > 0) {
    prior = std::make_shared<const MixturePrior>(*input.prior, model, active);
  }
  limits = std::make_shared<const JointLimits>(JointLimits::ForBody(model));
  knees = FindKnees(model);
  if (input.lifter != nullptr) lifted_landmarks = CompileLiftedLandmarks(model, num_betas);
  VectorXd gradient;
  stature_m = StatureOfMeanShape(model, num_betas, &gradient);
}

SequenceProblem LiveSetup::EmptyProblem() const {
  SequenceProblem problem;
  problem.layout = layout;
  problem.betas = problem.shape_prior.mean = VectorXd::Zero(layout.num_betas);
  problem.log_focal = problem.log_focal_prior = std::log(layout.camera.fx);
  problem.log_focal_sigma = input.focal_prior.value_or(FocalPrior()).log_sigma;
  return problem;
}

void LiveSetup::CheckObservations(const LiveObservations& observations, const double* last_s) const {
  BODYLOOM_CHECK(std::isfinite(observations.timestamp) && (last_s == nullptr || observations.timestamp > *last_s),
                 "live: a frame at ", observations.timestamp, " s", last_s == nullptr ? "" : " after one at ",
                 last_s == nullptr ? 0.0 : *last_s, " s; expected finite and increasing times");
  BODYLOOM_CHECK(observations.keypoints.empty() || observations.keypoints.size() == input.landmarks.size(),
                 "live: ", observations.keypoints.size(), " 2D joints in a frame, expected ", input.landmarks.size());
  BODYLOOM_CHECK(observations.dense.empty() || input.dense, "live: dense keypoints came that were not announced");
  for (const DenseKeypoint& point : observations.dense) {
    BODYLOOM_CHECK(point.face >= 0 && point.face < input.body->num_faces(), "live: a dense keypoint names face ",
                   point.face, ", the body '", input.body->name(), "' has ", input.body->num_faces());
  }
  BODYLOOM_CHECK(!observations.initialiser ||
                     static_cast<int>(observations.initialiser->rotations.size()) == input.body->num_joints(),
                 "live: the initialiser has ",
                 observations.initialiser ? observations.initialiser->rotations.size() : 0, " rotations, the body ",
                 input.body->num_joints(), " joints");
}

}  // namespace bodyloom
