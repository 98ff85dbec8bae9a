// SPDX-License-Identifier: Apache-2.0
#include "render/raster/resolve_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/body/normals.h"
#include "render/raster/raster_simd.h"
#include "render/raster/resolve_simd.h"
#include "render/raster/visible_points.h"

namespace bodyloom {
namespace {

using resolve_internal::Barycentrics;

constexpr int kRowsATask = 16;

/// The covered pixels of one row.
struct RowPoints {
  int size = 0;
  std::vector<int32_t> column, face;
  std::vector<Barycentrics> barycentric;
  std::vector<std::array<float, 2>> atlas_uv;
  explicit RowPoints(int width) : column(width), face(width), barycentric(width), atlas_uv(width) {}
};

class Resolver {
 public:
  Resolver(const VisibilityBuffer& buffer, const BodyModel& body, const MatrixX3d& vertices, const Camera& camera,
           const ResolveRequest& request, ResolvedPixels* result)
      : buffer_(buffer), body_(body), vertices_(vertices), camera_(camera), request_(request), out_(*result) {
    is_weak_ = camera.model == CameraModel::kWeakPerspective;
    is_linear_ = is_weak_ || !camera.HasDistortion();
    needs_atlas_ = request.atlas_uv || !request.texel_attributes.empty();
    needs_points_ = request.chart_uv || needs_atlas_ || request.depth || request.normal || request.barycentric ||
                    !request.vertex_attributes.empty();
    if (request.normal) {
      const MatrixX3f in_camera = request.vertex_normals != nullptr
                                      ? *request.vertex_normals
                                      : MatrixX3f(VertexNormals(vertices, body.data().faces).cast<float>());
      normals_ = in_camera * request.normal_frame_from_camera.cast<float>().transpose();
    }
  }

  void ResolveRow(int row, RowPoints* points) {
    FindPoints(row, points);
    const size_t to = size_t(row) * buffer_.box().width();
    ClearRow(to);
    const MatrixX3i& faces = body_.data().faces;
    if (request_.part) {
      for (int i = 0; i < points->size; ++i) {
        out_.part[to + points->column[i]] = body_.data().face_part[points->face[i]];
      }
    }
    if (request_.chart_uv) {
      const float* const charts = body_.data().face_iuv.data();
      Write<2>(*points, &out_.chart_uv[2 * to], [&](int i, float* uv) {
        const float* c = charts + 6 * size_t(points->face[i]);
        const auto& b = points->barycentric[i];
        uv[0] = b[0] * c[0] + b[1] * c[2] + b[2] * c[4];
        uv[1] = b[0] * c[1] + b[1] * c[3] + b[2] * c[5];
      });
    }
    if (needs_atlas_) {
      const auto& [vt, ft] = std::tie(body_.data().vt, body_.data().ft);
      for (int i = 0; i < points->size; ++i) {
        Mix<2>(vt.data(), &ft(points->face[i], 0), points->barycentric[i], points->atlas_uv[i].data());
      }
    }
    if (request_.atlas_uv) {
      Write<2>(*points, &out_.atlas_uv[2 * to],
               [&](int i, float* uv) { std::copy_n(points->atlas_uv[i].data(), 2, uv); });
    }
    if (request_.depth) {
      Write<1>(*points, &out_.depth_m[to], [&](int i, float* z) {
        double sum = 0;
        for (int c = 0; c < 3; ++c) sum += double{points->barycentric[i][c]} * vertices_(faces(points->face[i], c), 2);
        *z = static_cast<float>(sum);
      });
    }
    if (request_.normal) {
      Write<3>(*points, &out_.normal[3 * to], [&](int i, float* n) {
        Mix<3>(normals_.data(), &faces(points->face[i], 0), points->barycentric[i], n);
        const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        const float scale = square > 0 ? 1 / std::sqrt(square) : 0;
        for (int c = 0; c < 3; ++c) n[c] *= scale;
      });
    }
    if (request_.barycentric) {
      Write<3>(*points, &out_.barycentric[3 * to],
               [&](int i, float* b) { std::copy_n(points->barycentric[i].data(), 3, b); });
    }
    for (size_t k = 0; k < request_.vertex_attributes.size(); ++k) {
      const auto& [values, channels] = request_.vertex_attributes[k];
      float* const out = &out_.vertex_attributes[k][to * channels];
      for (int i = 0; i < points->size; ++i) {
        const auto& b = points->barycentric[i];
        const float* corner[3];
        for (int c = 0; c < 3; ++c) corner[c] = values.data() + size_t(channels) * faces(points->face[i], c);
        float* const pixel = out + size_t(channels) * points->column[i];
        for (int c = 0; c < channels; ++c) pixel[c] = b[0] * corner[0][c] + b[1] * corner[1][c] + b[2] * corner[2][c];
      }
    }
    for (size_t k = 0; k < request_.texel_attributes.size(); ++k) {
      const TexelAttribute& map = request_.texel_attributes[k];
      float* const out = &out_.texel_attributes[k][to * map.channels];
      for (int i = 0; i < points->size; ++i) {
        SampleTexels(map, points->atlas_uv[i][0], points->atlas_uv[i][1],
                     out + size_t(map.channels) * points->column[i]);
      }
    }
  }

 private:
  /// Writes background to the row that begins at pixel `to`.
  void ClearRow(size_t to) const {
    const size_t width = buffer_.box().width();
    const auto clear = [&](std::vector<float>* values, size_t channels) {
      if (!values->empty()) std::fill_n(values->begin() + channels * to, channels * width, 0.0F);
    };
    if (request_.part) std::fill_n(out_.part.begin() + to, width, uint8_t{0});
    if (request_.depth) std::fill_n(out_.depth_m.begin() + to, width, std::numeric_limits<float>::infinity());
    clear(&out_.chart_uv, 2);
    clear(&out_.atlas_uv, 2);
    clear(&out_.normal, 3);
    clear(&out_.barycentric, 3);
    for (size_t k = 0; k < request_.vertex_attributes.size(); ++k) {
      clear(&out_.vertex_attributes[k], request_.vertex_attributes[k].channels);
    }
    for (size_t k = 0; k < request_.texel_attributes.size(); ++k) {
      clear(&out_.texel_attributes[k], request_.texel_attributes[k].channels);
    }
  }

  template <int channels, class Fill>
  static void Write(const RowPoints& points, float* row, const Fill& fill) {
    for (int i = 0; i < points.size; ++i) fill(i, row + channels * points.column[i]);
  }

  /// Weighted sum of three rows of `channels` values.
  template <int channels>
  static void Mix(const float* values, const int* rows, const Barycentrics& weights, float* to) {
    const float *a = values + channels * size_t(rows[0]), *b = values + channels * size_t(rows[1]),
                *c = values + channels * size_t(rows[2]);
    for (int k = 0; k < channels; ++k) to[k] = weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k];
  }

  void FindPoints(int row, RowPoints* points) const {
    const PixelBox& box = buffer_.box();
    const int32_t* const ids = buffer_.faces().data() + size_t(row) * box.width();
    const CoveredSpan span = FindCoveredSpan(ids, box.width());
    if (needs_points_ && is_linear_) {
      points->size =
          resolve_internal::FindPoints({ids, span.begin, span.end, box.x_begin, box.y_begin + row,
                                        body_.data().faces.data(), buffer_.vertices().data(), is_weak_},
                                       points->column.data(), points->face.data(), points->barycentric.data());
    } else {
      points->size = 0;
      for (int column = span.begin; column < span.end; ++column) {
        if (ids[column] < 0) {
          while (column + 8 < span.end && SeeNothing(ids + column + 1)) column += 8;
          continue;
        }
        const int i = points->size++;
        points->column[i] = column;
        points->face[i] = ids[column];
        points->barycentric[i] = {0, 0, 0, 0};
      }
    }
    for (int i = 0; i < points->size && needs_points_; ++i) {
      Barycentrics& b = points->barycentric[i];
      if (b[3] != 0) continue;
      const Eigen::Vector2d pixel(box.x_begin + points->column[i], box.y_begin + row);
      const Eigen::Vector3f exact =
          BarycentricAtPixel(vertices_, body_.data().faces, camera_, points->face[i], pixel).cast<float>();
      b = {exact[0], exact[1], exact[2], 1};
    }
  }

  const VisibilityBuffer& buffer_;
  const BodyModel& body_;
  const MatrixX3d& vertices_;
  const Camera& camera_;
  const ResolveRequest& request_;
  ResolvedPixels& out_;
  MatrixX3f normals_;
  bool is_weak_ = false, is_linear_ = true, needs_atlas_ = false, needs_points_ = false;
};

void CheckRequest(const BodyModel& body, const MatrixX3d& vertices, const ResolveRequest& request) {
  BODYLOOM_CHECK(vertices.rows() == body.num_vertices(), "resolve: ", vertices.rows(), " vertices, the body '",
                 body.name(), "' has ", body.num_vertices());
  BODYLOOM_CHECK(!request.part || body.has_parts(), "resolve: the body '", body.name(), "' has no parts");
  BODYLOOM_CHECK(!request.chart_uv || body.data().face_iuv.rows() > 0, "resolve: the body '", body.name(),
                 "' has no chart coordinates");
  BODYLOOM_CHECK((!request.atlas_uv && request.texel_attributes.empty()) || body.has_uv(), "resolve: the body '",
                 body.name(), "' has no atlas");
  BODYLOOM_CHECK(request.num_threads >= 1, "resolve: ", request.num_threads, " threads, expected at least 1");
  BODYLOOM_CHECK(request.vertex_normals == nullptr || request.vertex_normals->rows() == body.num_vertices(),
                 "resolve: ", request.vertex_normals == nullptr ? 0 : request.vertex_normals->rows(),
                 " normals, the body has ", body.num_vertices(), " vertices");
  for (const VertexAttribute& attribute : request.vertex_attributes) {
    BODYLOOM_CHECK(attribute.channels >= 1 && attribute.values.size() == size_t(attribute.channels) * vertices.rows(),
                   "resolve: ", attribute.values.size(), " values of an attribute with ", attribute.channels,
                   " channels, the body has ", body.num_vertices(), " vertices");
  }
  for (const TexelAttribute& map : request.texel_attributes) {
    BODYLOOM_CHECK(map.channels >= 1 && map.width >= 1 && map.height >= 1 &&
                       map.values.size() == size_t(map.width) * map.height * map.channels,
                   "resolve: ", map.values.size(), " values of a UV map of ", map.height, "x", map.width, "x",
                   map.channels);
  }
}

/// Empty when not requested. Rows are cleared when written, while in the cache.
template <class T>
void Prepare(bool requested, size_t size, std::vector<T>* values) {
  values->resize(requested ? size : 0);
}

}  // namespace

void SampleTexels(const TexelAttribute& map, float u, float v, float* to) {
  const float x = std::clamp(u * static_cast<float>(map.width) - 0.5F, 0.0F, static_cast<float>(map.width - 1));
  const float y = std::clamp((1 - v) * static_cast<float>(map.height) - 0.5F, 0.0F, static_cast<float>(map.height - 1));
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const float right_share = x - static_cast<float>(left), bottom_share = y - static_cast<float>(top);
  const size_t right = left + 1 < map.width ? map.channels : 0;
  const size_t down = top + 1 < map.height ? size_t(map.width) * map.channels : 0;
  const float* p = map.values.data() + (size_t(top) * map.width + left) * map.channels;
  for (int c = 0; c < map.channels; ++c, ++p) {
    const float upper = p[0] + right_share * (p[right] - p[0]);
    const float lower = p[down] + right_share * (p[down + right] - p[down]);
    to[c] = upper + bottom_share * (lower - upper);
  }
}

void ResolvePixels(const VisibilityBuffer& buffer, const BodyModel& body, const MatrixX3d& vertices,
                   const Camera& camera, const ResolveRequest& request, ResolvedPixels* result) {
  CheckRequest(body, vertices, request);
  const PixelBox& box = buffer.box();
  const size_t area = box.area();
  result->box = box;
  Prepare(request.part, area, &result->part);
  Prepare(request.chart_uv, 2 * area, &result->chart_uv);
  Prepare(request.atlas_uv, 2 * area, &result->atlas_uv);
  Prepare(request.depth, area, &result->depth_m);
  Prepare(request.normal, 3 * area, &result->normal);
  Prepare(request.barycentric, 3 * area, &result->barycentric);
  result->vertex_attributes.resize(request.vertex_attributes.size());
  for (size_t k = 0; k < request.vertex_attributes.size(); ++k) {
    Prepare(true, area * request.vertex_attributes[k].channels, &result->vertex_attributes[k]);
  }
  result->texel_attributes.resize(request.texel_attributes.size());
  for (size_t k = 0; k < request.texel_attributes.size(); ++k) {
    Prepare(true, area * request.texel_attributes[k].channels, &result->texel_attributes[k]);
  }
  if (box.empty()) return;
  Resolver resolver(buffer, body, vertices, camera, request, result);
  ParallelFor((box.height() + kRowsATask - 1) / kRowsATask, request.num_threads, [&](int task) {
    RowPoints points(box.width());
    const int end = std::min(box.height(), (task + 1) * kRowsATask);
    for (int row = task * kRowsATask; row < end; ++row) resolver.ResolveRow(row, &points);
  });
}

}  // namespace bodyloom
