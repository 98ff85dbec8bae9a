// SPDX-License-Identifier: Apache-2.0
/// A subset of a mesh's faces as a solid: boundary loops are closed by fans about their mean, and the inside is defined
/// by the winding number.
///
/// Winding number of a point: the number of faces that the ray from it in direction z crosses from inside, minus those
/// crossed from outside. For a closed surface it is an integer independent of the ray; 0 is outside. The side of an
/// edge is computed from its end points in the order of their numbers, so a ray that hits an edge crosses exactly one
/// of its faces. Computations use a frame rotated by an arbitrary angle, so that meshes aligned with the axes are not a
/// special case.
///
/// Faces are sorted into a grid across the ray, and a query tests those of one cell. Distances: the nearest face centre
/// bounds the distance, and a face is tested only if its centre is within that bound plus the largest radius of a face,
/// so none is missed.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// Squared distance of a point to a triangle, edges and corners included.
double SquaredDistanceToTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c);

/// A rotation by an arbitrary fixed angle about an arbitrary axis.
const Eigen::Matrix3d& GenericRotation();

/// Not for use by two threads at once.
class CappedMesh {
 public:
  /// `faces`: indices into `mesh_faces`; those with a repeated corner are left out.
  CappedMesh(const MatrixX3i& mesh_faces, const std::vector<int>& faces);

  /// Sets the mesh's vertices, rotated by GenericRotation(), metres. Borrowed until the next call.
  void Place(const MatrixX3d& turned_vertices);

  /// Bounding box of the placed faces and fans in the rotated frame.
  [[nodiscard]] const Eigen::Vector3d& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector3d& high() const { return high_; }

  /// Returns true if the winding number of a point of the rotated frame is not 0; on the surface, either.
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
  /// +1 or −1 by the side from which the ray crosses the face, 0 if it does not.
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
