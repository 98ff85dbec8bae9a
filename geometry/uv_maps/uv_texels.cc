// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/uv_texels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// A centre on the edge of two faces belongs to one of them in spite of rounding.
constexpr double kOnEdge = 1e-9;
/// Inside by more than this in two faces: they overlap.
constexpr double kOverlap = 1e-4;
/// Faces crossed when following the surface beyond a seam.
constexpr int kMaxSteps = 64;

using Triangle2d = std::array<Vector2d, 3>;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Not clamped; the triangle has area.
Vector3d BarycentricOf(const Triangle2d& t, const Vector2d& p) {
  const double area = Cross(t[1] - t[0], t[2] - t[0]);
  const double b = Cross(p - t[0], t[2] - t[0]) / area, c = Cross(t[1] - t[0], p - t[0]) / area;
  return {1 - b - c, b, c};
}

double DistanceToSegment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d d = b - a;
  const double length2 = d.squaredNorm();
  const double s = length2 > 0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (a + s * d - p).norm();
}

Vector3d Clamped(const Vector3d& barycentric) {
  const Vector3d positive = barycentric.cwiseMax(0);
  return positive / positive.sum();
}

class TableBuilder {
 public:
  TableBuilder(const BodyModel& body, const UvCharts& charts, const UvTexelOptions& options)
      : body_(body),
        charts_(charts),
        gutter_(options.gutter),
        faces_(static_cast<size_t>(options.width) * options.height, -1),
        owners_(faces_.size(), -1),
        barycentrics_(faces_.size()) {
    table_.width = options.width;
    table_.height = options.height;
    table_.num_charts = charts.num_charts;
  }

  UvTexelTable Build() {
    for (int f = 0; f < body_.num_faces(); ++f) DrawFace(f);
    if (gutter_ > 0) DrawGutter();
    table_.chart_at.assign(faces_.size(), -1);
    for (size_t p = 0; p < faces_.size(); ++p) {
      if (faces_[p] < 0) continue;
      const bool in_gutter = owners_[p] >= 0;
      ++(in_gutter ? table_.num_gutter : table_.num_inside);
      table_.pixel.push_back(static_cast<int>(p));
      table_.face.push_back(faces_[p]);
      table_.barycentric.push_back(Clamped(barycentrics_[p]).cast<float>());
      table_.in_gutter.push_back(in_gutter);
      table_.chart_at[p] = in_gutter ? owners_[p] : charts_.chart[faces_[p]];
    }
    return std::move(table_);
  }

 private:
  /// Corners in texels: x = column, y = row, centres at integers.
  [[nodiscard]] Triangle2d TexelTriangle(int f) const {
    Triangle2d t;
    for (int k = 0; k < 3; ++k) {
      const int uv = body_.data().ft(f, k);
      const double u = body_.data().vt(uv, 0), v = body_.data().vt(uv, 1);
      t[k] = {u * table_.width - 0.5, (1 - v) * table_.height - 0.5};
    }
    return t;
  }

  [[nodiscard]] static bool HasArea(const Triangle2d& t) {
    const Vector2d a = t[1] - t[0], b = t[2] - t[0];
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
    return std::abs(Cross(a, b)) > 1e-9 * longest;
  }

  /// Calls visit(x, y) for the texels of the map whose centres lie in the box.
  template <typename Visit>
  void ForTexels(const Vector2d& low, const Vector2d& high, const Visit& visit) const {
    const auto begin = [](double x) { return static_cast<int>(std::ceil(std::clamp(x, -1.0, 1e6))); };
    const auto end = [](double x) { return static_cast<int>(std::floor(std::clamp(x, -1.0, 1e6))); };
    const int x_first = std::max(0, begin(low.x())), x_last = std::min(table_.width - 1, end(high.x()));
    const int y_first = std::max(0, begin(low.y())), y_last = std::min(table_.height - 1, end(high.y()));
    for (int y = y_first; y <= y_last; ++y) {
      for (int x = x_first; x <= x_last; ++x) visit(x, y);
    }
  }

  void DrawFace(int f) {
    const Triangle2d t = TexelTriangle(f);
    const Vector2d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    if (low.minCoeff() < -0.5 - 1e-6 * table_.width || high.x() > table_.width * (1 + 1e-6) - 0.5 ||
        high.y() > table_.height * (1 + 1e-6) - 0.5) {
      ++table_.faces_outside;
    }
    if (!HasArea(t)) {
      ++table_.faces_without_area;
      return;
    }
    ForTexels(low, high, [&](int x, int y) {
      const Vector3d b = BarycentricOf(t, Vector2d(x, y));
      if (b.minCoeff() < -kOnEdge) return;
      const size_t p = static_cast<size_t>(y) * table_.width + x;
      if (faces_[p] < 0) {
        faces_[p] = f;
        barycentrics_[p] = b;
      } else if (b.minCoeff() > kOverlap && barycentrics_[p].minCoeff() > kOverlap) {
        ++table_.overlapping;
      }
    });
  }

  void DrawGutter() {
    // A bilinear lookup inside a chart reads texels up to a texel away along both axes.
    const double reach = gutter_ * std::sqrt(2.0);
    std::vector<int> half_edge(faces_.size(), -1);
    std::vector<double> distance(faces_.size(), std::numeric_limits<double>::infinity());
    std::vector<char> contested(faces_.size(), 0);
    for (int h = 0; h < static_cast<int>(charts_.is_seam.size()); ++h) {
      if (!charts_.is_seam[h]) continue;
      const Triangle2d t = TexelTriangle(h / 3);
      if (!HasArea(t)) continue;
      const int k = h % 3;
      const Vector2d &a = t[k], &b = t[(k + 1) % 3];
      const Vector2d margin(reach, reach);
      ForTexels(a.cwiseMin(b) - margin, a.cwiseMax(b) + margin, [&](int x, int y) {
        const Vector2d centre(x, y);
        const double d = DistanceToSegment(centre, a, b);
        if (d > reach || BarycentricOf(t, centre)[(k + 2) % 3] >= 0) return;  // the side that the face is on
        const size_t p = static_cast<size_t>(y) * table_.width + x;
        const int chart = charts_.chart[h / 3];
        const int taken_by = faces_[p] >= 0      ? charts_.chart[faces_[p]]
                             : half_edge[p] >= 0 ? charts_.chart[half_edge[p] / 3]
                                                 : chart;
        if (taken_by != chart) contested[p] = 1;
        if (faces_[p] >= 0 || d >= distance[p]) return;
        distance[p] = d;
        half_edge[p] = h;
      });
    }
    for (size_t p = 0; p < faces_.size(); ++p) {
      table_.contested += contested[p];
      if (half_edge[p] < 0) continue;
      owners_[p] = charts_.chart[half_edge[p] / 3];
      const int column = static_cast<int>(p) % table_.width, row = static_cast<int>(p) / table_.width;
      const Vector2d centre(column, row);
      FollowSurface(half_edge[p], BarycentricOf(TexelTriangle(half_edge[p] / 3), centre), &faces_[p],
                    &barycentrics_[p]);
    }
  }

  [[nodiscard]] Vector3d Corner(int half_edge, int step) const {
    const int f = half_edge / 3;
    return body_.data().v_template.row(body_.data().faces(f, (half_edge % 3 + step) % 3)).transpose();
  }

  /// The face's third corner when the edge from corner 0 to corner 1 lies on the x axis, its start at the origin; the
  /// face on the side of positive y.
  [[nodiscard]] Vector2d Flattened(int half_edge, double* edge_length) const {
    const Vector3d along = Corner(half_edge, 1) - Corner(half_edge, 0),
                   to = Corner(half_edge, 2) - Corner(half_edge, 0);
    *edge_length = along.norm();
    if (*edge_length == 0) return {0, to.norm()};
    return {to.dot(along) / *edge_length, along.cross(to).norm() / *edge_length};
  }

  /// The point that lies beyond half-edge h at `outside`, extrapolated barycentrics of h's face: unrolls the faces
  /// across into the plane of that face until one of them holds the point.
  void FollowSurface(int h, const Vector3d& outside, int* face, Vector3d* barycentric) const {
    double length = 0;
    const Vector2d apex = Flattened(h, &length);
    const int k = h % 3;
    // Of the current face in the plane: the edge it is left by, from `start` to `end`, its third corner, and the point.
    Vector2d start(0, 0), end(length, 0), inside = apex;
    const Vector2d point = outside[k] * start + outside[(k + 1) % 3] * end + outside[(k + 2) % 3] * apex;
    *face = h / 3;
    *barycentric = outside;
    for (int step = 0; step < kMaxSteps; ++step) {
      const int across = charts_.mesh.opposite[h];
      if (across < 0) return;  // clamped to the boundary by the caller
      // The two faces traverse the shared edge in opposite directions when consistently oriented, else in the same one.
      const bool reversed = body_.data().faces(across / 3, across % 3) != body_.data().faces(h / 3, h % 3);
      const Vector2d from = reversed ? end : start, to = reversed ? start : end;
      const Vector2d third = Flattened(across, &length);
      const Vector2d along = length > 0 ? Vector2d((to - from) / length) : Vector2d(1, 0);
      Vector2d beyond(-along.y(), along.x());
      if (beyond.dot(inside - from) > 0) beyond = -beyond;
      const Vector2d tip = from + third.x() * along + third.y() * beyond;
      const Triangle2d t = {from, to, tip};
      if (!HasArea(t)) return;
      const Vector3d b = BarycentricOf(t, point);
      *face = across / 3;
      for (int c = 0; c < 3; ++c) (*barycentric)[(across % 3 + c) % 3] = b[c];
      if (b.minCoeff() >= 0) return;
      // Left through the edge opposite the most negative coordinate; never back through the one it came by.
      const int leave = b[0] < b[1] ? 0 : 1;
      if (b[leave] >= 0) return;
      const int edge = leave == 0 ? 1 : 2;  // edge 1: to → tip, edge 2: tip → from
      h = across - across % 3 + (across % 3 + edge) % 3;
      start = edge == 1 ? to : tip;
      end = edge == 1 ? tip : from;
      inside = edge == 1 ? from : to;
    }
  }

  const BodyModel& body_;
  const UvCharts& charts_;
  const int gutter_;
  UvTexelTable table_;
  std::vector<int> faces_;   // H·W: the face shown
  std::vector<int> owners_;  // H·W: the chart whose gutter it is, −1: no gutter
  std::vector<Vector3d> barycentrics_;
};

}  // namespace

bool UvTexelOptions::IsValid(std::string* why) const {
  if (width < 1 || height < 1 || width > 16384 || height > 16384 || int64_t{width} * height > int64_t{1} << 26) {
    *why = Concatenate("a UV map of ", width, "x", height, " texels, expected 1..16384 a side and at most ", 1 << 26);
    return false;
  }
  if (gutter < 0 || gutter > 64) {
    *why = Concatenate("gutter is ", gutter, " texels, expected 0..64");
    return false;
  }
  return true;
}

UvTexelTable BuildUvTexelTable(const BodyModel& body, const UvTexelOptions& options) {
  return BuildUvTexelTable(body, FindUvCharts(body), options);
}

UvTexelTable BuildUvTexelTable(const BodyModel& body, const UvCharts& charts, const UvTexelOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "UV texels: ", why);
  UvTexelTable table = TableBuilder(body, charts, options).Build();
  BODYLOOM_CHECK(table.num_inside > 0, "UV texels: no texel of a ", options.width, "x", options.height,
                 " map lies on a chart of the body '", body.name(), "' (", table.faces_outside, " of ",
                 body.num_faces(), " faces reach outside [0,1])");
  return table;
}

}  // namespace bodyloom
