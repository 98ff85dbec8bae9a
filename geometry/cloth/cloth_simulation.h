// SPDX-License-Identifier: Apache-2.0
/// Simulates cloth that hangs from pinned vertices and collides with a moving body: position-based dynamics with
/// compliance (XPBD; Macklin, Müller, Chentanez 2016) in short substeps with one sweep each (Macklin et al. 2019).
///
/// A substep of h seconds:
///   v ← e^{−h·damping}(v + h·gravity), air drag, ‖v‖ ≤ max_speed;  x' ← x;  x ← x + h v;  pinned: x ← given position
///   contacts with yielding capsules (arms)
///   every link (a, b, rest l, compliance α), always in the same order (alternating the direction excites vibrations,
///   2 m/s in a skirt at rest):
///     C = ‖x_a − x_b‖ − l,  Δλ = −C / (w_a + w_b + α/h²),  x_a += w_a Δλ n,  x_b −= w_b Δλ n   (w = 1/mass)
///   tethers: ‖x_v − x_anchor‖ ≤ length (long-range attachments: stretch does not accumulate over many links)
///   contacts: x leaves capsules and the body's surface by thickness_m, and the floor
///   v ← (x − x')/h; where there was contact, v loses its component away from the obstacle (being pushed out gives no
///   speed) and, by Coulomb's law, part of its tangential component.
/// Air drag, by vertex of area A and mass m: Δv = −½ρ·A/m·h·(c_n |v_n| v_n + c_t ‖v_t‖ v_t), never more than v itself.
///
/// Contacts with the surface: at the start of a step every vertex finds the nearest surface point within search_m; in
/// each substep it moves on to a nearer neighbour if there is one, and the vertex stays thickness_m above that point's
/// tangent plane. Capsules handle vertices that move too fast for that. There are no self-collisions.
///
/// Sides: a leg belongs inside a skirt, an arm outside. Where the axis of an inside obstacle passes through a face,
/// either the limb has come through or the cloth lies on its wrong side; pushing the cloth out would keep it there. So
/// inside obstacles ignore the cloth around that face, which moves along the axis, in the direction of the face's
/// normal, at pass_speed until the limb is inside again. Outside obstacles ignore the cloth's inner side, so a skirt
/// that has flown over the arms comes down again.
///
/// One thread and a fixed order of links: bitwise reproducible. Finite input gives finite output.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

struct ClothLink {
  int a = 0, b = 0;
  double rest_m = 0;
  double compliance = 0;  ///< metres per newton; 0: inextensible
};

struct ClothTether {
  int vertex = 0, anchor = 0;
  double length_m = 0;
};

struct ClothMesh {
  std::vector<double> mass_kg;  ///< a vertex; 0: pinned
  MatrixX3i faces;              ///< for air drag
  std::vector<ClothLink> links;
  std::vector<ClothTether> tethers;
  [[nodiscard]] int num_vertices() const { return static_cast<int>(mass_kg.size()); }
};

/// Side of the cloth on which an obstacle belongs.
enum class ClothSide { kAnywhere, kInside, kOutside };

/// Capsule of radius radius_a at a and radius_b at b, interpolated in between.
struct Capsule {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();
  double radius_a = 0, radius_b = 0;
  bool yields = false;  ///< resolved before the links: where an arm presses cloth into the body, cloth and body prevail
  ClothSide belongs = ClothSide::kAnywhere;
};

/// Signed distance of a point from the capsule (negative: inside): its distance from the nearest point of the axis,
/// minus the radius there. `away` receives the unit direction outwards, `along` the position on the axis in [0, 1].
double CapsuleDistance(const Capsule& capsule, const Eigen::Vector3d& point, Eigen::Vector3d* away, double* along);

/// Obstacles of the cloth at one instant.
struct ClothObstacles {
  std::vector<Capsule> capsules;
  MatrixX3d points;                ///< of a closed surface
  MatrixX3f normals;               ///< outwards, unit
  std::vector<ClothSide> belongs;  ///< side of each point; empty: kAnywhere
};

struct FloorPlane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), up = Eigen::Vector3d::UnitY();
};

struct ClothOptions {
  Eigen::Vector3d gravity = Eigen::Vector3d(0, -9.81, 0);
  double substep_s = 1.0 / 480;  ///< upper bound
  double thickness_m = 0.008;    ///< kept between cloth and body
  double search_m = 0.06;        ///< surface points nearer than this are considered
  double friction = 0.3;         ///< Coulomb's coefficient
  double damping = 0.6;          ///< 1/s
  double air_density = 1.2;      ///< kg/m³; 0: no drag
  double drag_normal = 1.1, drag_tangential = 0.05;
  double max_speed = 20;            ///< m/s
  double pass_speed = 1.5;          ///< m/s, of cloth that moves back through a limb
  std::optional<FloorPlane> floor;  ///< nothing falls below it
  [[nodiscard]] bool IsValid(std::string* why) const;
};

class ClothSimulation {
 public:
  /// `start`: a position per vertex. `surface_faces`: faces between the obstacles' points, to find neighbours. Throws
  /// std::invalid_argument for indices out of range, sizes that differ, values that are not finite or options out of
  /// range.
  ClothSimulation(ClothMesh mesh, std::vector<Eigen::Vector3d> start, ClothObstacles obstacles,
                  const MatrixX3i& surface_faces, const ClothOptions& options = {});

  /// Advances by dt seconds, while obstacles and pinned vertices move along straight lines from their last positions to
  /// `obstacles` and `pinned` (positions of the vertices with mass 0, by index). Throws std::invalid_argument when the
  /// numbers of obstacles or pinned vertices change or a value is not finite.
  void Step(double dt, ClothObstacles obstacles, const std::vector<Eigen::Vector3d>& pinned);

  /// Resets positions and obstacles, at rest.
  void Restart(std::vector<Eigen::Vector3d> positions, ClothObstacles obstacles);

  /// Sets the damping of later steps, 1/s. Throws std::invalid_argument when it is negative or not finite.
  void set_damping(double damping);

  [[nodiscard]] const ClothMesh& mesh() const { return mesh_; }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& positions() const { return x_; }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& velocities() const { return v_; }

 private:
  struct Contact {
    Eigen::Vector3d normal, obstacle_velocity;
    double depth_m = 0;
  };
  void CheckObstacles(const ClothObstacles& obstacles) const;
  void FindNearestPoints();
  void WalkToNearest(int vertex);
  void UpdateVertexNormals();
  void FindPierced();
  void PredictVertices(double h);
  void SolveLinks(double h);
  void SolveTethers();
  void Touch(int vertex, const Eigen::Vector3d& normal, double depth_m, const Eigen::Vector3d& obstacle_velocity);
  bool LetsThrough(int vertex, ClothSide belongs, const Eigen::Vector3d& away) const;
  void SolveCapsules(const ClothObstacles& next, bool yielding, double fraction, double dt);
  void SolveSurface(const ClothObstacles& next, double fraction, double dt);
  void SolveFloor();
  void UpdateVelocities(double h);

  ClothMesh mesh_;
  ClothOptions options_;
  std::vector<double> inverse_mass_, area_;
  std::vector<int> pinned_, free_;
  std::vector<Eigen::Vector3d> x_, before_, v_, normal_;
  std::vector<Contact> contact_;
  std::vector<Eigen::Vector3d> off_;  ///< around pierced faces: unit direction off the limb; else 0
  ClothObstacles obstacles_;
  MatrixX3d points_now_;  ///< at the current substep
  std::vector<int> neighbour_begin_, neighbour_, nearest_;
  std::vector<int> cell_begin_, cell_entries_;  ///< scratch of FindNearestPoints
};

/// Number of faces that the segment from a to b passes through: odd when one end is inside a tube of cloth, the other
/// is not, and the segment does not leave through an opening.
int CrossingsOfSegment(const MatrixX3i& faces, const std::vector<Eigen::Vector3d>& positions, const Eigen::Vector3d& a,
                       const Eigen::Vector3d& b);

/// Largest ‖x_a − x_b‖ / rest − 1 over the links that do not stretch.
double LargestStretch(const ClothMesh& mesh, const std::vector<Eigen::Vector3d>& positions);

// Measures of penetration: legs through the cloth, depth of the cloth inside the body.

/// Number of legs that have come through the cloth's faces: those whose line from hip over knee to ankle (joints J×3)
/// crosses them an odd number of times. A leg that stays inside, or leaves by the hem, is not counted.
int LegsThroughCloth(const MatrixX3i& faces, const std::vector<Eigen::Vector3d>& cloth, const MatrixX3d& joints);

/// Largest depth of the cloth inside the clothed body, metres (0: none inside): the signed distance of each cloth
/// vertex to the tangent plane of the nearest point of trunk and legs, where that is within 6 cm.
double LargestDepth(const std::vector<Eigen::Vector3d>& cloth, const ClothObstacles& obstacles);

}  // namespace bodyloom
