// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/video_truth.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <utility>

#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Kind = PickleValue::Kind;

constexpr std::array<int, 17> kOf32 = {0, 1, 2, 3, 6, 7, 8, 12, 13, 14, 15, 17, 18, 19, 25, 26, 27};
constexpr std::array<const char*, 15> kActions = {"Directions", "Discussion", "Eating",  "Greeting",    "Phoning",
                                                  "Posing",     "Purchases",  "Sitting", "SittingDown", "Smoking",
                                                  "Photo",      "Waiting",    "Walking", "WalkDog",     "WalkTogether"};
constexpr int kFirstAction = 2, kFitStep = 5, kMaxHuman36mFrames = 100'000;
constexpr double kPlausible_m = 100;

/// Action and subaction of a name.
std::pair<std::string, std::string> SplitSequence(const std::string& sequence) {
  const size_t slash = sequence.rfind('/');
  if (slash == std::string::npos) return {sequence, ""};
  std::string action = sequence.substr(0, slash);
  const auto named = std::find(kActions.begin(), kActions.end(), action);
  if (named != kActions.end()) action = std::to_string(kFirstAction + (named - kActions.begin()));
  return {action, sequence.substr(slash + 1)};
}

/// Frames of the sequence by their numbers.
std::map<int, JsonNode> FramesOfSequence(const JsonNode& document, const std::string& sequence) {
  const auto [action, subaction] = SplitSequence(sequence);
  if (!document.is_object() || !document.Has(action) || !document.At(action).Has(subaction)) {
    std::vector<std::string> present;
    for (const std::string& name : document.Keys()) {
      for (const std::string& part : document.At(name).Keys()) present.push_back(name + "/" + part);
    }
    ThrowFileError(document.place(),
                   "no sequence '" + PrintableText(sequence) + "'; the file has " + PrintableList(present));
  }
  const JsonNode node = document.At(action).At(subaction);
  std::map<int, JsonNode> frames;
  for (const std::string& key : node.Keys()) {
    int frame = -1;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), frame);
    if (error != std::errc() || end != key.data() + key.size() || frame < 0 || frame >= kMaxHuman36mFrames) {
      ThrowFileError(node.place(), "frame '" + PrintableText(key) + "', expected a number from 0");
    }
    frames.emplace(frame, node.At(key));
  }
  if (frames.empty()) ThrowFileError(node.place(), "no frame");
  return frames;
}

MatrixX3d RequirePlausible(MatrixX3d points, const std::string& where) {
  if (!points.allFinite() || points.cwiseAbs().maxCoeff() > kPlausible_m) {
    ThrowFileError(where, "joints farther than 100 m from the middle of the room, or no numbers");
  }
  return points;
}

}  // namespace

bool IsHuman36mPositions(const NpzArrays& arrays) {
  const auto found = arrays.find("positions_3d");
  return found != arrays.end() && found->second.dtype == DType::kOther;
}

Human36mClip Human36mFromPositions(const PickleValue& positions_3d, const std::string& sequence,
                                   const std::string& where) {
  std::vector<std::string> present;
  const NdArray* found = nullptr;
  for (const auto& [subject, actions] : positions_3d.dict) {
    for (const auto& [action, array] : actions->dict) {
      present.push_back(subject + "/" + action);
      if (present.back() == sequence && array->kind == Kind::kArray) found = &array->array;
    }
  }
  if (found == nullptr) {
    ThrowFileError(where, "positions_3d",
                   "no sequence '" + PrintableText(sequence) + "'; the file has " + PrintableList(present));
  }
  const bool has_32 = found->shape.size() == 3 && found->shape[1] == 32;
  if (!found->is_number() || found->shape.size() != 3 || (!has_32 && found->shape[1] != 17) || found->shape[2] != 3 ||
      found->shape[0] < 1 || found->shape[0] > kMaxHuman36mFrames) {
    ThrowFileError(where, "positions_3d", found->ShapeText() + ", expected frames x 32 x 3");
  }
  const std::vector<double> values = found->ToDoubles();
  Human36mClip clip;
  clip.sequence = sequence;
  const auto num_joints = size_t(found->shape[1]);
  for (size_t t = 0; t < size_t(found->shape[0]); ++t) {
    MatrixX3d joints(17, 3);
    for (size_t j = 0; j < 17; ++j) {
      const size_t at = 3 * (t * num_joints + (has_32 ? size_t(kOf32[j]) : j));
      joints.row(Eigen::Index(j)) << values[at], values[at + 1], values[at + 2];
    }
    clip.joints.push_back(RequirePlausible(joints, Concatenate(where, ": positions_3d: frame ", t)));
  }
  return clip;
}

bool HasHuman36mSmpl(const JsonNode& document) {
  JsonNode node = document;
  for (int level = 0; level < 3; ++level) {
    if (!node.is_object() || node.size() == 0) return false;
    node = node.At(node.Keys().front());
  }
  return node.Has("pose");
}

Human36mClip Human36mFromJson(const JsonNode& document, const std::string& sequence) {
  constexpr double kMm = 1e-3;
  const std::map<int, JsonNode> frames = FramesOfSequence(document, sequence);
  Human36mClip clip;
  clip.sequence = sequence;
  clip.joints.assign(size_t(frames.rbegin()->first) + 1, MatrixX3d(0, 3));
  for (const auto& [t, node] : frames) {
    const std::vector<double> numbers = node.Numbers(17 * 3);
    const RowMatrixXd joints = kMm * Eigen::Map<const RowMatrixXd>(numbers.data(), 17, 3);
    clip.joints[size_t(t)] = RequirePlausible(joints, node.place());
  }
  return clip;
}

VideoTruth Human36mSmplFromJson(const JsonNode& document, const std::string& sequence, const NamedCamera& camera) {
  const std::map<int, JsonNode> frames = FramesOfSequence(document, sequence);
  const int T = frames.rbegin()->first + kFitStep;  // the video goes on to the next fit at most
  VideoTruth truth;
  truth.dataset = "Human3.6M";
  truth.protocol = "h36m-smpl";
  truth.sequence = sequence;
  truth.gender = "neutral";
  truth.fps = kHuman36mFps;
  Track& track = truth.track;
  track.motion.body = "smpl";
  track.motion.betas.setZero(10);
  SetLostFrames(T, 72, camera, &truth);
  for (const auto& [t, node] : frames) {
    const std::vector<double> pose = node.At("pose").Numbers(72), shape = node.At("shape").Numbers(10),
                              trans = node.At("trans").Numbers(3);
    track.motion.poses.row(t) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), 72);
    track.motion.trans.row(t) = Eigen::Map<const Eigen::RowVector3d>(trans.data());
    track.motion.betas += Eigen::Map<const Eigen::VectorXd>(shape.data(), 10) / double(frames.size());
    track.frame_status[size_t(t)] = FrameStatus::kTracked;
  }
  return truth;
}

}  // namespace bodyloom
