// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_simulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

/// Cosine between a vertex' normal and the direction out of an obstacle beyond which the inner side is in contact.
constexpr double kInnerSide = 0.3;

/// Around a face that a limb has passed through, limbs do not hold the cloth.
constexpr double kFreed_m = 0.2;

bool AllFinite(const std::vector<Vector3d>& points) {
  return std::all_of(points.begin(), points.end(), [](const Vector3d& p) { return p.allFinite(); });
}

/// Vertices that share an edge of the faces, by vertex.
void BuildNeighbours(const MatrixX3i& faces, int num_points, std::vector<int>* begin, std::vector<int>* neighbours) {
  std::vector<std::pair<int, int>> edges;
  for (int f = 0; f < faces.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      const int a = faces(f, c), b = faces(f, (c + 1) % 3);
      BODYLOOM_CHECK(a >= 0 && b >= 0 && a < num_points && b < num_points, "cloth: face ", f, " of the surface joins ",
                     a, " and ", b, " of ", num_points, " points");
      edges.emplace_back(a, b);
      edges.emplace_back(b, a);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  begin->assign(num_points + 1, 0);
  neighbours->clear();
  for (const auto& [a, b] : edges) {
    ++(*begin)[a + 1];
    neighbours->push_back(b);
  }
  for (int i = 0; i < num_points; ++i) (*begin)[i + 1] += (*begin)[i];
}

/// Returns true if a + t·along passes through the triangle for some t in [0, 1).
bool SegmentCrosses(const Vector3d& a, const Vector3d& along, const Vector3d& p, const Vector3d& q, const Vector3d& r) {
  const Vector3d e1 = q - p, e2 = r - p, across = along.cross(e2);
  const double det = e1.dot(across);
  if (det == 0) return false;
  const Vector3d from = a - p;
  const double u = from.dot(across) / det;
  if (u < 0 || u >= 1) return false;
  const Vector3d beside = from.cross(e1);
  const double v = along.dot(beside) / det, t = e2.dot(beside) / det;
  return v >= 0 && u + v < 1 && t >= 0 && t < 1;
}

/// Calls crossed(f) for the faces that the segment from a to b passes through.
template <typename Crossed>
void ForEachCrossedFace(const MatrixX3i& faces, const std::vector<Vector3d>& positions, const Vector3d& a,
                        const Vector3d& b, const Crossed& crossed) {
  const Vector3d low = a.cwiseMin(b), high = a.cwiseMax(b), along = b - a;
  for (int f = 0; f < faces.rows(); ++f) {
    const Vector3d &p = positions[faces(f, 0)], &q = positions[faces(f, 1)], &r = positions[faces(f, 2)];
    bool apart = false;  // most are
    for (int c = 0; c < 3 && !apart; ++c) {
      apart = (p[c] < low[c] && q[c] < low[c] && r[c] < low[c]) || (p[c] > high[c] && q[c] > high[c] && r[c] > high[c]);
    }
    if (!apart && SegmentCrosses(a, along, p, q, r)) crossed(f);
  }
}

}  // namespace

double CapsuleDistance(const Capsule& capsule, const Vector3d& point, Vector3d* away, double* along) {
  const Vector3d axis = capsule.b - capsule.a;
  const double length2 = axis.squaredNorm();
  *along = length2 > 0 ? std::clamp(axis.dot(point - capsule.a) / length2, 0.0, 1.0) : 0;
  const Vector3d d = point - capsule.a - *along * axis;
  const double distance = d.norm();
  *away = distance > 1e-9 ? Vector3d(d / distance) : length2 > 0 ? axis.unitOrthogonal() : Vector3d::UnitY();
  return distance - (capsule.radius_a + *along * (capsule.radius_b - capsule.radius_a));
}

bool ClothOptions::IsValid(std::string* why) const {
  const auto no = [&](const char* text) {
    if (why != nullptr) *why = text;
    return false;
  };
  if (!gravity.allFinite()) return no("cloth: gravity must be finite");
  if (!(substep_s > 0 && substep_s <= 0.1)) return no("cloth: substep_s must be in (0, 0.1]");
  if (!(thickness_m >= 0 && thickness_m < search_m && search_m < 1)) {
    return no("cloth: thickness_m must be in [0, search_m), search_m below 1");
  }
  if (!(friction >= 0 && damping >= 0 && air_density >= 0 && drag_normal >= 0 && drag_tangential >= 0)) {
    return no("cloth: friction, damping and drag must not be negative");
  }
  if (!(max_speed > 0 && max_speed <= 1000)) return no("cloth: max_speed must be in (0, 1000]");
  if (!(pass_speed >= 0 && pass_speed <= max_speed)) return no("cloth: pass_speed must be in [0, max_speed]");
  if (floor && !(floor->point.allFinite() && std::abs(floor->up.norm() - 1) < 1e-6)) {
    return no("cloth: the floor needs a finite point and a unit vector");
  }
  return true;
}

ClothSimulation::ClothSimulation(ClothMesh mesh, std::vector<Vector3d> start, ClothObstacles obstacles,
                                 const MatrixX3i& surface_faces, const ClothOptions& options)
    : mesh_(std::move(mesh)), options_(options), obstacles_(std::move(obstacles)) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  const int n = mesh_.num_vertices();
  const auto is_vertex = [n](int v) { return v >= 0 && v < n; };
  inverse_mass_.resize(n), area_.assign(n, 0);
  for (int v = 0; v < n; ++v) {
    const double mass = mesh_.mass_kg[v];
    BODYLOOM_CHECK(mass >= 0 && std::isfinite(mass), "cloth: vertex ", v, " has a mass of ", mass, " kg");
    inverse_mass_[v] = mass > 0 ? 1 / mass : 0;
    (mass > 0 ? free_ : pinned_).push_back(v);
  }
  for (const ClothLink& l : mesh_.links) {
    BODYLOOM_CHECK(is_vertex(l.a) && is_vertex(l.b) && l.a != l.b && l.rest_m >= 0 && std::isfinite(l.rest_m) &&
                       l.compliance >= 0 && std::isfinite(l.compliance),
                   "cloth: link ", l.a, " to ", l.b, ", rest ", l.rest_m, " m, compliance ", l.compliance);
  }
  for (const ClothTether& t : mesh_.tethers) {
    BODYLOOM_CHECK(is_vertex(t.vertex) && is_vertex(t.anchor) && t.length_m > 0, "cloth: tether ", t.vertex, " to ",
                   t.anchor, ", length ", t.length_m, " m");
  }
  BODYLOOM_CHECK(mesh_.faces.size() == 0 || (mesh_.faces.minCoeff() >= 0 && mesh_.faces.maxCoeff() < n),
                 "cloth: a face has a vertex outside 0 to ", n - 1);
  BuildNeighbours(surface_faces, static_cast<int>(obstacles_.points.rows()), &neighbour_begin_, &neighbour_);
  nearest_.assign(n, -1), normal_.assign(n, Vector3d::Zero()), contact_.resize(n), off_.resize(n);
  Restart(std::move(start), obstacles_);
  for (int f = 0; f < mesh_.faces.rows(); ++f) {  // air meets each vertex with a third of its faces
    const Vector3d &a = x_[mesh_.faces(f, 0)], &b = x_[mesh_.faces(f, 1)], &c = x_[mesh_.faces(f, 2)];
    for (int k = 0; k < 3; ++k) area_[mesh_.faces(f, k)] += (b - a).cross(c - a).norm() / 6;
  }
}

void ClothSimulation::CheckObstacles(const ClothObstacles& o) const {
  BODYLOOM_CHECK(o.capsules.size() == obstacles_.capsules.size() && o.points.rows() == obstacles_.points.rows() &&
                     o.normals.rows() == o.points.rows(),
                 "cloth: ", o.capsules.size(), " capsules, ", o.points.rows(), " points and ", o.normals.rows(),
                 " normals, expected ", obstacles_.capsules.size(), ", ", obstacles_.points.rows(), " and as many");
  BODYLOOM_CHECK(o.belongs.empty() || static_cast<Eigen::Index>(o.belongs.size()) == o.points.rows(), "cloth: of ",
                 o.belongs.size(), " points with a place where they belong, expected none or all ", o.points.rows());
  BODYLOOM_CHECK(o.points.allFinite() && o.normals.allFinite(), "cloth: the obstacles are not finite");
  for (const Capsule& c : o.capsules) {
    BODYLOOM_CHECK(c.a.allFinite() && c.b.allFinite() && c.radius_a >= 0 && c.radius_b >= 0 &&
                       std::isfinite(c.radius_a + c.radius_b),
                   "cloth: a capsule is not finite");
  }
}

void ClothSimulation::set_damping(double damping) {
  BODYLOOM_CHECK(damping >= 0 && std::isfinite(damping), "cloth: a damping of ", damping, " a second");
  options_.damping = damping;
}

void ClothSimulation::Restart(std::vector<Vector3d> positions, ClothObstacles obstacles) {
  BODYLOOM_CHECK(positions.size() == mesh_.mass_kg.size() && AllFinite(positions), "cloth: ", positions.size(),
                 " positions, expected ", mesh_.mass_kg.size(), ", finite");
  CheckObstacles(obstacles);
  x_ = std::move(positions);
  before_ = x_;
  v_.assign(x_.size(), Vector3d::Zero());
  obstacles_ = std::move(obstacles);
}

void ClothSimulation::FindNearestPoints() {
  const MatrixX3d& points = obstacles_.points;
  std::fill(nearest_.begin(), nearest_.end(), -1);
  if (points.rows() == 0) return;
  // A grid with cells of the search radius: points nearer than it lie in a vertex' own cell or a neighbouring one.
  const double cell = options_.search_m;
  const Vector3d low = points.colwise().minCoeff().transpose();
  const Vector3d size = points.colwise().maxCoeff().transpose() - low;
  Eigen::Vector3i cells;
  for (int c = 0; c < 3; ++c) cells[c] = static_cast<int>(std::min(size[c] / cell, 199.0)) + 1;
  const auto cell_of = [&](const Vector3d& p, int c) {
    return static_cast<int>(std::clamp(std::floor((p[c] - low[c]) / cell), -1.0, double(cells[c])));
  };
  const auto index_of = [&](int i, int j, int k) { return (k * cells.y() + j) * cells.x() + i; };
  cell_begin_.assign(index_of(0, 0, cells.z()) + 1, 0);
  std::vector<int>& entries = cell_entries_;
  entries.resize(points.rows());
  const auto cell_of_point = [&](int i) {
    const Vector3d p = points.row(i).transpose();
    return index_of(std::min(cell_of(p, 0), cells.x() - 1), std::min(cell_of(p, 1), cells.y() - 1),
                    std::min(cell_of(p, 2), cells.z() - 1));
  };
  for (int i = 0; i < points.rows(); ++i) ++cell_begin_[cell_of_point(i)];
  int sum = 0;
  for (int& begin : cell_begin_) sum += begin, begin = sum;  // ends of the cells; filling makes them beginnings
  for (int i = static_cast<int>(points.rows()); i-- > 0;) entries[--cell_begin_[cell_of_point(i)]] = i;
  for (const int v : free_) {
    const Vector3d& p = x_[v];
    double best = cell * cell;
    const int ci = cell_of(p, 0), cj = cell_of(p, 1), ck = cell_of(p, 2);
    const int i_begin = std::max(ci - 1, 0), i_end = std::min(ci + 2, cells.x());
    for (int k = std::max(ck - 1, 0); k < std::min(ck + 2, cells.z()); ++k) {
      for (int j = std::max(cj - 1, 0); j < std::min(cj + 2, cells.y()) && i_begin < i_end; ++j) {
        const int end = cell_begin_[index_of(i_end - 1, j, k) + 1];
        for (int e = cell_begin_[index_of(i_begin, j, k)]; e < end; ++e) {
          const double d = (points.row(entries[e]).transpose() - p).squaredNorm();
          if (d < best) best = d, nearest_[v] = entries[e];
        }
      }
    }
  }
}

void ClothSimulation::UpdateVertexNormals() {
  std::fill(normal_.begin(), normal_.end(), Vector3d::Zero());
  for (int f = 0; f < mesh_.faces.rows(); ++f) {
    const int a = mesh_.faces(f, 0), b = mesh_.faces(f, 1), c = mesh_.faces(f, 2);
    const Vector3d n = (x_[b] - x_[a]).cross(x_[c] - x_[a]);
    normal_[a] += n, normal_[b] += n, normal_[c] += n;
  }
  for (Vector3d& n : normal_) {
    const double length = n.norm();
    n = length > 1e-12 ? Vector3d(n / length) : Vector3d::Zero();
  }
}

void ClothSimulation::FindPierced() {
  std::fill(off_.begin(), off_.end(), Vector3d::Zero());
  for (const Capsule& capsule : obstacles_.capsules) {
    if (capsule.belongs != ClothSide::kInside) continue;
    const Vector3d along = capsule.b - capsule.a;
    ForEachCrossedFace(mesh_.faces, x_, capsule.a, capsule.b, [&](int f) {
      const Vector3d &p = x_[mesh_.faces(f, 0)], &q = x_[mesh_.faces(f, 1)], &r = x_[mesh_.faces(f, 2)];
      const bool outwards = (q - p).cross(r - p).dot(along) > 0;
      const Vector3d way = (outwards ? along : Vector3d(-along)).normalized(), middle = (p + q + r) / 3;
      for (const int v : free_) {
        if ((x_[v] - middle).squaredNorm() < kFreed_m * kFreed_m) off_[v] = way;
      }
    });
  }
}

void ClothSimulation::PredictVertices(double h) {
  const double keep = std::exp(-h * options_.damping);
  for (const int i : free_) {
    Vector3d& v = v_[i];
    v = keep * (v + h * options_.gravity);
    const double scale = 0.5 * options_.air_density * area_[i] * inverse_mass_[i] * h;
    const Vector3d v_n = normal_[i].dot(v) * normal_[i], v_t = v - v_n;
    v -= std::min(1.0, scale * options_.drag_normal * v_n.norm()) * v_n +
         std::min(1.0, scale * options_.drag_tangential * v_t.norm()) * v_t;
    const double speed = v.norm();
    if (speed > options_.max_speed) v *= options_.max_speed / speed;
    x_[i] += options_.pass_speed * h * off_[i];
    before_[i] = x_[i];
    x_[i] += h * v;
    contact_[i].depth_m = 0;
  }
}

void ClothSimulation::SolveLinks(double h) {
  const double per_h2 = 1 / (h * h);
  for (const ClothLink& link : mesh_.links) {
    const double w_a = inverse_mass_[link.a], w_b = inverse_mass_[link.b];
    if (w_a + w_b == 0) continue;
    const Vector3d d = x_[link.a] - x_[link.b];
    const double length = d.norm();
    if (length < 1e-12) continue;
    const Vector3d step = (link.rest_m - length) / (length * (w_a + w_b + link.compliance * per_h2)) * d;
    x_[link.a] += w_a * step;
    x_[link.b] -= w_b * step;
  }
}

void ClothSimulation::SolveTethers() {
  for (const ClothTether& tether : mesh_.tethers) {
    if (inverse_mass_[tether.vertex] == 0) continue;
    const Vector3d d = x_[tether.vertex] - x_[tether.anchor];
    const double length = d.norm();
    if (length > tether.length_m) x_[tether.vertex] -= (1 - tether.length_m / length) * d;
  }
}

void ClothSimulation::Touch(int vertex, const Vector3d& normal, double depth_m, const Vector3d& obstacle_velocity) {
  x_[vertex] += depth_m * normal;
  contact_[vertex] = {normal, obstacle_velocity, depth_m};
}

bool ClothSimulation::LetsThrough(int vertex, ClothSide belongs, const Vector3d& away) const {
  if (belongs == ClothSide::kInside) return !off_[vertex].isZero();
  return belongs == ClothSide::kOutside && normal_[vertex].dot(away) > kInnerSide;
}

void ClothSimulation::WalkToNearest(int vertex) {
  int& at = nearest_[vertex];
  double best = (points_now_.row(at).transpose() - x_[vertex]).squaredNorm();
  for (int steps = 0; steps < 8; ++steps) {
    int next = at;
    for (int e = neighbour_begin_[at]; e < neighbour_begin_[at + 1]; ++e) {
      const double d = (points_now_.row(neighbour_[e]).transpose() - x_[vertex]).squaredNorm();
      if (d < best) best = d, next = neighbour_[e];
    }
    if (next == at) break;
    at = next;
  }
}

void ClothSimulation::SolveCapsules(const ClothObstacles& next, bool yielding, double fraction, double dt) {
  const double thickness = options_.thickness_m;
  for (size_t c = 0; c < next.capsules.size(); ++c) {
    if (next.capsules[c].yields != yielding) continue;
    const Capsule &from = obstacles_.capsules[c], &to = next.capsules[c];
    const Capsule now = {from.a + fraction * (to.a - from.a), from.b + fraction * (to.b - from.b),
                         from.radius_a + fraction * (to.radius_a - from.radius_a),
                         from.radius_b + fraction * (to.radius_b - from.radius_b)};
    const double reach = std::max(now.radius_a, now.radius_b) + thickness;
    const Vector3d low = (now.a.cwiseMin(now.b)).array() - reach, high = (now.a.cwiseMax(now.b)).array() + reach;
    for (const int v : free_) {
      const Vector3d& p = x_[v];
      if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) continue;
      Vector3d away;
      double along;
      const double depth = thickness - CapsuleDistance(now, p, &away, &along);
      if (depth <= 0 || LetsThrough(v, to.belongs, away)) continue;
      Touch(v, away, depth, ((1 - along) * (to.a - from.a) + along * (to.b - from.b)) / dt);
    }
  }
}

void ClothSimulation::SolveSurface(const ClothObstacles& next, double fraction, double dt) {
  const double thickness = options_.thickness_m;
  for (const int v : free_) {
    if (nearest_[v] < 0) continue;
    WalkToNearest(v);
    const int i = nearest_[v];
    const Vector3d d = x_[v] - points_now_.row(i).transpose();
    if (d.squaredNorm() > options_.search_m * options_.search_m) continue;
    const Vector3d normal =
        (obstacles_.normals.row(i) + float(fraction) * (next.normals.row(i) - obstacles_.normals.row(i)))
            .transpose()
            .cast<double>()
            .normalized();
    const double depth = thickness - normal.dot(d);
    if (depth <= 0) continue;
    if (!next.belongs.empty() && LetsThrough(v, next.belongs[i], normal)) continue;
    Touch(v, normal, depth, (next.points.row(i) - obstacles_.points.row(i)).transpose() / dt);
  }
}

void ClothSimulation::SolveFloor() {
  if (!options_.floor) return;
  for (const int v : free_) {
    const double depth = options_.thickness_m - options_.floor->up.dot(x_[v] - options_.floor->point);
    if (depth > 0) Touch(v, options_.floor->up, depth, Vector3d::Zero());
  }
}

void ClothSimulation::UpdateVelocities(double h) {
  for (const int i : free_) {
    v_[i] = (x_[i] - before_[i]) / h;
    const Contact& contact = contact_[i];
    if (contact.depth_m <= 0) continue;
    const Vector3d relative = v_[i] - contact.obstacle_velocity;
    const double leaving = contact.normal.dot(relative);
    const Vector3d sliding = relative - leaving * contact.normal;
    const double speed = sliding.norm(), maximum = options_.friction * contact.depth_m / h;
    v_[i] = contact.obstacle_velocity + std::min(leaving, 0.0) * contact.normal;
    if (speed > maximum) v_[i] += (1 - maximum / speed) * sliding;
  }
}

void ClothSimulation::Step(double dt, ClothObstacles obstacles, const std::vector<Vector3d>& pinned) {
  BODYLOOM_CHECK(dt > 0 && dt <= 10, "cloth: a step of ", dt, " s, expected up to 10 s");
  BODYLOOM_CHECK(pinned.size() == pinned_.size() && AllFinite(pinned), "cloth: ", pinned.size(),
                 " places of pinned vertices, expected ", pinned_.size(), ", finite");
  CheckObstacles(obstacles);
  const int substeps = std::max(1, static_cast<int>(std::ceil(dt / options_.substep_s - 1e-9)));
  const double h = dt / substeps;
  std::vector<Vector3d> pinned_from;
  for (const int v : pinned_) pinned_from.push_back(x_[v]);
  FindNearestPoints();
  UpdateVertexNormals();
  FindPierced();
  for (int s = 1; s <= substeps; ++s) {
    const double fraction = double(s) / substeps;
    PredictVertices(h);
    for (size_t i = 0; i < pinned_.size(); ++i) {
      before_[pinned_[i]] = x_[pinned_[i]];
      x_[pinned_[i]] = pinned_from[i] + fraction * (pinned[i] - pinned_from[i]);
      v_[pinned_[i]] = (pinned[i] - pinned_from[i]) / dt;
    }
    points_now_ = obstacles_.points + fraction * (obstacles.points - obstacles_.points);
    SolveCapsules(obstacles, true, fraction, dt);
    SolveLinks(h);
    SolveTethers();
    SolveCapsules(obstacles, false, fraction, dt);
    SolveSurface(obstacles, fraction, dt);
    SolveFloor();
    UpdateVelocities(h);
  }
  obstacles_ = std::move(obstacles);
}

int CrossingsOfSegment(const MatrixX3i& faces, const std::vector<Vector3d>& positions, const Vector3d& a,
                       const Vector3d& b) {
  int crossings = 0;
  ForEachCrossedFace(faces, positions, a, b, [&](int) { ++crossings; });
  return crossings;
}

double LargestStretch(const ClothMesh& mesh, const std::vector<Vector3d>& positions) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const ClothLink& link : mesh.links) {
    if (link.compliance > 0 || link.rest_m <= 0) continue;
    largest = std::max(largest, (positions[link.a] - positions[link.b]).norm() / link.rest_m - 1);
  }
  return largest;
}

int LegsThroughCloth(const MatrixX3i& faces, const std::vector<Vector3d>& cloth, const MatrixX3d& joints) {
  int through = 0;
  for (const int hip : {1, 2}) {
    int crossings = 0;
    for (const int from : {hip, hip + 3}) {
      crossings += CrossingsOfSegment(faces, cloth, joints.row(from).transpose(), joints.row(from + 3).transpose());
    }
    through += crossings % 2;
  }
  return through;
}

double LargestDepth(const std::vector<Vector3d>& cloth, const ClothObstacles& obstacles) {
  constexpr double kReach_m = 0.06;
  double deepest = 0;
  for (const Vector3d& p : cloth) {
    Eigen::Index nearest;
    const double distance2 = (obstacles.points.rowwise() - p.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    if (distance2 > kReach_m * kReach_m) continue;
    const Vector3d d = p - obstacles.points.row(nearest).transpose();
    deepest = std::max(deepest, -obstacles.normals.row(nearest).cast<double>().dot(d));
  }
  return deepest;
}

}  // namespace bodyloom
