// SPDX-License-Identifier: Apache-2.0
#include "render/view/attribute_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "render/image/palette.h"
#include "render/view/error_colours.h"
#include "render/view/view_camera.h"

namespace bodyloom {
namespace {

using Bgr = std::array<float, 3>;

/// OpenCV's "turbo" table, reversed: warm colours first.
std::vector<Bgr> DepthColours() {
  cv::Mat ramp(1, 256, CV_8UC1), colours;
  for (int i = 0; i < 256; ++i) ramp.at<uint8_t>(0, i) = static_cast<uint8_t>(255 - i);
  cv::applyColorMap(ramp, colours, cv::COLORMAP_TURBO);
  std::vector<Bgr> result;
  for (int i = 0; i < 256; ++i) {
    const cv::Vec3b c = colours.at<cv::Vec3b>(0, i);
    result.push_back({float(c[0]), float(c[1]), float(c[2])});
  }
  return result;
}

ResolveRequest RequestOf(const AttributeImageOptions& options) {
  ResolveRequest request;
  request.num_threads = options.num_threads;
  request.part = options.attribute == SurfaceAttribute::kParts || options.attribute == SurfaceAttribute::kIuv;
  request.chart_uv = options.attribute == SurfaceAttribute::kIuv;
  request.normal = options.attribute == SurfaceAttribute::kNormal;
  request.depth = options.attribute == SurfaceAttribute::kDepth;
  if (options.attribute == SurfaceAttribute::kTexture) request.texel_attributes = {options.texture};
  if (options.attribute == SurfaceAttribute::kError) request.vertex_attributes = {{options.vertex_errors, 1}};
  return request;
}

/// Colour of a covered pixel of the box.
class Colouring {
 public:
  Colouring(const AttributeImageOptions& options, const ResolvedPixels& pixels) : options_(options), pixels_(pixels) {
    if (options.attribute == SurfaceAttribute::kDepth) depth_colours_ = DepthColours();
  }

  [[nodiscard]] Bgr At(size_t i) const {
    switch (options_.attribute) {
      case SurfaceAttribute::kParts: {
        const Colour c = PartColour(pixels_.part[i]);
        return {float(c.blue), float(c.green), float(c.red)};
      }
      case SurfaceAttribute::kIuv:
        return {40.0F + 8.0F * pixels_.part[i], 255 * pixels_.chart_uv[2 * i + 1], 255 * pixels_.chart_uv[2 * i]};
      case SurfaceAttribute::kNormal: {
        const float* n = &pixels_.normal[3 * i];
        return {127.5F * (1 - n[2]), 127.5F * (1 - n[1]), 127.5F * (1 + n[0])};
      }
      case SurfaceAttribute::kDepth: {
        const double share = (pixels_.depth_m[i] - options_.near_m) / (options_.far_m - options_.near_m);
        return depth_colours_[static_cast<size_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)))];
      }
      case SurfaceAttribute::kError: {
        const Colour c = ErrorColour(pixels_.vertex_attributes[0][i] / options_.error_maximum);
        return {float(c.blue), float(c.green), float(c.red)};
      }
      case SurfaceAttribute::kTexture:
        break;
    }
    const float* c = &pixels_.texel_attributes[0][3 * i];
    return {c[0], c[1], c[2]};
  }

 private:
  const AttributeImageOptions& options_;
  const ResolvedPixels& pixels_;
  std::vector<Bgr> depth_colours_;
};

}  // namespace

std::vector<float> TexelsOf(const Image& image) { return {image.bgr.begin(), image.bgr.end()}; }

void AttributePainter::Draw(const BodyModel& body, const MatrixX3d& vertices, const Camera& camera,
                            const AttributeImageOptions& options, Image* image, std::vector<uint8_t>* coverage) {
  BODYLOOM_CHECK(image->width == camera.width && image->height == camera.height, "attribute image: the image is ",
                 image->width, "x", image->height, ", the camera ", camera.width, "x", camera.height);
  BODYLOOM_CHECK(options.samples >= 1 && options.samples <= 8, "attribute image: ", options.samples,
                 " samples, expected 1..8");
  BODYLOOM_CHECK(options.attribute != SurfaceAttribute::kDepth || options.near_m < options.far_m,
                 "attribute image: depth from ", options.near_m, " to ", options.far_m, " m");
  BODYLOOM_CHECK(options.attribute != SurfaceAttribute::kTexture || options.texture.channels == 3,
                 "attribute image: a texture of ", options.texture.channels, " channels, expected 3");
  BODYLOOM_CHECK(options.attribute != SurfaceAttribute::kError || options.error_maximum > 0,
                 "attribute image: errors up to ", options.error_maximum, ", expected more than 0");
  BODYLOOM_CHECK(coverage == nullptr || coverage->size() == size_t(image->width) * image->height,
                 "attribute image: the coverage is of another size than the image");
  const int n = options.samples;
  const Camera fine = ScaledCamera(camera, n);
  buffer_.Render(vertices, body.data().faces, fine,
                 {.cull_back_faces = !options.both_sides, .num_threads = options.num_threads});
  ResolveRequest request = RequestOf(options);
  if (request.normal) request.vertex_normals = &normals_.Compute(vertices, body.data().faces);
  ResolvePixels(buffer_, body, vertices, fine, request, &pixels_);
  const PixelBox& box = buffer_.box();
  if (box.empty()) return;
  const Colouring colouring(options, pixels_);
  const int y_begin = box.y_begin / n, y_end = (box.y_end + n - 1) / n;
  ParallelFor(y_end - y_begin, options.num_threads, [&](int row) {
    const int y = y_begin + row;
    for (int x = box.x_begin / n; x < (box.x_end + n - 1) / n; ++x) {
      Bgr sum = {0, 0, 0};
      int covered = 0;
      for (int j = std::max(y * n, box.y_begin); j < std::min((y + 1) * n, box.y_end); ++j) {
        for (int i = std::max(x * n, box.x_begin); i < std::min((x + 1) * n, box.x_end); ++i) {
          const size_t at = box.IndexOf(i, j);
          if (buffer_.faces()[at] < 0) continue;
          const Bgr colour = colouring.At(at);
          for (int c = 0; c < 3; ++c) sum[c] += colour[c];
          ++covered;
        }
      }
      if (covered == 0) continue;
      const float share = 1.0F / static_cast<float>(n * n), rest = static_cast<float>(n * n - covered) * share;
      if (coverage != nullptr) {
        (*coverage)[size_t(y) * image->width + x] =
            static_cast<uint8_t>(std::lround(255.0F * static_cast<float>(covered) * share));
      }
      uint8_t* p = image->pixel(x, y);
      for (int c = 0; c < 3; ++c) {
        p[c] = static_cast<uint8_t>(std::clamp(rest * p[c] + share * sum[c] + 0.5F, 0.0F, 255.0F));
      }
    }
  });
}

}  // namespace bodyloom
