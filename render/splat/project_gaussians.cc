// SPDX-License-Identifier: Apache-2.0
#include "render/splat/project_gaussians.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "render/splat/project_simd.h"

namespace bodyloom {
namespace {

using splat_internal::ScreenProjection;

constexpr int kRowsAChunk = 1024;  // a multiple of FloatColumns::kLanes

ScreenProjection ScreenProjectionOf(const Camera& camera, const ProjectGaussiansOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "projection of Gaussians: ", why);
  const bool is_pinhole = camera.model == CameraModel::kPinhole;
  BODYLOOM_CHECK(!is_pinhole || !camera.HasDistortion(),
                 "projection of Gaussians: the camera has lens distortion, expected none (undistort the image)");
  ScreenProjection p;
  p.divide_by_depth = is_pinhole;
  p.near_m = options.near_m;
  p.low_pass_px2 = options.low_pass_px2;
  const auto set = [&](double fx, double fy, double cx, double cy) {
    BODYLOOM_CHECK(std::isfinite(fx) && std::isfinite(fy) && std::isfinite(cx) && std::isfinite(cy),
                   "projection of Gaussians: the camera's numbers are ", fx, ", ", fy, ", ", cx, ", ", cy,
                   ", expected finite ones");
    p.focal_x = static_cast<float>(fx), p.focal_y = static_cast<float>(fy);
    p.centre_x = static_cast<float>(cx), p.centre_y = static_cast<float>(cy);
  };
  if (is_pinhole) {
    set(camera.fx, camera.fy, camera.cx, camera.cy);
  } else {
    set(camera.scale, camera.scale, camera.scale * camera.tx + camera.cx, camera.scale * camera.ty + camera.cy);
  }
  return p;
}

template <class Work>
void ForChunksOfRows(int num_rows, int num_threads, const Work& work) {
  ParallelFor((num_rows + kRowsAChunk - 1) / kRowsAChunk, num_threads,
              [&](int i) { work(i * kRowsAChunk, std::min(num_rows, (i + 1) * kRowsAChunk)); });
}

}  // namespace

bool ProjectGaussiansOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("low_pass_px2", low_pass_px2, 0, 100) && in_range("near_m", near_m, Camera::kMinDepth, 1e6) &&
         in_range("num_threads", num_threads, 1, 1024);
}

void ProjectGaussians(const CameraGaussians& gaussians, const Camera& camera, const ProjectGaussiansOptions& options,
                      ScreenGaussians* screen) {
  const ScreenProjection projection = ScreenProjectionOf(camera, options);
  screen->Resize(gaussians.size());
  const FloatColumns &in = gaussians.columns, &out = screen->columns;
  ForChunksOfRows(gaussians.size(), options.num_threads, [&](int first, int last) {
    splat_internal::ProjectRows(projection, {in.data(), in.stride()}, first, last,
                                {screen->columns.data(), out.stride()});
  });
}

void ProjectGaussiansBackward(const CameraGaussians& gaussians, const ScreenGaussians& screen,
                              const FloatColumns& by_screen, const Camera& camera,
                              const ProjectGaussiansOptions& options, FloatColumns* by_gaussians) {
  const ScreenProjection projection = ScreenProjectionOf(camera, options);
  const int count = gaussians.size();
  BODYLOOM_CHECK(
      screen.size() == count && by_screen.rows() == count && by_screen.columns() == ScreenGaussians::kNumGradients,
      "projection of Gaussians: ", screen.size(), " on the screen with derivatives of ", by_screen.rows(), " by ",
      by_screen.columns(), ", expected ", count, " by ", static_cast<int>(ScreenGaussians::kNumGradients));
  by_gaussians->Resize(CameraGaussians::kNumColumns, count);
  const FloatColumns &in = gaussians.columns, &seen = screen.columns;
  ForChunksOfRows(count, options.num_threads, [&](int first, int last) {
    splat_internal::ProjectRowsBackward(projection, {in.data(), in.stride()}, {seen.data(), seen.stride()},
                                        {by_screen.data(), by_screen.stride()}, first, last,
                                        {by_gaussians->data(), by_gaussians->stride()});
  });
}

}  // namespace bodyloom
