// SPDX-License-Identifier: Apache-2.0
/// Attributes of the visible surface, pixel by pixel, and only those that were requested: part, chart and atlas
/// coordinates (together with the part: IUV), depth, normal, barycentrics, any attribute given by vertex or by texel of
/// a UV map.
///
/// The surface point of a pixel is where the ray through its centre meets the plane of the face that the visibility
/// buffer found, from the unrounded vertices: with λ the barycentrics of the pixel in the projected face,
///   b_c = max(λ_c, 0)·w_c / Σ max(λ, 0)·w,   w = 1/z of the corner (pinhole) or 1 (weak perspective),
/// perspective correct and free of the 1/256 px rounding that decided which face it is; the rounding may leave a pixel
/// outside its face by less than itself, hence the clamp. Distorted lenses: λ is taken between undistorted positions.
/// In float relative to the face's first corner: b agrees with render/raster/visible_points.h (double) to 1e-5. Faces
/// clipped at the near plane and faces seen edge-on take that path.
///
/// A value is interpolated inside one face and never across faces, so never across charts or seams.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

/// `channels` values a vertex, V × channels.
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
  /// Turns normals of the camera frame into the wanted one: identity; world_from_camera; body_from_camera = transpose
  /// of the root's rotation in the camera frame.
  Eigen::Matrix3d normal_frame_from_camera = Eigen::Matrix3d::Identity();
  const MatrixX3f* vertex_normals = nullptr;  ///< V×3, camera frame; null: area-weighted ones are computed
  std::vector<VertexAttribute> vertex_attributes = {};
  std::vector<TexelAttribute> texel_attributes = {};
  int num_threads = 1;
};

/// Row-major over the buffer's box, channels interleaved. Background: part 0, all else 0 but depth +infinity. What was
/// not requested is empty.
struct ResolvedPixels {
  PixelBox box;
  std::vector<uint8_t> part;
  std::vector<float> chart_uv, atlas_uv;  ///< 2 a pixel
  std::vector<float> depth_m;
  std::vector<float> normal, barycentric;                               ///< 3 a pixel
  std::vector<std::vector<float>> vertex_attributes, texel_attributes;  ///< as many channels as were given
};

/// Resolves every pixel of the buffer's box; the same bytes for any number of threads. `vertices_in_camera`, the body's
/// faces and `camera` must be those that were rendered. Memory of `result` is used again. Throws std::invalid_argument
/// when something is requested from a body that lacks it, or an attribute's size does not fit.
void ResolvePixels(const VisibilityBuffer& buffer, const BodyModel& body, const MatrixX3d& vertices_in_camera,
                   const Camera& camera, const ResolveRequest& request, ResolvedPixels* result);

/// A texel attribute at (u, v): `channels` values to `to`.
void SampleTexels(const TexelAttribute& map, float u, float v, float* to);

}  // namespace bodyloom
