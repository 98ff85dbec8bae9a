// SPDX-License-Identifier: Apache-2.0
/// Serves the page of `bodyloom live` over HTTP: the viewer of a clip's page, fed by server-sent events.
///
///   GET /          the page, one file
///   GET /body.glb  the body in T-pose, of the newest shape
///   GET /events    text/event-stream: "data: {"shape": N, "state": LiveJson()}" for every state, with "pose_mean" of
///                  a body that has one; when nothing comes, a comment every second
/// Everything else is answered by 404: no file of this machine is ever read. A client that is slow gets the newest
/// state when it is ready for one; it keeps up nobody else. A client that takes nothing for two seconds is put off, as
/// is more than kMostViewers (503). Where it listens at a loopback address it answers only requests that name one as
/// their host, so that no page of another site reaches it by way of a name that points here.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "geometry/body/body_model.h"
#include "pipelines/live/live_state.h"

namespace bodyloom {

class LiveServer {
 public:
  static constexpr int kMostViewers = 8;

  /// `listen`: ADDRESS:PORT; port 0: any free one. `title` is the page's. Throws std::invalid_argument for another
  /// form, std::runtime_error naming an address at which it cannot listen.
  LiveServer(const std::string& listen, const std::string& title);
  /// Ends all connections.
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// "http://127.0.0.1:8080/", with the port in use.
  [[nodiscard]] const std::string& url() const;
  [[nodiscard]] int port() const;
  /// Number of clients that receive events.
  [[nodiscard]] int num_viewers() const;
  /// Hands the newest state, and its LiveJson(), to all clients; returns at once.
  void Publish(const LiveState& state, const std::string& json);

 private:
  class Hub;
  class Http;
  std::unique_ptr<Hub> hub_;
  std::unique_ptr<Http> http_;
};

// The page that shows a body live: the script of a clip's page (assets/page/viewer.js) without a clip.

/// One HTML file, which needs nothing but the server's /body.glb and /events.
std::string LivePageHtml(const std::string& title);

/// The body in T-pose as .glb, for the page to pose: nodes and names as in glb_writer.h, one person, "person_0".
std::string LiveBodyGlb(const BodyModel& body, const Eigen::VectorXd& betas);

}  // namespace bodyloom
