// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/dense_history.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/base/check.h"
#include "geometry/scene/observations.h"

namespace bodyloom {
namespace {

constexpr size_t kMaxBytes = size_t{512} << 20;
constexpr float kUnit = 65535;

/// 0: left, 1: right, 2: middle.
int SideOf(const std::string& keypoint) {
  if (keypoint.rfind("left", 0) == 0) return 0;
  return keypoint.rfind("right", 0) == 0 ? 1 : 2;
}

/// Into a plane: the larger of what is there and a Gaussian.
void AddGaussian(double x, double y, double sigma, int width, int height, uint16_t* plane) {
  const double reach = 3 * sigma;
  if (!std::isfinite(x + y) || x < -reach || y < -reach || x > width + reach || y > height + reach) return;
  const int left = std::max(0, static_cast<int>(x - reach)), right = std::min(width - 1, static_cast<int>(x + reach));
  const int top = std::max(0, static_cast<int>(y - reach)), bottom = std::min(height - 1, static_cast<int>(y + reach));
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      const double dx = column - x, dy = row - y;
      const double value = std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
      uint16_t& pixel = plane[static_cast<ptrdiff_t>(row) * width + column];
      pixel = std::max(pixel, static_cast<uint16_t>(std::lround(value * kUnit)));
    }
  }
}

}  // namespace

DenseHistory::DenseHistory(const PersonFrames& frames, int past, const EstimatedPixels* estimated)
    : frames_(frames), past_(past), estimated_(estimated) {
  BODYLOOM_CHECK(past >= 1, "dense history: ", past, " frames, expected at least one");
}

DenseHistory::Planes DenseHistory::MakePlanes(int t) const {
  const PersonWindow& window = frames_.window();
  const size_t area = size_t(window.width) * window.height;
  Planes planes(kChannelsOfFrame * area);
  std::vector<float> uv(2 * area), body(area);
  if (estimated_ != nullptr) {
    estimated_->BodyMaps(window, t, uv, body);
  } else {
    frames_.BodyMaps(t, uv, body);
  }
  const auto code = [](float value) {
    return static_cast<uint16_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * kUnit));
  };
  for (size_t i = 0; i < 2 * area; ++i) planes[i] = code(uv[i]);
  for (size_t i = 0; i < area; ++i) planes[2 * area + i] = code(body[i]);
  const Eigen::Matrix<double, Eigen::Dynamic, 2> keypoints = frames_.Keypoints(t);
  const double sigma = kKeypointSigma * std::max(window.width, window.height);
  for (Eigen::Index k = 0; k < keypoints.rows(); ++k) {
    AddGaussian(keypoints(k, 0), keypoints(k, 1), sigma, window.width, window.height,
                &planes[(3 + SideOf(CocoNames()[k])) * area]);
  }
  return planes;
}

std::shared_ptr<const DenseHistory::Planes> DenseHistory::PlanesOf(int t) const {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = kept_.find(t); found != kept_.end()) return found->second;
  }
  auto made = std::make_shared<const Planes>(MakePlanes(t));
  const std::lock_guard lock(mutex_);
  if (kept_.emplace(t, made).second) order_.push_back(t);
  while (order_.size() > 1 && order_.size() * made->size() * sizeof(uint16_t) > kMaxBytes) {
    kept_.erase(order_.front());
    order_.pop_front();
  }
  return made;
}

void DenseHistory::Maps(int t, std::span<float> maps) const {
  const PersonWindow& window = frames_.window();
  const int width = window.width, height = window.height;
  const size_t area = size_t(width) * height, of_frame = kChannelsOfFrame * area;
  BODYLOOM_CHECK(maps.size() == past_ * of_frame, "dense history: room for ", maps.size(), " values, expected ",
                 past_ * of_frame);
  std::fill(maps.begin(), maps.end(), 0.0F);
  if (frames_.Segment(t) < 0) return;
  int s = t;
  for (int k = 0; k < past_; ++k) {
    if (k > 0 && s > 0 && frames_.Segment(s - 1) == frames_.Segment(t)) --s;
    const std::shared_ptr<const Planes> planes = PlanesOf(s);
    const Eigen::Vector2i moved = window.corner[s] - window.corner[t];
    const int left = std::max(0, moved.x()), right = std::min(width, width + moved.x());
    for (int c = 0; c < kChannelsOfFrame; ++c) {
      const uint16_t* from = &(*planes)[c * area];
      float* to = &maps[k * of_frame + c * area];
      for (int y = std::max(0, moved.y()); y < std::min(height, height + moved.y()); ++y) {
        for (int x = left; x < right; ++x) {
          to[size_t(y) * width + x] = static_cast<float>(from[size_t(y - moved.y()) * width + x - moved.x()]) / kUnit;
        }
      }
    }
  }
}

}  // namespace bodyloom
