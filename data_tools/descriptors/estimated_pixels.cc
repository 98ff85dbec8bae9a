// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/estimated_pixels.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>

#include "data_tools/observations/densepose_iuv.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

bool IsNamedIuv(const std::string& path) { return std::filesystem::path(path).stem().string().ends_with("_IUV"); }

/// The window's part of a plane.
std::vector<uint8_t> CutPlane(const IuvImage& iuv, const std::vector<uint8_t>& plane, const PersonWindow& window,
                              int t) {
  Image image(iuv.width, iuv.height);
  for (size_t i = 0; i < plane.size(); ++i) image.bgr[3 * i] = plane[i];
  return CutLabels(image, window, t);
}

}  // namespace

EstimatedPixels::EstimatedPixels(const BodyModel& body, const std::string& path, int num_frames, int first)
    : body_(body), charts_(body) {
  BODYLOOM_CHECK(body.has_uv(), "estimated pixels: the body '", body.name(), "' has no atlas");
  if (std::filesystem::is_regular_file(path)) {
    files_ = {path};
    first = 0;
  } else {
    files_ = ImageFilesOf(path);
  }
  if (std::any_of(files_.begin(), files_.end(), IsNamedIuv)) {
    files_.erase(std::remove_if(files_.begin(), files_.end(), [](const auto& path) { return !IsNamedIuv(path); }),
                 files_.end());
  }
  if (static_cast<int>(files_.size()) < first + num_frames) {
    throw std::runtime_error(Concatenate(path, ": ", files_.size(), " IUV images, the track has ", first + num_frames));
  }
  files_.erase(files_.begin(), files_.begin() + first);
}

void EstimatedPixels::BodyMaps(const PersonWindow& window, int t, std::span<float> uv, std::span<float> mask,
                               std::span<uint8_t> parts) const {
  const size_t area = size_t(window.width) * window.height;
  BODYLOOM_CHECK(uv.size() == 2 * area && mask.size() == area && (parts.empty() || parts.size() == area),
                 "estimated pixels: room for ", uv.size(), " and ", mask.size(), " values, expected ", 2 * area,
                 " and ", area);
  std::fill(uv.begin(), uv.end(), 0.0F);
  std::fill(mask.begin(), mask.end(), 0.0F);
  std::fill(parts.begin(), parts.end(), uint8_t{0});
  const std::string& path = files_.at(t);
  const IuvImage iuv = ReadIuvImage(path);
  std::array<std::vector<uint8_t>, 3> cut;
  try {
    cut = {CutPlane(iuv, iuv.part, window, t), CutPlane(iuv, iuv.u, window, t), CutPlane(iuv, iuv.v, window, t)};
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  const auto& [part, u, v] = cut;
  const MatrixX2f& vt = body_.data().vt;
  const MatrixX3i& ft = body_.data().ft;
  for (size_t i = 0; i < area; ++i) {
    if (part[i] == 0) continue;
    const auto centre = [](uint8_t byte) { return std::min(1.0, (byte + 0.5) / 255); };  // it was rounded down
    double gap = 0;
    const SurfacePoint point = charts_.Find(part[i], {centre(u[i]), centre(v[i])}, &gap);
    if (point.face < 0 || gap > kMaxGap) continue;
    Eigen::Vector2d atlas = Eigen::Vector2d::Zero();
    for (int k = 0; k < 3; ++k) atlas += point.barycentric[k] * vt.row(ft(point.face, k)).transpose().cast<double>();
    uv[i] = static_cast<float>(atlas.x());
    uv[area + i] = static_cast<float>(atlas.y());
    mask[i] = 1;
    if (!parts.empty()) parts[i] = part[i];
  }
}

}  // namespace bodyloom
