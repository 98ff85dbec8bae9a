// SPDX-License-Identifier: Apache-2.0
#include "render/lighting/lit_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "render/image/image.h"

namespace bodyloom {
namespace {

/// The shading of one colour as a quadratic function of the normal, nᵀ Q n + l·n + c, equivalent to the nine
/// coefficients.
class Quadric {
 public:
  explicit Quadric(const Eigen::Matrix<double, 1, 9>& lighting) {
    // Interpolated from values at points, so that the basis is defined in one place only.
    const auto at = [&](double x, double y, double z) { return lighting.dot(ShBasis({x, y, z})); };
    const double even_z = (at(0, 0, 1) + at(0, 0, -1)) / 2, r = std::sqrt(0.5);
    constant_ = even_z;  // z² = 1 − x² − y² on the sphere
    linear_ = {(at(1, 0, 0) - at(-1, 0, 0)) / 2, (at(0, 1, 0) - at(0, -1, 0)) / 2, (at(0, 0, 1) - at(0, 0, -1)) / 2};
    xx_ = (at(1, 0, 0) + at(-1, 0, 0)) / 2 - even_z;
    yy_ = (at(0, 1, 0) + at(0, -1, 0)) / 2 - even_z;
    xy_ = (at(r, r, 0) + at(-r, -r, 0)) - 2 * even_z - xx_ - yy_;
    xz_ = (at(r, 0, r) + at(-r, 0, -r)) - 2 * even_z - xx_;
    yz_ = (at(0, r, r) + at(0, -r, -r)) - 2 * even_z - yy_;
  }
  [[nodiscard]] float At(const float* n) const {
    const double x = n[0], y = n[1], z = n[2];
    return static_cast<float>(constant_ + linear_[0] * x + linear_[1] * y + linear_[2] * z + xx_ * x * x + yy_ * y * y +
                              xy_ * x * y + xz_ * x * z + yz_ * y * z);
  }

 private:
  double constant_, xx_, yy_, xy_, xz_, yz_;
  std::array<double, 3> linear_;
};

/// Clamped shading of the three colours, in the order of an image's channels: blue, green, red.
class LimitedShading {
 public:
  LimitedShading(const ShLighting& light, const ShadingLimits& limits)
      : colours_{Quadric(light.row(2)), Quadric(light.row(1)), Quadric(light.row(0))},
        minimum_(static_cast<float>(limits.minimum)),
        maximum_(static_cast<float>(limits.maximum)) {}
  [[nodiscard]] std::array<float, 3> At(const float* normal) const {
    std::array<float, 3> result{};
    for (size_t c = 0; c < 3; ++c) result[c] = std::clamp(colours_[c].At(normal), minimum_, maximum_);
    return result;
  }

 private:
  std::array<Quadric, 3> colours_;
  float minimum_, maximum_;
};

/// IEC 61966-2-1 by tables, in both directions.
class Encoding {
 public:
  static const Encoding& Get() {
    static const Encoding encoding;
    return encoding;
  }
  [[nodiscard]] float Decode(float byte) const {  // fractional too: a colour divided by its coverage
    const int lower = std::min(static_cast<int>(byte), 254);
    return decoded_[lower] + (byte - static_cast<float>(lower)) * (decoded_[lower + 1] - decoded_[lower]);
  }
  [[nodiscard]] float Encode(float light) const {
    const float place = std::clamp(light, 0.0F, 1.0F) * kSteps;
    const int lower = std::min(static_cast<int>(place), kSteps - 1);
    return encoded_[lower] + (place - static_cast<float>(lower)) * (encoded_[lower + 1] - encoded_[lower]);
  }

 private:
  static constexpr int kSteps = 4096;
  Encoding() {
    for (int i = 0; i < 256; ++i) decoded_[i] = static_cast<float>(DecodePixel(i / 255.0, PixelEncoding::kSrgb));
    for (int i = 0; i <= kSteps; ++i) {
      encoded_[i] = static_cast<float>(255 * EncodePixel(static_cast<double>(i) / kSteps, PixelEncoding::kSrgb));
    }
  }
  std::array<float, 256> decoded_{};
  std::array<float, kSteps + 1> encoded_{};
};

}  // namespace

LitSurface::LitSurface(const BodyModel& body, bool both_sides, int num_threads)
    : body_(&body), both_sides_(both_sides), threads_(num_threads) {}

void LitSurface::Look(const MatrixX3d& vertices, const Camera& camera) {
  width_ = camera.width, height_ = camera.height;
  buffer_.Render(vertices, body_->data().faces, camera, {.cull_back_faces = !both_sides_, .num_threads = threads_});
  ResolveRequest request;
  request.num_threads = threads_;
  request.normal = true;
  request.vertex_normals = &normals_.Compute(vertices, body_->data().faces);
  ResolvePixels(buffer_, *body_, vertices, camera, request, &pixels_);
  if (!both_sides_) return;
  // Uses the face's own orientation: its interpolated normal may face away at an outline where the face does not.
  const MatrixX3i& faces = body_->data().faces;
  std::vector<uint8_t> looks_away(static_cast<size_t>(faces.rows()));
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Eigen::Vector3d a = vertices.row(faces(f, 0)), b = vertices.row(faces(f, 1)), c = vertices.row(faces(f, 2));
    const Eigen::Vector3d ray = camera.model == CameraModel::kPinhole ? a : Eigen::Vector3d(0, 0, 1);
    looks_away[f] = (b - a).cross(c - a).dot(ray) > 0 ? 1 : 0;
  }
  for (size_t i = 0; i < buffer_.faces().size(); ++i) {
    const int face = buffer_.faces()[i];
    if (face < 0 || looks_away[face] == 0) continue;
    for (size_t c = 0; c < 3; ++c) pixels_.normal[3 * i + c] = -pixels_.normal[3 * i + c];
  }
}

const float* LitSurface::NormalAt(int x, int y) const {
  return buffer_.FaceAt(x, y) < 0 ? nullptr : &pixels_.normal[3 * buffer_.box().IndexOf(x, y)];
}

void LitSurface::CheckSizes(const ShadingLimits& limits, const Image& image) const {
  BODYLOOM_CHECK(image.width == width_ && image.height == height_, "light: the image is ", image.width, "x",
                 image.height, ", the camera's ", width_, "x", height_);
  BODYLOOM_CHECK(limits.minimum > 0 && limits.minimum <= limits.maximum, "light: shading from ", limits.minimum, " to ",
                 limits.maximum, ", expected 0 < minimum <= maximum");
}

void LitSurface::Light(const ShLighting& light, const ShadingLimits& limits, std::span<const uint8_t> coverage,
                       Image* image) const {
  CheckSizes(limits, *image);
  BODYLOOM_CHECK(coverage.size() == static_cast<size_t>(width_) * height_,
                 "light: the coverage is of another size than the image");
  const LimitedShading shading(light, limits);
  const Encoding& encoding = Encoding::Get();
  const PixelBox& box = buffer_.box();
  const int first = std::max(0, box.y_begin - 1), rows = std::min(height_, box.y_end + 1) - first;
  ParallelFor(std::max(0, box.empty() ? 0 : rows), threads_, [&](int row) {
    const int y = first + row;
    for (int x = std::max(0, box.x_begin - 1); x < std::min(width_, box.x_end + 1); ++x) {
      const uint8_t covered = coverage[static_cast<size_t>(y) * width_ + x];
      if (covered == 0) continue;
      std::array<float, 3> s{};
      if (const float* normal = NormalAt(x, y)) {
        s = shading.At(normal);
      } else {
        int neighbours = 0;
        for (int j = y - 1; j <= y + 1; ++j) {
          for (int i = x - 1; i <= x + 1; ++i) {
            const float* beside = NormalAt(i, j);
            if (beside == nullptr) continue;
            const std::array<float, 3> other = shading.At(beside);
            for (size_t c = 0; c < 3; ++c) s[c] += other[c];
            ++neighbours;
          }
        }
        if (neighbours == 0) continue;
        for (float& value : s) value /= static_cast<float>(neighbours);
      }
      uint8_t* pixel = image->pixel(x, y);
      const float share = static_cast<float>(covered) / 255;
      for (size_t c = 0; c < 3; ++c) {
        const float even = std::min(255.0F, static_cast<float>(pixel[c]) / share);
        pixel[c] = NearestByte(share * encoding.Encode(s[c] * encoding.Decode(even)));
      }
    }
  });
}

void LitSurface::Unlight(const ShLighting& light, const ShadingLimits& limits, Image* image) const {
  CheckSizes(limits, *image);
  const LimitedShading shading(light, limits);
  const Encoding& encoding = Encoding::Get();
  const PixelBox& box = buffer_.box();
  ParallelFor(box.empty() ? 0 : box.y_end - box.y_begin, threads_, [&](int row) {
    const int y = box.y_begin + row;
    for (int x = box.x_begin; x < box.x_end; ++x) {
      const float* normal = NormalAt(x, y);
      if (normal == nullptr) continue;
      const std::array<float, 3> s = shading.At(normal);
      uint8_t* pixel = image->pixel(x, y);
      for (size_t c = 0; c < 3; ++c) {
        pixel[c] = NearestByte(encoding.Encode(encoding.Decode(pixel[c]) / s[c]));
      }
    }
  });
}

}  // namespace bodyloom
