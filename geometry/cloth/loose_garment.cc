// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/loose_garment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

/// Furthest crossing of a ray in a horizontal plane with the body.
struct Crossing {
  int face = -1;
  Vector3d barycentric = Vector3d::Zero();
  double distance = 0;
};

Crossing LastCrossing(const MatrixX3d& vertices, const MatrixX3i& faces, const std::vector<int>& candidates,
                      const Vector3d& origin, const Vector3d& direction) {
  Crossing last;
  for (const int f : candidates) {
    const Vector3d a = vertices.row(faces(f, 0)), b = vertices.row(faces(f, 1)), c = vertices.row(faces(f, 2));
    Eigen::Matrix3d M;  // a + β(b − a) + γ(c − a) = origin + t·direction
    M << b - a, c - a, -direction;
    const double det = M.determinant();
    if (std::abs(det) < 1e-14) continue;
    const Vector3d s = M.inverse() * (origin - a);
    constexpr double kSlack = 1e-9;  // a ray through an edge meets one of its faces at least
    if (s.x() < -kSlack || s.y() < -kSlack || s.x() + s.y() > 1 + kSlack || s.z() <= last.distance) continue;
    last = {f, Vector3d(1 - s.x() - s.y(), s.x(), s.y()), s.z()};
  }
  return last;
}

/// Vertex numbers of rings of `columns` columns. Closed rings end where they begin; in front of a slit the last column
/// is a vertex of its own.
class RingIndex {
 public:
  RingIndex(int rings, int columns, int closed_rings) : columns_(columns), closed_(closed_rings) {
    size_ = closed_ * columns + (rings - closed_) * (columns + 1);
  }
  [[nodiscard]] int size() const { return size_; }
  /// column in 0..columns.
  [[nodiscard]] int At(int ring, int column) const {
    if (ring < closed_) return ring * columns_ + column % columns_;
    return closed_ * columns_ + (ring - closed_) * (columns_ + 1) + column;
  }
  [[nodiscard]] bool IsClosed(int ring) const { return ring < closed_; }

 private:
  int columns_, closed_, size_;
};

}  // namespace

LooseGarment CutLooseGarment(const MatrixX3d& vertices, const MatrixX3i& faces, double arm_x_m,
                             const LooseGarmentOptions& o) {
  BODYLOOM_CHECK(o.length_m > 0 && o.length_m < 3 && o.fullness >= 0 && o.fullness <= 0.95 && o.spacing_m > 0.002 &&
                     o.spacing_m <= o.length_m && o.mass_kg_m2 > 0 && o.shear_compliance >= 0 &&
                     o.bend_compliance >= 0 && (o.columns == 0 || (o.columns >= 16 && o.columns <= 4096)),
                 "loose garment: length ", o.length_m, " m, fullness ", o.fullness, ", spacing ", o.spacing_m,
                 " m, mass ", o.mass_kg_m2, " kg/m², ", o.columns, " columns");
  std::vector<int> candidates;
  Eigen::AlignedBox3d section;
  for (int f = 0; f < faces.rows(); ++f) {
    double low = 1e9, high = -1e9, side = 0;
    for (int c = 0; c < 3; ++c) {
      low = std::min(low, vertices(faces(f, c), 1)), high = std::max(high, vertices(faces(f, c), 1));
      side = std::max(side, std::abs(vertices(faces(f, c), 0)));
    }
    if (low > o.waist_y_m || high < o.waist_y_m || side > arm_x_m) continue;
    candidates.push_back(f);
    for (int c = 0; c < 3; ++c) section.extend(Vector3d(vertices.row(faces(f, c)).transpose()));
  }
  BODYLOOM_CHECK(!candidates.empty(), "loose garment: there is no body at a height of ", o.waist_y_m, " m");
  const Vector3d centre(section.center().x(), o.waist_y_m, section.center().z());

  const double mean_radius = 0.25 * (section.sizes().x() + section.sizes().z());
  const double hem = 2 * M_PI * (mean_radius + o.fullness * o.length_m);
  LooseGarment garment;
  const int columns = garment.columns =
      o.columns > 0 ? o.columns : std::max(16, static_cast<int>(std::lround(hem / o.spacing_m)));
  const int rings = garment.rings = static_cast<int>(std::lround(o.length_m / o.spacing_m)) + 1;
  const double path = o.length_m / (rings - 1);
  const int closed = o.slit_from_m < 0 ? rings : std::clamp(static_cast<int>(o.slit_from_m / path), 1, rings);
  const RingIndex index(rings, columns, closed);

  garment.sewn.resize(index.size());
  garment.pattern.resize(rings * (columns + 1), 3);
  garment.drawn_from.resize(rings * (columns + 1));
  garment.around_m = 2 * M_PI * (mean_radius + 0.5 * o.fullness * o.length_m);
  for (int j = 0; j <= columns; ++j) {
    const double angle = 2 * M_PI * j / columns;
    const Vector3d outwards(std::sin(angle), 0, std::cos(angle));
    const Crossing crossing = LastCrossing(vertices, faces, candidates, centre, outwards);
    BODYLOOM_CHECK(crossing.face >= 0, "loose garment: the body is open at a height of ", o.waist_y_m, " m");
    if (j < columns) garment.pins.push_back({crossing.face, crossing.barycentric, o.lift_m});
    const Vector3d pinned = centre + (crossing.distance + o.lift_m) * outwards;
    const Vector3d down = o.fullness * outwards - std::sqrt(1 - o.fullness * o.fullness) * Vector3d::UnitY();
    for (int r = 0; r < rings; ++r) {
      const int v = index.At(r, j), drawn = r * (columns + 1) + j;
      garment.drawn_from[drawn] = v;
      garment.pattern.row(drawn) << float(garment.around_m * j / columns), float(r * path), 0;
      if (j < columns || !index.IsClosed(r)) garment.sewn[v] = pinned + r * path * down;
    }
  }

  ClothMesh& cloth = garment.cloth;
  const auto link = [&](int a, int b, double compliance) {
    cloth.links.push_back({a, b, (garment.sewn[a] - garment.sewn[b]).norm(), compliance});
  };
  cloth.faces.resize(2 * (rings - 1) * columns, 3);
  garment.drawn_faces.resize(cloth.faces.rows(), 3);
  cloth.mass_kg.assign(index.size(), 0);
  for (int r = 0, f = 0; r + 1 < rings; ++r) {
    for (int j = 0; j < columns; ++j, f += 2) {
      const int a = index.At(r, j), b = index.At(r + 1, j), c = index.At(r + 1, j + 1), d = index.At(r, j + 1);
      cloth.faces.row(f) << a, b, c;
      cloth.faces.row(f + 1) << a, c, d;
      const int drawn = r * (columns + 1) + j, below = drawn + columns + 1;
      garment.drawn_faces.row(f) << drawn, below, below + 1;
      garment.drawn_faces.row(f + 1) << drawn, below + 1, drawn + 1;
      for (int k = f; k < f + 2; ++k) {
        const Vector3d &p = garment.sewn[cloth.faces(k, 0)], &q = garment.sewn[cloth.faces(k, 1)],
                       &s = garment.sewn[cloth.faces(k, 2)];
        for (int i = 0; i < 3; ++i) cloth.mass_kg[cloth.faces(k, i)] += o.mass_kg_m2 * (q - p).cross(s - p).norm() / 6;
      }
    }
  }
  // From the pinned ring downwards, so that one sweep carries what it holds all the way to the hem.
  for (int r = 1; r < rings; ++r) {
    const int last = index.IsClosed(r) ? columns - 1 : columns;
    for (int j = 0; j <= last; ++j) {
      const int v = index.At(r, j);
      link(index.At(r - 1, j), v, 0);
      if (r >= 2) link(index.At(r - 2, j), v, o.bend_compliance);
      cloth.tethers.push_back({v, index.At(0, j), 1.01 * r * path});
    }
    for (int j = 0; j < columns; ++j) {
      link(index.At(r, j), index.At(r, j + 1), 0);
      link(index.At(r - 1, j), index.At(r, j + 1), o.shear_compliance);
      link(index.At(r - 1, j + 1), index.At(r, j), o.shear_compliance);
      if (index.IsClosed(r) || j + 2 <= columns) {
        link(index.At(r, j), index.At(r, index.IsClosed(r) ? (j + 2) % columns : j + 2), o.bend_compliance);
      }
    }
  }
  for (int j = 0; j < columns; ++j) cloth.mass_kg[index.At(0, j)] = 0;
  return garment;
}

void AddPositionNoise(LooseGarment* garment, uint64_t seed) {
  HashRandom random(seed, {0x666f6c64});
  for (int v = 0; v < garment->cloth.num_vertices(); ++v) {
    if (garment->cloth.mass_kg[v] == 0) continue;
    for (int c = 0; c < 3; ++c) garment->sewn[v][c] += 0.002 * random.Normal();
  }
}

std::vector<Vector3d> PinnedPlaces(const std::vector<SurfacePin>& pins, const MatrixX3d& vertices,
                                   const MatrixX3i& faces) {
  std::vector<Vector3d> places;
  places.reserve(pins.size());
  for (const SurfacePin& pin : pins) {
    const Vector3d a = vertices.row(faces(pin.face, 0)), b = vertices.row(faces(pin.face, 1)),
                   c = vertices.row(faces(pin.face, 2));
    const Vector3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    places.push_back(pin.barycentric.x() * a + pin.barycentric.y() * b + pin.barycentric.z() * c +
                     (length > 1e-12 ? pin.lift_m / length : 0) * normal);
  }
  return places;
}

}  // namespace bodyloom
