// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/vmc_sender.h"

#include <lo/lo.h>

#include <new>
#include <stdexcept>

#include "data_tools/formats/host_port.h"

namespace bodyloom {
namespace {

constexpr size_t kMostBytes = 1200;  ///< of a bundle: below the 1,500 of a network's packets

}  // namespace

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
