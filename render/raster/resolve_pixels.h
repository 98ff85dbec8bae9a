// SPDX-License-Identifier: Apache-2.0
/// Computes requested attributes of the visible surface per pixel: part, chart and atlas coordinates (together with the
/// part: IUV), depth, normal, barycentrics, and any attribute given per vertex or per texel of a UV map.
///
/// The surface point of a pixel is where the ray through its centre meets the plane of the face that the visibility
/// buffer found, from the unrounded vertices: with λ the barycentrics of the pixel in the projected face,
///   b_c = max(λ_c, 0)·w_c / Σ max(λ, 0)·w,   w = 1/z of the corner (pinhole) or 1 (weak perspective),
/// perspective correct and free of the 1/256 px rounding used for visibility; because of that rounding a pixel may lie
/// slightly outside its face, hence the clamp. Distorted lenses: λ is computed from undistorted positions. In float
/// relative to the face's first corner: b agrees with render/raster/visible_points.h (double) to 1e-5. Faces clipped at
/// the near plane and faces seen edge-on use that function.
///
/// Values are interpolated within a face only, hence never across charts or seams.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

/// `channels` values per vertex, V × channels.
struct VertexAttribute {
  std::span<const float> values;
  int channels = 1;
};

/// A UV map over the body's atlas: height × width × channels, row r and column c centred at u = (c+½)/width,
/// v = 1 − (r+½)/height. Sampled bilinearly in float (no rounding of coordinates); coordinates outside the outermost
/// texel centres take the border's value.
struct TexelAttribute {
  std::span<const float> values;
  int width = 0, height = 0, channels = 1;
};

struct ResolveRequest {
  bool part = false;         ///< chart id 1..24, 0 where the face has none
  bool chart_uv = false;     ///< (u, v) inside the face's chart
  bool atlas_uv = false;     ///< (u, v) in the body's atlas
  bool depth = false;        ///< z, metres
  bool normal = false;       ///< unit, outwards, interpolated from vertex normals; zero where they cancel
  bool barycentric = false;  ///< of the face's corners, each in [0, 1], sums to 1
  /// Rotates normals from the camera frame to the requested one: identity; world_from_camera; body_from_camera =
  /// transpose of the root's rotation in the camera frame.
  Eigen::Matrix3d normal_frame_from_camera = Eigen::Matrix3d::Identity();
  const MatrixX3f* vertex_normals = nullptr;  ///< V×3, camera frame; null: area-weighted ones are computed
  std::vector<VertexAttribute> vertex_attributes = {};
  std::vector<TexelAttribute> texel_attributes = {};
  int num_threads = 1;
};

/// Row-major over the buffer's box, channels interleaved. Background: part 0, all else 0 but depth +infinity.
/// Attributes not requested are empty.
struct ResolvedPixels {
  PixelBox box;
  std::vector<uint8_t> part;
  std::vector<float> chart_uv, atlas_uv;  ///< 2 per pixel
  std::vector<float> depth_m;
  std::vector<float> normal, barycentric;                               ///< 3 per pixel
  std::vector<std::vector<float>> vertex_attributes, texel_attributes;  ///< as many channels as given
};

/// Resolves every pixel of the buffer's box; the same bytes for any number of threads. `vertices_in_camera`, the body's
/// faces and `camera` must be those that were rendered. Memory of `result` is reused. Throws std::invalid_argument when
/// the body lacks a requested attribute, or an attribute's size does not fit.
void ResolvePixels(const VisibilityBuffer& buffer, const BodyModel& body, const MatrixX3d& vertices_in_camera,
                   const Camera& camera, const ResolveRequest& request, ResolvedPixels* result);

/// Samples a texel attribute at (u, v): writes `channels` values to `to`.
void SampleTexels(const TexelAttribute& map, float u, float v, float* to);

}  // namespace bodyloom
