// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_outputs.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/export/export_scene.h"
#include "data_tools/export/vmc_sender.h"
#include "pipelines/live/live_server.h"

namespace bodyloom {
namespace {

constexpr size_t kWaitingLines = 256;
constexpr int kPatience_ms = 1000;  ///< with a reader, at the end

[[noreturn]] void ThrowWriteFailed(const std::string& path) {
  const std::string what = path == "-" ? "standard output" : path;
  throw std::runtime_error(what + ": writing failed (" + std::strerror(errno) + ")");
}

}  // namespace

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

LineWriter::LineWriter(const std::string& path, WhenFull when_full)
    : path_(path), file_(STDOUT_FILENO), closes_file_(path != "-"), lines_(kWaitingLines, when_full) {
  if (closes_file_) file_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_ < 0) ThrowWriteFailed(path);
  thread_ = std::thread([this] { Run(); });
}

LineWriter::~LineWriter() { Join(); }

void LineWriter::Join() {
  if (!thread_.joinable()) return;
  ending_ = true;
  lines_.Close();
  thread_.join();
  if (closes_file_) close(file_);
}

bool LineWriter::Write(std::string line) { return lines_.Put(std::move(line)); }

void LineWriter::Finish() {
  Join();
  if (error_) std::rethrow_exception(error_);
}

void LineWriter::Run() {
  try {
    while (std::optional<std::string> line = lines_.Take()) WriteAll(*line + "\n");
  } catch (...) {
    error_ = std::current_exception();
    lines_.Close();
  }
}

void LineWriter::WriteAll(const std::string& text) {
  for (size_t written = 0; written < text.size();) {
    pollfd ready = {file_, POLLOUT, 0};
    const int found = poll(&ready, 1, kPatience_ms);
    if (found == 0 && ending_) {
      lines_.Close();
      while (lines_.Take()) continue;
      return;
    }
    if (found <= 0) continue;
    // A pipe that is ready takes this many bytes without blocking.
    const ssize_t count = write(file_, text.data() + written, std::min<size_t>(text.size() - written, PIPE_BUF));
    if (count < 0 && errno != EINTR && errno != EAGAIN) ThrowWriteFailed(path_);
    written += size_t(std::max<ssize_t>(count, 0));
  }
}

}  // namespace bodyloom
