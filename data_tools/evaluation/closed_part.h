// SPDX-License-Identifier: Apache-2.0
/// Some faces of a mesh as a solid: boundary loops are closed by fans about their mean, and what lies inside is told by
/// the winding number.
///
/// Winding number of a point: faces that the ray from it in direction z of the frame below crosses from inside, minus
/// those crossed from outside. For a closed surface it is a whole number that no choice of ray changes; 0 is outside.
/// An edge belongs to the one side that its two end points, taken in the order of their numbers, decide, so a ray that
/// hits an edge still crosses one of its faces. All of it happens in a frame that is turned by an arbitrary angle
/// against the caller's, so that meshes aligned with the axes are no special case.
///
/// Faces are sorted into a grid across the ray: a query looks at those of one cell. Distances: a face's centre lies on
/// it, so the nearest centre bounds the distance, and a face is looked at closely only where its centre is within that
/// bound plus the largest radius of a face; no face is missed.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// Squared distance of a point to a triangle, edges and corners included.
double SquaredDistanceToTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c);

/// A rotation by no special angle about no special axis.
const Eigen::Matrix3d& GenericRotation();

/// Not for use by two threads at once.
class ClosedPart {
 public:
  /// `faces` of the mesh `mesh_faces`; those with a corner twice are left out.
  ClosedPart(const MatrixX3i& mesh_faces, const std::vector<int>& faces);

  /// Where the mesh's vertices are now: times GenericRotation(), metres. Borrowed until the next call.
  void Place(const MatrixX3d& turned_vertices);

  /// Of the placed faces and fans, in the turned frame.
  [[nodiscard]] const Eigen::Vector3d& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector3d& high() const { return high_; }

  /// Whether the winding number of a point of the turned frame is not 0. On the surface: either.
  [[nodiscard]] bool Contains(const Eigen::Vector3d& p);
  /// Distance to the nearest of the faces; fans do not count.
  [[nodiscard]] double Distance(const Eigen::Vector3d& p);

  [[nodiscard]] bool empty() const { return faces_.empty(); }

 private:
  struct Face {
    int corner[3];  ///< of points_
  };
  void SortIntoGrid();
  void FindCentres();
  [[nodiscard]] int CellOf(double value, int axis) const;
  /// +1, −1 or 0: whether the ray crosses the face, and from which side.
  [[nodiscard]] int Crossing(const Face& face, const Eigen::Vector3d& p) const;

  std::vector<int> vertex_;              ///< of the mesh, by point; the fans' means follow
  std::vector<std::vector<int>> loops_;  ///< points of each boundary loop
  std::vector<Face> faces_;              ///< the faces, then the fans
  size_t num_skin_ = 0;                  ///< faces before the fans

  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero(), high_ = Eigen::Vector3d::Zero();
  bool has_grid_ = false, has_centres_ = false;
  int cells_ = 1;  ///< along x and y
  std::vector<int> cell_begin_, cell_face_;
  std::vector<float> centre_x_, centre_y_, centre_z_;
  double largest_radius_ = 0;
};

}  // namespace bodyloom
