// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_outputs.h"

#include <optional>
#include <utility>
#include <vector>

#include "data_tools/export/export_scene.h"
#include "data_tools/export/vmc_sender.h"
#include "pipelines/live/line_writer.h"
#include "pipelines/live/live_server.h"

namespace bodyloom {

struct LiveOutputs::Parts {
  /// VMC, with its origin on the ground where the person was first.
  class VmcOutput {
   public:
    explicit VmcOutput(const std::string& address) : sender_(address) {}

    void Send(const LiveState& state) {
      std::vector<VmcBone> bones;
      if (state.HasPose()) {
        const BodyPose pose = PoseInWorld(state.world, state.rest_joints.row(0).transpose(), state.pose);
        if (!origin_) {
          origin_ = state.rest_joints.row(0).transpose() + pose.trans;
          origin_->y() = 0;
        }
        bones = VmcBones(*state.body, state.rest_joints, pose, *origin_);
      }
      sender_.Send(state.frame.timestamp, state.HasPose(), bones);
    }

   private:
    VmcSender sender_;
    std::optional<Eigen::Vector3d> origin_;
  };

  std::function<void(const LiveState&)> on_frame;
  std::optional<VmcOutput> vmc;
  std::optional<LineWriter> lines;
  std::optional<LiveServer> server;
};

LiveOutputs::LiveOutputs(const LiveOutputsRequest& request, WhenFull when_full) : parts_(std::make_unique<Parts>()) {
  parts_->on_frame = request.on_frame;
  if (!request.vmc_address.empty()) parts_->vmc.emplace(request.vmc_address);
  if (!request.jsonl.empty()) parts_->lines.emplace(request.jsonl, when_full);
  if (!request.page_address.empty()) parts_->server.emplace(request.page_address, request.page_title);
}

LiveOutputs::~LiveOutputs() = default;

bool LiveOutputs::Send(const LiveState& state) {
  auto& [on_frame, vmc, lines, server] = *parts_;
  if (on_frame) on_frame(state);
  if (vmc) vmc->Send(state);
  if (!server && !lines) return true;
  std::string json = LiveJson(state);
  if (server) server->Publish(state, json);
  return !lines || lines->Write(std::move(json));
}

std::string LiveOutputs::url() const { return parts_->server ? parts_->server->url() : ""; }

int64_t LiveOutputs::Finish() {
  if (!parts_->lines) return 0;
  parts_->lines->Finish();
  return parts_->lines->num_dropped();
}

}  // namespace bodyloom
