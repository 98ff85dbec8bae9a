// SPDX-License-Identifier: Apache-2.0
#include "pipelines/gaussian_avatar/avatar_page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "geometry/base/check.h"
#include "pipelines/page/report_page.h"
#include "render/gaussian_avatar/pose_gaussians.h"

extern "C" const unsigned char bodyloom_page_avatar_begin[], bodyloom_page_avatar_end[];

namespace bodyloom {
namespace {

using Body = GaussianBody;

constexpr double kMaxKeyBytes = 16e6, kMaxBoneBytes = 16e6;

constexpr float kPageUnit_m = 1e-3F;  ///< what one step of a key's byte is worth

/// Columns of the page's table; the order is that of assets/page/avatar.js.
enum Column : int {
  kPlace = 0,
  kQuaternion = kPlace + 3,
  kScale = kQuaternion + 4,
  kOpacity = kScale + 3,
  kAlbedo = kOpacity + 1,
  kNormal = kAlbedo + 3,
  kWeight = kNormal + 3,
  kJoint = kWeight + Body::kInfluences,
  kNumColumns = kJoint + Body::kInfluences
};

constexpr const char* kAvatarHtml = R"(<style>
main { max-width: 1100px; }
#stage { position: relative; margin: 0 auto; background: linear-gradient(#e9edf2, #c9d0d8); border: 1px solid #e2e8f0; border-radius: 6px; overflow: hidden; touch-action: none; }
#stage canvas { display: block; width: 100%; cursor: grab; }
.controls { display: flex; flex-wrap: wrap; gap: 10px; align-items: center; margin: 10px 0; }
.controls input[type=range] { flex: 1; min-width: 200px; }
button { font: inherit; padding: 3px 12px; border: 1px solid #cbd5e0; border-radius: 6px; background: #fff; cursor: pointer; }
#place { color: #4a5568; font-size: 14px; min-height: 1.5em; }
#stage.plain { background: #000; border: 0; border-radius: 0; position: fixed; left: 0; top: 0; z-index: 1; }
</style>
<div id="stage"><canvas id="picture"></canvas></div>
<div class="controls"><button id="play">Pause</button><input id="slider" type="range" min="0" value="0" aria-label="frame">
<button id="view-front">As filmed</button><button id="view-left">Left</button><button id="view-back">Back</button><button id="view-right">Right</button></div>
<div id="place"></div>
<p>Drag to turn, wheel to come nearer. Space plays and pauses; the arrow keys go from frame to frame.</p>
)";

template <typename T>
std::string BytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// The person's numbers as the page wants them: what is constant over frames is worked out here.
std::vector<float> PageColumns(const Body& body) {
  const int n = body.size();
  std::vector<float> columns(static_cast<size_t>(kNumColumns) * n);
  const auto to = [&](int column, int row) -> float& { return columns[static_cast<size_t>(column) * n + row]; };
  for (int i = 0; i < n; ++i) {
    const auto from = [&](int column) { return body.parameters.column(column)[i]; };
    float length = 0, largest = -std::numeric_limits<float>::infinity(), sum = 0;
    for (int c = 0; c < 4; ++c) length += from(Body::kQuaternion + c) * from(Body::kQuaternion + c);
    for (int k = 0; k < Body::kInfluences; ++k) largest = std::max(largest, from(Body::kWeightLogit + k));
    for (int k = 0; k < Body::kInfluences; ++k) sum += std::exp(from(Body::kWeightLogit + k) - largest);
    const bool is_turned = length > 1e-12F;
    for (int c = 0; c < 4; ++c) {
      const float unturned = c == 0 ? 1.0F : 0.0F;
      to(kQuaternion + c, i) = is_turned ? from(Body::kQuaternion + c) / std::sqrt(length) : unturned;
    }
    for (int c = 0; c < 3; ++c) {
      to(kPlace + c, i) = from(Body::kPosition + c);
      to(kScale + c, i) = std::exp(from(Body::kLogScale + c));
      to(kAlbedo + c, i) = from(Body::kAlbedo + c);
      to(kNormal + c, i) = from(Body::kNormal + c);
    }
    to(kOpacity, i) = 1 / (1 + std::exp(-from(Body::kOpacityLogit)));
    for (int k = 0; k < Body::kInfluences; ++k) {
      to(kWeight + k, i) = std::exp(from(Body::kWeightLogit + k) - largest) / sum;
      to(kJoint + k, i) = static_cast<float>(body.joints[static_cast<size_t>(i) * Body::kInfluences + k]);
    }
  }
  return columns;
}

}  // namespace

int AvatarPage::FrameStep(int num_frames, int num_bones) {
  const double bytes = 12.0 * sizeof(float) * num_bones * num_frames;
  return std::max(1, static_cast<int>(std::ceil(bytes / kMaxBoneBytes)));
}

AvatarPage::AvatarPage(const GaussianBody& body, const MatrixX3i& faces, const Camera& camera,
                       const Eigen::Vector3d& up_in_camera, int num_frames)
    : body_(body),
      faces_(faces),
      camera_(camera),
      up_in_camera_(up_in_camera),
      num_frames_(num_frames),
      num_gaussians_(body.size()),
      gaussians_(PageColumns(body)) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole && !camera.HasDistortion() && camera.width > 0,
                 "an avatar's page: expected a pinhole camera without distortion, of a known size");
  const double keys = std::max(2.0, kMaxKeyBytes / (3.0 * std::max(1, num_gaussians_)));
  key_interval_ = std::max(1, static_cast<int>(std::ceil(num_frames / keys)));
}

void AvatarPage::AddFrame(double seconds, const AvatarFrame& frame, const CameraGaussians& posed) {
  BODYLOOM_CHECK(posed.size() == num_gaussians_, "an avatar's page: ", posed.size(), " Gaussians, expected ",
                 num_gaussians_);
  const int t = static_cast<int>(seconds_.size());
  num_joints_ = static_cast<size_t>(frame.num_joints());
  bones_.resize(12 * num_joints_ * static_cast<size_t>(t), std::numeric_limits<float>::quiet_NaN());
  bones_.insert(bones_.end(), frame.bones.begin(), frame.bones.end());
  seconds_.push_back(seconds);
  if (!IsKey(t)) return;
  bones_alone_.bones = frame.bones, bones_alone_.rest_joints = frame.rest_joints;
  PoseGaussians(body_, faces_, bones_alone_, {}, &on_bones_);
  const size_t first = changes_.size();
  changes_.resize(first + size_t{3} * num_gaussians_);
  for (int i = 0; i < num_gaussians_; ++i) {
    for (int r = CameraGaussians::kX; r <= CameraGaussians::kZ; ++r) {
      const float change = posed.columns(i, r) - on_bones_.columns(i, r);
      const float steps = std::clamp(change / kPageUnit_m, -127.0F, 127.0F);
      changes_[first + static_cast<size_t>(r) * num_gaussians_ + i] =
          std::isfinite(steps) ? static_cast<int8_t>(std::lround(steps)) : int8_t{0};
    }
  }
}

void AvatarPage::AddEmptyFrame(double seconds) {
  const int t = static_cast<int>(seconds_.size());
  seconds_.push_back(seconds);
  if (IsKey(t)) changes_.resize(changes_.size() + size_t{3} * num_gaussians_, 0);
}

std::string AvatarPage::ToHtml(const std::string& title, const std::string& subtitle) const {
  BODYLOOM_CHECK(num_joints_ > 0, "an avatar's page: no frame shows the person");
  std::vector<float> bones = bones_;
  bones.resize(12 * num_joints_ * seconds_.size(), std::numeric_limits<float>::quiet_NaN());
  nlohmann::json json = {{"gaussians", num_gaussians_},
                         {"joints", num_joints_},
                         {"influences", int{Body::kInfluences}},
                         {"key_interval", key_interval_},
                         {"unit", kPageUnit_m},
                         {"image_size", {camera_.width, camera_.height}},
                         {"K", {camera_.fx, camera_.fy, camera_.cx, camera_.cy}},
                         {"up", {up_in_camera_.x(), up_in_camera_.y(), up_in_camera_.z()}},
                         {"light", body_.light}};
  for (const double second : seconds_) json["seconds"].push_back(std::round(second * 1e4) / 1e4);
  ReportPage page(title, subtitle);
  page.AddHtml(kAvatarHtml);
  page.AddHtml(DataScript("avatar", "application/json", json.dump()));
  page.AddHtml(DataScript("gaussians", "application/octet-stream", Base64(BytesOf(gaussians_))));
  page.AddHtml(DataScript("bones", "application/octet-stream", Base64(BytesOf(bones))));
  page.AddHtml(DataScript("changes", "application/octet-stream", Base64(BytesOf(changes_))));
  page.AddHtml(CodeScript(bodyloom_page_avatar_begin, bodyloom_page_avatar_end));
  return page.ToHtml();
}

}  // namespace bodyloom
