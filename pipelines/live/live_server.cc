// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_server.h"

#include <httplib.h>
#include <sys/socket.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "data_tools/export/export_scene.h"
#include "data_tools/export/glb_writer.h"
#include "data_tools/formats/host_port.h"
#include "pipelines/page/report_page.h"

extern "C" const unsigned char bodyloom_page_viewer_begin[], bodyloom_page_viewer_end[];

namespace bodyloom {
namespace {

constexpr const char* kLiveHtml = R"(<style>
main { max-width: 1280px; }
#stage { height: min(70vh, 720px); border: 1px solid #e2e8f0; border-radius: 6px; overflow: hidden; }
.controls { display: flex; flex-wrap: wrap; gap: 10px; align-items: center; margin: 10px 0; }
button { font: inherit; padding: 3px 12px; border: 1px solid #cbd5e0; border-radius: 6px; background: #fff; cursor: pointer; }
.scale { display: inline-block; width: 120px; height: 10px; border-radius: 5px; }
#place { color: #4a5568; font-size: 15px; min-height: 1.5em; font-variant-numeric: tabular-nums; }
</style>
<div id="stage"></div>
<div id="place">waiting for the first pose</div>
<div class="controls">
<button id="view-front">Front</button><button id="view-side">Side</button><button id="view-back">Back</button>
<button id="view-top">Above</button><button id="view-camera">Camera</button>
<label><input id="show-body" type="checkbox" checked> body</label>
<label hidden><input id="show-texture" type="checkbox"></label>
<label><input id="show-joints" type="checkbox"> joints, σ from 0 <span id="scale" class="scale"></span> to <span id="scale-end"></span></label>
<label><input id="show-camera" type="checkbox" checked> camera</label>
</div>
)";

constexpr int kClientTimeout_s = 2;
constexpr auto kHeartbeat = std::chrono::seconds(1);
/// Of the kernel, for one client: a dozen states, so that a slow client is not shown what is long over.
constexpr int kSendBytes = 64 << 10;
/// Threads: the viewers, and some for pages and whatever else knocks.
constexpr size_t kThreads = LiveServer::kMostViewers + 8;
/// The page is given another body once a component of the shape has moved by this much, in standard deviations.
constexpr double kShapeStep = 0.2;

bool IsLoopback(const std::string& host) { return host == "localhost" || host == "::1" || host.starts_with("127."); }

/// The host of a request's "Host" header, without port and brackets.
std::string HostNamed(const std::string& header) {
  if (header.starts_with('[')) return header.substr(1, header.find(']') - 1);
  return header.substr(0, header.find(':'));
}

/// `,"pose_mean":[…]` of a body that adds one to its poses.
std::string MeanOf(const BodyModel& body) {
  const Eigen::VectorXd& mean = body.data().pose_mean;
  if (mean.size() == 0 || mean.isZero()) return "";
  std::string text;
  for (const double value : mean) text += (text.empty() ? "" : ",") + std::to_string(value);
  return ",\"pose_mean\":[" + text + "]";
}

}  // namespace

/// The newest state, for any number of readers.
class LiveServer::Hub {
 public:
  void Publish(const LiveState& state, const std::string& json) {
    const std::lock_guard lock(mutex_);
    body_ = state.body;
    const Eigen::VectorXd& betas = state.frame.betas;
    if (betas.allFinite() && (shape_ == 0 || betas.size() != betas_.size() ||
                              (betas.size() > 0 && (betas - betas_).cwiseAbs().maxCoeff() > kShapeStep))) {
      betas_ = betas;
      ++shape_;
    }
    event_ = std::make_shared<const std::string>("data: {\"shape\":" + std::to_string(shape_) + MeanOf(*body_) +
                                                 ",\"state\":" + json + "}\n\n");
    ++number_;
    changed_.notify_all();
  }
  void Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  /// The newest event if it is not number `last`, waiting for it up to a heartbeat; null when none comes.
  std::shared_ptr<const std::string> Next(int64_t* last) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kHeartbeat, [&] { return closed_ || number_ != *last; });
    if (number_ == *last) return nullptr;
    *last = number_;
    return event_;
  }
  [[nodiscard]] bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  /// Empty before the first state.
  std::string Glb() {
    std::unique_lock lock(mutex_);
    const std::shared_ptr<const BodyModel> body = body_;
    const Eigen::VectorXd betas = betas_;
    const int64_t shape = shape_;
    lock.unlock();
    if (shape == 0) return "";
    const std::lock_guard making(glb_mutex_);
    if (glb_shape_ != shape) {
      glb_ = LiveBodyGlb(*body, betas);
      glb_shape_ = shape;
    }
    return glb_;
  }
  /// Takes a place of a viewer; false when there is none.
  bool Enter() {
    const std::lock_guard lock(mutex_);
    if (viewers_ >= kMostViewers) return false;
    ++viewers_;
    return true;
  }
  void Leave() {
    const std::lock_guard lock(mutex_);
    --viewers_;
  }
  [[nodiscard]] int viewers() const {
    const std::lock_guard lock(mutex_);
    return viewers_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const std::string> event_;
  std::shared_ptr<const BodyModel> body_;
  Eigen::VectorXd betas_;
  int64_t number_ = 0, shape_ = 0;
  int viewers_ = 0;
  bool closed_ = false;
  std::mutex glb_mutex_;
  std::string glb_;
  int64_t glb_shape_ = 0;
};

class LiveServer::Http {
 public:
  Http(const std::string& listen, const std::string& title, Hub* hub) : hub_(hub), page_(LivePageHtml(title)) {
    HostPort address = ParseHostPort(listen, 0);
    const bool loopback = IsLoopback(address.host);
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server_.set_read_timeout(kClientTimeout_s);
    server_.set_write_timeout(kClientTimeout_s);
    server_.set_keep_alive_timeout(kClientTimeout_s);
    server_.set_payload_max_length(1024);
    server_.set_tcp_nodelay(true);
    server_.set_socket_options([](int socket) {
      // Not SO_REUSEPORT, httplib's default, by which two programs would share one port and its clients.
      const int on = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
      setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSendBytes, sizeof kSendBytes);
    });
    server_.set_pre_routing_handler([loopback](const httplib::Request& request, httplib::Response& response) {
      response.set_header("Cache-Control", "no-store");
      response.set_header("X-Content-Type-Options", "nosniff");
      if (!loopback || IsLoopback(HostNamed(request.get_header_value("Host")))) {
        return httplib::Server::HandlerResponse::Unhandled;
      }
      response.status = 403;
      return httplib::Server::HandlerResponse::Handled;
    });
    server_.Get("/", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(page_, "text/html; charset=utf-8");
    });
    server_.Get("/body\\.glb", [this](const httplib::Request&, httplib::Response& response) {
      const std::string glb = hub_->Glb();
      glb.empty() ? void(response.status = 503) : response.set_content(glb, "model/gltf-binary");
    });
    server_.Get("/events", [this](const httplib::Request&, httplib::Response& response) { Stream(&response); });
    port_ = address.port == 0                                  ? server_.bind_to_any_port(address.host)
            : server_.bind_to_port(address.host, address.port) ? address.port
                                                               : -1;
    if (port_ <= 0)
      throw std::runtime_error(listen + ": cannot listen there (no such address here, or the port is taken)");
    address.port = port_;
    url_ = "http://" + ToText(address) + "/";
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ~Http() {
    hub_->Close();
    server_.stop();
    thread_.join();
  }
  Http(const Http&) = delete;
  Http& operator=(const Http&) = delete;

  [[nodiscard]] const std::string& url() const { return url_; }
  [[nodiscard]] int port() const { return port_; }

 private:
  void Stream(httplib::Response* response) {
    if (!hub_->Enter()) {
      response->status = 503;
      return;
    }
    response->set_chunked_content_provider(
        "text/event-stream",
        [this, last = int64_t{0}](size_t, httplib::DataSink& sink) mutable {
          const std::shared_ptr<const std::string> event = hub_->Next(&last);
          if (hub_->closed()) {
            sink.done();
            return true;
          }
          static constexpr std::string_view kNothing = ": nothing new\n\n";
          const std::string_view text = event ? std::string_view(*event) : kNothing;
          return sink.write(text.data(), text.size());
        },
        [this](bool) { hub_->Leave(); });
  }

  Hub* hub_;
  const std::string page_;
  httplib::Server server_;
  std::string url_;
  int port_ = 0;
  std::thread thread_;
};

LiveServer::LiveServer(const std::string& listen, const std::string& title)
    : hub_(std::make_unique<Hub>()), http_(std::make_unique<Http>(listen, title, hub_.get())) {}
LiveServer::~LiveServer() = default;
const std::string& LiveServer::url() const { return http_->url(); }
int LiveServer::port() const { return http_->port(); }
int LiveServer::num_viewers() const { return hub_->viewers(); }
void LiveServer::Publish(const LiveState& state, const std::string& json) { hub_->Publish(state, json); }

std::string LivePageHtml(const std::string& title) {
  ReportPage page(title, "live: the newest pose, in the world that the ground gives");
  page.AddHtml(kLiveHtml);
  const nlohmann::json clip = {
      {"live", true},
      {"fps", 30},
      {"seconds", {0}},
      {"people", {{{"name", "person_0"}, {"joints", SmplJointNames()}, {"sigma_mm", {nullptr}}}}},
      {"world_from_camera", {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};
  page.AddHtml(DataScript("clip", "application/json", clip.dump()));
  page.AddHtml(CodeScript(bodyloom_page_viewer_begin, bodyloom_page_viewer_end));
  return page.ToHtml();
}

std::string LiveBodyGlb(const BodyModel& body, const Eigen::VectorXd& betas) {
  ExportScene scene;
  ExportPerson& person = scene.people.emplace_back();
  person.name = "person_0";
  person.body = &body;
  person.betas = betas;
  person.rest_joints = body.RestJoints(betas);
  person.seconds = {0};
  BodyPose rest;
  rest.rotations.assign(size_t(body.num_joints()), Eigen::Matrix3d::Identity());
  person.poses = {rest};
  SkinSummary exactness;
  return GlbText(scene, {.correctives = 0, .ground = false}, &exactness);
}

}  // namespace bodyloom
