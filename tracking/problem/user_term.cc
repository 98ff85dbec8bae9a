// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/user_term.h"

#include <algorithm>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {

namespace {

TermInput InputOf(TermInput::Kind kind, int later) {
  TermInput input;
  input.kind = kind;
  input.later = later;
  return input;
}

}  // namespace

TermInput TermInput::Landmark(std::string name, int later) {
  TermInput input = InputOf(Kind::kLandmark, later);
  input.landmark = std::move(name);
  return input;
}

TermInput TermInput::Surface(const SurfacePoint& point, int later) {
  TermInput input = InputOf(Kind::kSurfacePoint, later);
  input.point = point;
  return input;
}

TermInput TermInput::Rotation(int joint, int later) {
  TermInput input = InputOf(Kind::kRotation, later);
  input.joint = joint;
  return input;
}

TermInput TermInput::Translation(int later) { return InputOf(Kind::kTranslation, later); }

TermInput TermInput::Betas() { return InputOf(Kind::kBetas, 0); }

TermInput TermInput::FocalLength() { return InputOf(Kind::kFocalLength, 0); }

bool UserTerm::is_of_one_frame() const {
  return std::all_of(inputs.begin(), inputs.end(), [](const TermInput& input) { return input.later == 0; });
}

void CheckUserTerm(const UserTerm& term, const BodyModel& model) {
  BODYLOOM_CHECK(term.cost != nullptr, "term '", term.name, "': no cost function");
  BODYLOOM_CHECK(!term.inputs.empty(), "term '", term.name, "': reads nothing; expected at least one input");
  for (const TermInput& input : term.inputs) {
    BODYLOOM_CHECK(input.later >= 0, "term '", term.name, "': reads a frame ", -input.later,
                   " before its own; expected its own or later ones");
    switch (input.kind) {
      case TermInput::Kind::kLandmark:
        BODYLOOM_CHECK(model.FindLandmark(input.landmark) >= 0, "term '", term.name, "': the body '", model.name(),
                       "' has no landmark '", input.landmark, "'");
        break;
      case TermInput::Kind::kSurfacePoint:
        BODYLOOM_CHECK(input.point.face >= 0 && input.point.face < model.num_faces(), "term '", term.name, "': face ",
                       input.point.face, ", the body '", model.name(), "' has faces 0 to ", model.num_faces() - 1);
        break;
      case TermInput::Kind::kRotation:
        BODYLOOM_CHECK(input.joint >= 0 && input.joint < model.num_joints(), "term '", term.name, "': joint ",
                       input.joint, ", the body '", model.name(), "' has joints 0 to ", model.num_joints() - 1);
        break;
      default:
        break;
    }
  }
}

}  // namespace bodyloom
