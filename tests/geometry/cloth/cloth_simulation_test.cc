// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_simulation.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace bodyloom::cloth_simulation_test {
namespace {

using Eigen::Vector3d;

/// A sheet of n×n vertices in the plane y = 0, links along both ways and diagonals; the first row pinned on request.
struct Sheet {
  ClothMesh mesh;
  std::vector<Vector3d> places;
  std::vector<Vector3d> pins;
};

Sheet MakeSheet(int n, double side_m, bool pinned, const Vector3d& corner = Vector3d::Zero()) {
  Sheet sheet;
  const double step = side_m / (n - 1);
  const auto id = [n](int i, int j) { return i * n + j; };
  sheet.mesh.mass_kg.assign(n * n, 0);
  sheet.mesh.faces.resize(2 * (n - 1) * (n - 1), 3);
  int f = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      sheet.places.emplace_back(corner + Vector3d(j * step, 0, i * step));
      if (pinned && i == 0) sheet.pins.push_back(sheet.places.back());
      if (i > 0) sheet.mesh.links.push_back({id(i - 1, j), id(i, j), step, 0});
      if (j > 0) sheet.mesh.links.push_back({id(i, j - 1), id(i, j), step, 0});
      if (i > 0 && j > 0) {
        sheet.mesh.links.push_back({id(i - 1, j - 1), id(i, j), step * std::sqrt(2.0), 0.1});
        sheet.mesh.links.push_back({id(i - 1, j), id(i, j - 1), step * std::sqrt(2.0), 0.1});
        sheet.mesh.faces.row(f++) << id(i - 1, j - 1), id(i, j - 1), id(i, j);
        sheet.mesh.faces.row(f++) << id(i - 1, j - 1), id(i, j), id(i - 1, j);
      }
    }
  }
  for (f = 0; f < sheet.mesh.faces.rows(); ++f) {  // 0.25 kg/m², shared by the corners
    for (int c = 0; c < 3; ++c) sheet.mesh.mass_kg[sheet.mesh.faces(f, c)] += 0.25 * step * step / 6;
  }
  for (int j = 0; j < n && pinned; ++j) sheet.mesh.mass_kg[id(0, j)] = 0;
  return sheet;
}

ClothOptions InVacuum() {
  ClothOptions options;
  options.damping = 0, options.air_density = 0;
  return options;
}

double KineticAndPotential(const ClothSimulation& s, const ClothOptions& options) {
  double energy = 0;
  for (int v = 0; v < s.mesh().num_vertices(); ++v) {
    energy += s.mesh().mass_kg[v] * (0.5 * s.velocities()[v].squaredNorm() - options.gravity.dot(s.positions()[v]));
  }
  return energy;
}

Vector3d Mean(const std::vector<Vector3d>& points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : points) sum += p;
  return sum / double(points.size());
}

TEST(ClothSimulation, FreeClothFallsAsGTSquaredHalf) {
  const Sheet sheet = MakeSheet(9, 0.4, false);
  ClothSimulation s(sheet.mesh, sheet.places, {}, {}, InVacuum());
  for (int i = 0; i < 30; ++i) s.Step(1.0 / 60, {}, {});
  const Vector3d fallen = Mean(s.positions()) - Mean(sheet.places);
  // Steps of h fall by ½ g t (t + h).
  EXPECT_NEAR(fallen.y(), -0.5 * 9.81 * 0.5 * (0.5 + 1.0 / 480), 1e-9);
  EXPECT_NEAR(fallen.head<1>().norm() + std::abs(fallen.z()), 0, 1e-12);
  EXPECT_LT(std::abs(LargestStretch(sheet.mesh, s.positions())), 1e-9);
}

TEST(ClothSimulation, AirHoldsBackWhatFallsFlat) {
  const Sheet sheet = MakeSheet(9, 0.4, false);
  ClothOptions options;
  options.damping = 0;
  ClothSimulation s(sheet.mesh, sheet.places, {}, {}, options);
  for (int i = 0; i < 120; ++i) s.Step(1.0 / 60, {}, {});
  // ½ ρ c v² = (mass an area) · g, reached as tanh(g t / v); what is read is slowed after each step, by g h.
  const double terminal = std::sqrt(2 * 0.25 * 9.81 / (1.2 * 1.1));
  for (const Vector3d& v : s.velocities()) EXPECT_NEAR(-v.y(), terminal - 9.81 / 480, 2e-3);
}

TEST(ClothSimulation, APendulumSwingsAtItsPeriod) {
  // One vertex on one link: T = 2π √(l/g) (1 + θ²/16).
  ClothMesh mesh;
  mesh.mass_kg = {0, 0.001};
  mesh.links = {{0, 1, 0.5, 0}};
  const double angle = 0.2;
  const std::vector<Vector3d> start = {Vector3d::Zero(), Vector3d(0.5 * std::sin(angle), -0.5 * std::cos(angle), 0)};
  ClothSimulation s(mesh, start, {}, {}, InVacuum());
  double time = 0, crossing = 0, before = start[1].x();
  int crossings = 0;
  while (crossings < 6 && time < 10) {
    s.Step(1.0 / 240, {}, {Vector3d::Zero()});
    time += 1.0 / 240;
    const double x = s.positions()[1].x();
    if ((x < 0) != (before < 0)) ++crossings, crossing = time - (1.0 / 240) * std::abs(x) / std::abs(x - before);
    before = x;
  }
  const double period = 2 * M_PI * std::sqrt(0.5 / 9.81) * (1 + angle * angle / 16);
  EXPECT_NEAR(crossing, 5.5 / 2 * period, 0.01 * period);
  EXPECT_NEAR(s.positions()[1].norm(), 0.5, 1e-4);
}

TEST(ClothSimulation, HangsDownAtItsLengthAndComesToRest) {
  Sheet sheet = MakeSheet(13, 0.5, true);
  ClothSimulation s(sheet.mesh, sheet.places, {}, {});
  for (int i = 0; i < 1200; ++i) s.Step(1.0 / 60, {}, sheet.pins);
  EXPECT_LT(LargestStretch(sheet.mesh, s.positions()), 0.03);
  for (int j = 0; j < 13; ++j) {
    EXPECT_NEAR(s.positions()[12 * 13 + j].y(), -0.5, 0.015) << j;
    EXPECT_NEAR(s.positions()[12 * 13 + j].z(), 0, 0.03) << j;
  }
  double fastest = 0;
  for (const Vector3d& v : s.velocities()) fastest = std::max(fastest, v.norm());
  EXPECT_LT(fastest, 0.1);
}

TEST(ClothSimulation, EnergyDoesNotGrow) {
  const Sheet sheet = MakeSheet(11, 0.5, true);
  const ClothOptions options = InVacuum();
  ClothSimulation s(sheet.mesh, sheet.places, {}, {}, options);
  const double at_start = KineticAndPotential(s, options);
  double total_mass = 0;
  for (const double m : sheet.mesh.mass_kg) total_mass += m;
  const double scale = total_mass * 9.81 * 0.5;  // what is set free by falling
  double highest = at_start;
  for (int i = 0; i < 600; ++i) {
    s.Step(1.0 / 60, {}, sheet.pins);
    highest = std::max(highest, KineticAndPotential(s, options));
  }
  EXPECT_LT(highest - at_start, 0.02 * scale);
  EXPECT_LT(KineticAndPotential(s, options), at_start);
}

TEST(ClothSimulation, TethersLimitWhatLinksCannot) {
  // A long chain with far too few sweeps for its length.
  ClothMesh mesh;
  std::vector<Vector3d> places;
  for (int i = 0; i <= 200; ++i) {
    mesh.mass_kg.push_back(i == 0 ? 0 : 0.001);
    places.emplace_back(0, -0.01 * i, 0);
    if (i > 0) mesh.links.push_back({i, i - 1, 0.01, 1e-3});
  }
  const auto length = [&](const ClothMesh& m) {
    ClothSimulation s(m, places, {}, {});
    for (int i = 0; i < 240; ++i) s.Step(1.0 / 60, {}, {Vector3d::Zero()});
    return s.positions().back().norm();
  };
  EXPECT_GT(length(mesh), 2.1);
  for (int i = 1; i <= 200; ++i) mesh.tethers.push_back({i, 0, 0.0101 * i});
  EXPECT_LT(length(mesh), 2.0201);
}

TEST(ClothSimulation, CapsuleDistanceIsExact) {
  const Capsule capsule = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), 0.1, 0.3};
  Vector3d away;
  double along;
  EXPECT_NEAR(CapsuleDistance(capsule, {0.5, 0.7, 0}, &away, &along), 0.5, 1e-12);
  EXPECT_NEAR(along, 0.5, 1e-12);
  EXPECT_NEAR((away - Vector3d::UnitY()).norm(), 0, 1e-12);
  EXPECT_NEAR(CapsuleDistance(capsule, {-0.5, 0, 0}, &away, &along), 0.4, 1e-12);
  EXPECT_NEAR(CapsuleDistance(capsule, {1, 0, 0.1}, &away, &along), -0.2, 1e-12);
  EXPECT_NEAR(CapsuleDistance(capsule, {0.25, 0, 0}, &away, &along), -0.15, 1e-12);  // on the axis: any way out
  EXPECT_NEAR(away.norm(), 1, 1e-12);
  EXPECT_NEAR(away.x(), 0, 1e-12);
}

/// A sheet that falls on a capsule which then moves sideways and up.
TEST(ClothSimulation, StaysOutsideOfMovingCapsules) {
  const Sheet sheet = MakeSheet(21, 0.6, false, Vector3d(-0.3, 0.2, -0.3));
  ClothOptions options;
  ClothObstacles at;
  at.capsules = {{Vector3d(-0.2, 0, 0), Vector3d(0.2, 0, 0), 0.1, 0.15}};
  ClothSimulation s(sheet.mesh, sheet.places, at, {}, options);
  double deepest = 0;
  for (int i = 0; i < 240; ++i) {
    const double t = i / 60.0;
    at.capsules[0].a.z() = at.capsules[0].b.z() = 0.1 * std::sin(3 * t);
    at.capsules[0].a.y() = at.capsules[0].b.y() = 0.05 * std::sin(5 * t);
    s.Step(1.0 / 60, at, {});
    for (const Vector3d& p : s.positions()) {
      Vector3d away;
      double along;
      deepest = std::max(deepest, options.thickness_m - CapsuleDistance(at.capsules[0], p, &away, &along));
    }
  }
  EXPECT_LT(deepest, 1e-9);
  EXPECT_GT(Mean(s.positions()).y(), -0.4) << "friction and shape hold it on the capsule";
}

/// A ball as a mesh, seen point by point.
ClothObstacles Ball(const Vector3d& centre, double radius, MatrixX3i* faces) {
  constexpr int kRings = 24, kSides = 48;
  ClothObstacles ball;
  ball.points.resize(kRings * kSides, 3), ball.normals.resize(kRings * kSides, 3);
  faces->resize(2 * (kRings - 1) * kSides, 3);
  for (int r = 0, f = 0; r < kRings; ++r) {
    for (int k = 0; k < kSides; ++k) {
      const double polar = M_PI * (r + 0.5) / kRings, azimuth = 2 * M_PI * k / kSides;
      const Vector3d n(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
      ball.points.row(r * kSides + k) = (centre + radius * n).transpose();
      ball.normals.row(r * kSides + k) = n.cast<float>().transpose();
      if (r + 1 == kRings) continue;
      const int a = r * kSides + k, b = r * kSides + (k + 1) % kSides;
      faces->row(f++) << a, b, a + kSides;
      faces->row(f++) << b, b + kSides, a + kSides;
    }
  }
  return ball;
}

TEST(ClothSimulation, StaysOutsideOfASurface) {
  const Sheet sheet = MakeSheet(21, 0.5, false, Vector3d(-0.25, 0.2, -0.25));
  MatrixX3i faces;
  ClothObstacles ball = Ball(Vector3d::Zero(), 0.15, &faces);
  ClothSimulation s(sheet.mesh, sheet.places, ball, faces);
  double deepest = -1;
  for (int i = 0; i < 120; ++i) {
    const Vector3d centre(0.05 * std::sin(0.1 * i), 0, 0);
    ball = Ball(centre, 0.15, &faces);
    s.Step(1.0 / 60, ball, {});
    for (const Vector3d& p : s.positions()) deepest = std::max(deepest, 0.15 - (p - centre).norm());
  }
  EXPECT_LT(deepest, 0) << "never below the surface, of which 8 mm are kept";
  EXPECT_GT(s.positions()[220].y(), 0.1) << "the middle still lies on top";
}

TEST(ClothSimulation, NothingFallsThroughTheFloor) {
  const Sheet sheet = MakeSheet(9, 0.3, false, Vector3d(0, 0.5, 0));
  ClothOptions options;
  options.floor = FloorPlane{Vector3d(3, 0.1, 2), Vector3d::UnitY()};
  ClothSimulation s(sheet.mesh, sheet.places, {}, {}, options);
  for (int i = 0; i < 120; ++i) {
    s.Step(1.0 / 60, {}, {});
    for (const Vector3d& p : s.positions()) ASSERT_GE(p.y(), 0.1 + options.thickness_m - 1e-12);
  }
  EXPECT_NEAR(Mean(s.positions()).y(), 0.1 + options.thickness_m, 0.01);
}

TEST(ClothSimulation, PinnedVerticesArriveAndJerksStayFinite) {
  const Sheet sheet = MakeSheet(11, 0.5, true);
  ClothOptions options;
  ClothSimulation s(sheet.mesh, sheet.places, {}, {}, options);
  std::vector<Vector3d> pins = sheet.pins;
  for (int i = 0; i < 40; ++i) {
    for (Vector3d& p : pins) p += Vector3d(i % 2 == 0 ? 3 : -3, i % 3 == 0 ? 2 : -1, 0);  // 60 m/s and more
    s.Step(i % 2 == 0 ? 0.2 : 1.0 / 60, {}, pins);
    for (int j = 0; j < 11; ++j) EXPECT_EQ(s.positions()[j], pins[j]);
    for (const Vector3d& p : s.positions()) ASSERT_TRUE(p.allFinite());
  }
  for (int i = 0; i < 300; ++i) s.Step(1.0 / 60, {}, pins);
  EXPECT_LT(LargestStretch(sheet.mesh, s.positions()), 0.05) << "it finds its shape again";
}

TEST(ClothSimulation, CrossingsOfASegmentAreCounted) {
  const Sheet sheet = MakeSheet(5, 0.4, false);  // [0, 0.4] × [0, 0.4] in the plane y = 0
  const auto crossings = [&](const Vector3d& a, const Vector3d& b) {
    return CrossingsOfSegment(sheet.mesh.faces, sheet.places, a, b);
  };
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const double x = 0.0103 + 0.019 * i, z = 0.0141 + 0.019 * j;
      EXPECT_EQ(crossings({x, 0.3, z}, {x + 0.003, -0.2, z - 0.002}), 1);
      EXPECT_EQ(crossings({x, 0.3, z}, {x, 0.01, z}), 0) << "ends above";
      EXPECT_EQ(crossings({x, 0.1, z}, {x + 0.3, 0.1, z}), 0) << "along it";
      EXPECT_EQ(crossings({x + 0.41, 0.3, z}, {x + 0.41, -0.3, z}), 0) << "beside it";
    }
  }
}

TEST(ClothSimulation, AnArmHoldsTheOuterSideAlone) {
  const Sheet outer_up = MakeSheet(21, 0.6, false, Vector3d(-0.3, 0.12, -0.3));
  Sheet outer_down = outer_up;
  outer_down.mesh.faces.col(1).swap(outer_down.mesh.faces.col(2));
  for (const ClothSide belongs : {ClothSide::kOutside, ClothSide::kAnywhere, ClothSide::kInside}) {
    for (const bool inner_touches : {true, false}) {
      const Sheet& sheet = inner_touches ? outer_up : outer_down;
      ClothObstacles at;
      at.capsules = {{Vector3d(-0.4, 0, 0), Vector3d(0.4, 0, 0), 0.1, 0.1}};
      at.capsules[0].belongs = belongs;
      ClothSimulation s(sheet.mesh, sheet.places, at, {});
      for (int i = 0; i < 60; ++i) s.Step(1.0 / 60, at, {});
      const bool falls = belongs == ClothSide::kOutside && inner_touches;
      if (falls) {
        EXPECT_LT(s.positions()[220].y(), -1);
      } else {
        EXPECT_GT(s.positions()[220].y(), 0.1);
      }
    }
  }
}

/// A tube of cloth that hangs from a ring, around the vertical through 0.
struct Tube {
  ClothMesh mesh;
  std::vector<Vector3d> places, pins;
};

Tube MakeTube(double radius, double length, int rings, int columns) {
  Tube tube;
  const auto id = [columns](int r, int j) { return r * columns + j % columns; };
  tube.mesh.faces.resize(2 * (rings - 1) * columns, 3);
  const double step = length / (rings - 1), side = 2 * radius * std::sin(M_PI / columns);
  for (int r = 0, f = 0; r < rings; ++r) {
    for (int j = 0; j < columns; ++j) {
      const double angle = 2 * M_PI * j / columns;
      tube.places.emplace_back(radius * std::sin(angle), -r * step, radius * std::cos(angle));
      tube.mesh.mass_kg.push_back(r == 0 ? 0 : 0.25 * step * side);
      if (r == 0) {
        tube.pins.push_back(tube.places.back());
        continue;
      }
      tube.mesh.links.push_back({id(r - 1, j), id(r, j), step, 0});
      tube.mesh.links.push_back({id(r, j), id(r, j + 1), side, 0});
      tube.mesh.links.push_back({id(r - 1, j), id(r, j + 1), std::hypot(side, step), 0.1});
      tube.mesh.faces.row(f++) << id(r - 1, j), id(r, j), id(r, j + 1);
      tube.mesh.faces.row(f++) << id(r - 1, j), id(r, j + 1), id(r - 1, j + 1);
    }
  }
  return tube;
}

TEST(ClothSimulation, ALegThatCameThroughComesIn) {
  const Tube tube = MakeTube(0.2, 0.6, 25, 50);
  const auto leg = [](double angle, ClothSide belongs) {
    ClothObstacles at;
    at.capsules = {{Vector3d(0, -0.02, 0), Vector3d(0, -0.8 * std::cos(angle), 0.8 * std::sin(angle)), 0.06, 0.05}};
    at.capsules[0].belongs = belongs;
    return at;
  };
  const auto is_through = [&](const ClothSimulation& s, const ClothObstacles& at) {
    return CrossingsOfSegment(tube.mesh.faces, s.positions(), at.capsules[0].a, at.capsules[0].b) % 2 == 1;
  };
  for (const ClothSide belongs : {ClothSide::kInside, ClothSide::kAnywhere}) {
    ClothObstacles at = leg(0.6, belongs);  // 0.45 m forwards, where the tube ends at 0.2
    ClothSimulation s(tube.mesh, tube.places, at, {});
    EXPECT_TRUE(is_through(s, at));
    for (int i = 0; i < 60; ++i) {
      at = leg(0.6 * (1 - i / 59.0), belongs);
      s.Step(1.0 / 60, at, tube.pins);
    }
    for (int i = 0; i < 60; ++i) s.Step(1.0 / 60, at, tube.pins);
    EXPECT_EQ(is_through(s, at), belongs == ClothSide::kAnywhere) << "pushed out alone, it stays through";
    if (belongs == ClothSide::kInside) {
      EXPECT_LT(LargestStretch(tube.mesh, s.positions()), 0.1);
    }
  }
}

TEST(ClothSimulation, SameBytesEachTime) {
  const auto run = [] {
    const Sheet sheet = MakeSheet(11, 0.5, true);
    MatrixX3i faces;
    const ClothObstacles ball = Ball(Vector3d(0.25, -0.3, 0.2), 0.12, &faces);
    ClothSimulation s(sheet.mesh, sheet.places, ball, faces);
    for (int i = 0; i < 60; ++i) s.Step(1.0 / 60, ball, sheet.pins);
    return s.positions();
  };
  EXPECT_EQ(run(), run());
}

TEST(ClothSimulation, RestartForgetsTheMotion) {
  const Sheet sheet = MakeSheet(9, 0.4, true);
  ClothSimulation fresh(sheet.mesh, sheet.places, {}, {}), used = fresh;
  for (int i = 0; i < 30; ++i) used.Step(1.0 / 60, {}, sheet.pins);
  used.Restart(sheet.places, {});
  fresh.Step(1.0 / 60, {}, sheet.pins), used.Step(1.0 / 60, {}, sheet.pins);
  EXPECT_EQ(fresh.positions(), used.positions());
}

TEST(ClothSimulation, ChecksItsContract) {
  const Sheet sheet = MakeSheet(5, 0.4, true);
  const auto make = [&](const ClothMesh& mesh, std::vector<Vector3d> places, const ClothOptions& options) {
    ClothSimulation s(mesh, std::move(places), {}, {}, options);
  };
  ClothMesh broken = sheet.mesh;
  broken.links.push_back({0, 99, 1, 0});
  EXPECT_THROW(make(broken, sheet.places, {}), std::invalid_argument);
  broken = sheet.mesh, broken.mass_kg[7] = -1;
  EXPECT_THROW(make(broken, sheet.places, {}), std::invalid_argument);
  broken = sheet.mesh, broken.faces(0, 0) = -1;
  EXPECT_THROW(make(broken, sheet.places, {}), std::invalid_argument);
  std::vector<Vector3d> places = sheet.places;
  places[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make(sheet.mesh, places, {}), std::invalid_argument);
  ClothOptions options;
  options.substep_s = 0;
  EXPECT_THROW(make(sheet.mesh, sheet.places, options), std::invalid_argument);
  ClothSimulation s(sheet.mesh, sheet.places, {}, {});
  EXPECT_THROW(s.Step(0, {}, sheet.pins), std::invalid_argument);
  EXPECT_THROW(s.Step(0.1, {}, {}), std::invalid_argument);
  options = {}, options.pass_speed = -1;
  EXPECT_THROW(make(sheet.mesh, sheet.places, options), std::invalid_argument);
  ClothObstacles more;
  more.belongs.resize(3);
  EXPECT_THROW(s.Step(0.1, more, sheet.pins), std::invalid_argument);
  more = {}, more.capsules.resize(1);
  EXPECT_THROW(s.Step(0.1, more, sheet.pins), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::cloth_simulation_test
