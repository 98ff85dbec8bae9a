// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/vmc_sender.h"

#include <lo/lo.h>
#include <utility>

#include <new>
#include <stdexcept>

#include "data_tools/formats/host_port.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Names in Unity and here, in the order of the hierarchy.
std::vector<std::pair<std::string, std::string>> BoneNames() {
  std::vector<std::pair<std::string, std::string>> names = {{"Hips", "pelvis"},  {"Spine", "spine1"},
                                                            {"Chest", "spine2"}, {"UpperChest", "spine3"},
                                                            {"Neck", "neck"},    {"Head", "head"}};
  for (const auto& [unity, own] : {std::pair{std::string("Left"), std::string("l_")}, {"Right", "r_"}}) {
    for (const auto& [bone, joint] : {std::pair{"UpperLeg", "hip"},
                                      {"LowerLeg", "knee"},
                                      {"Foot", "ankle"},
                                      {"Toes", "foot"},
                                      {"Shoulder", "collar"},
                                      {"UpperArm", "shoulder"},
                                      {"LowerArm", "elbow"},
                                      {"Hand", "wrist"}}) {
      names.emplace_back(unity + bone, own + joint);
    }
    for (const auto& [finger, joint] : {std::pair{"Thumb", "thumb"},
                                        {"Index", "index"},
                                        {"Middle", "middle"},
                                        {"Ring", "ring"},
                                        {"Little", "pinky"}}) {
      names.emplace_back(unity + finger + "Proximal", own + joint + "1");
      names.emplace_back(unity + finger + "Intermediate", own + joint + "2");
      names.emplace_back(unity + finger + "Distal", own + joint + "3");
    }
  }
  return names;
}

constexpr size_t kMostBytes = 1200;  ///< of a bundle: below the 1,500 of a network's packets

}  // namespace

Eigen::Vector3d UnityPosition(const Eigen::Vector3d& point) { return {-point.x(), point.y(), point.z()}; }

Eigen::Quaterniond UnityRotation(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond own(rotation);
  const double sign = own.w() < 0 ? -1 : 1;
  return {sign * own.w(), sign * own.x(), -sign * own.y(), -sign * own.z()};
}

std::vector<VmcBone> VmcBones(const BodyModel& body, const MatrixX3d& rest_joints, const BodyPose& pose,
                              const Eigen::Vector3d& origin) {
  const int J = body.num_joints();
  BODYLOOM_CHECK(rest_joints.rows() == J && int(pose.rotations.size()) == J, "VMC bones: ", rest_joints.rows(),
                 " rest joints and ", pose.rotations.size(), " rotations, expected ", J, " of each");
  static const std::vector<std::pair<std::string, std::string>> names = BoneNames();
  std::vector<VmcBone> bones;
  for (const auto& [name, joint] : names) {
    const int j = body.FindJoint(joint);
    if (j < 0) continue;
    const int parent = body.parents()[size_t(j)];
    const Eigen::Vector3d rest = rest_joints.row(j).transpose();
    const Eigen::Vector3d place = parent < 0 ? Eigen::Vector3d(rest + pose.trans - origin)
                                             : Eigen::Vector3d(rest - rest_joints.row(parent).transpose());
    bones.push_back({name, UnityPosition(place), UnityRotation(pose.rotations[size_t(j)])});
  }
  return bones;
}

class VmcSender::Target {
 public:
  explicit Target(const std::string& text) {
    const HostPort target = ParseHostPort(text, 1);
    address_ = lo_address_new(target.host.c_str(), std::to_string(target.port).c_str());
    // The name is looked up here, so that a wrong one is said at once.
    if (address_ == nullptr || lo_send(address_, "/VMC/Ext/OK", "iiii", 1, 3, 0, 0) < 0) {
      const std::string why = address_ == nullptr ? "no such address" : lo_address_errstr(address_);
      if (address_ != nullptr) lo_address_free(address_);
      throw std::runtime_error(text + ": nothing can be sent there (" + why + ")");
    }
  }
  ~Target() {
    Flush();
    lo_address_free(address_);
  }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  void Add(const char* path, lo_message message) {
    if (message == nullptr) throw std::bad_alloc();
    if (bundle_ == nullptr) bundle_ = lo_bundle_new(LO_TT_IMMEDIATE);
    if (bundle_ == nullptr) throw std::bad_alloc();
    lo_bundle_add_message(bundle_, path, message);
    if (lo_bundle_length(bundle_) > kMostBytes) Flush();
  }
  void Flush() {
    if (bundle_ == nullptr) return;
    lo_send_bundle(address_, bundle_);  // a receiver that is not there is no fault
    lo_bundle_free_recursive(bundle_);
    bundle_ = nullptr;
  }

 private:
  lo_address address_ = nullptr;
  lo_bundle bundle_ = nullptr;
};

VmcSender::VmcSender(const std::string& address) : target_(std::make_unique<Target>(address)) {}
VmcSender::~VmcSender() = default;

void VmcSender::Send(double seconds, bool tracked, const std::vector<VmcBone>& bones) {
  const auto add = [this](const char* path, const auto& fill) {
    const lo_message message = lo_message_new();
    if (message != nullptr) fill(message);
    target_->Add(path, message);
  };
  const auto place = [](lo_message m, const VmcBone& bone) {
    lo_message_add_string(m, bone.name.c_str());
    for (const double p : bone.position) lo_message_add_float(m, float(p));
    for (const double q : bone.rotation.coeffs()) lo_message_add_float(m, float(q));  // x y z w
  };
  add("/VMC/Ext/OK", [&](lo_message m) {
    for (const int32_t value : {1, 3, 0, tracked ? 1 : 0}) lo_message_add_int32(m, value);
  });
  add("/VMC/Ext/T", [&](lo_message m) { lo_message_add_float(m, float(seconds)); });
  if (!bones.empty()) add("/VMC/Ext/Root/Pos", [&](lo_message m) { place(m, {.name = "root"}); });
  for (const VmcBone& bone : bones) add("/VMC/Ext/Bone/Pos", [&](lo_message m) { place(m, bone); });
  target_->Flush();
}

}  // namespace bodyloom
