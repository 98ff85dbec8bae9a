// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "data_tools/body/body_io.h"
#include "data_tools/body/builtin_body.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"

namespace bodyloom::python {
namespace {

constexpr const char* kBodyDoc = R"(A parametric body of the SMPL family: V vertices, J joints, B shape components.

Body.builtin() is this project's own (24 joints of SMPL, 7,874 vertices); Body.load() reads SMPL, SMPL-H and SMPL-X.
Body frame: x to the body's left, y up, z to the front, metres. Bodies do not change; arrays are views.)";

constexpr const char* kBodyLoadDoc =
    R"(The body in a file: SMPL, SMPL-H or SMPL-X (the official .pkl or .npz), or this project's own.

`max_betas` keeps so many shape components (0: all); `flat_hand_mean` leaves the hands of SMPL-H and SMPL-X flat at
zero, as AMASS motions expect. Nothing in a .pkl is run. Raises RuntimeError naming file, array and expectation.)";

constexpr const char* kVerticesDoc =
    R"(The surface in every frame: (T, V, 3) float64, metres, in the frame of the poses.

poses     (T, 3J) axis-angle in radians; fewer columns leave the remaining joints at rest
trans     (T, 3) metres; None: zero
betas     (B,) or fewer shape components; None: the mean shape
vertices  which vertices, in this order; None: all
threads   0: one a core; the values are the same for any number

A frame whose pose or place is not finite is NaN. The surface is computed in float relative to the root joint, within
1e-6 m. Raises ValueError naming the argument, the shape found and the one expected.)";

constexpr const char* kJointsDoc =
    R"(The joints in every frame: (T, J, 3) float64, metres; arguments as of vertices().)";

constexpr int kFramesAtOnce = 256;  // between two looks at Ctrl-C

struct PosesGiven {
  std::vector<BodyPose> poses;
  Eigen::VectorXd betas;
};

/// A pose that is not finite has rotations that are not.
BodyPose PoseOrNan(const BodyModel& body, const Eigen::VectorXd& axis_angle, const Eigen::Vector3d& trans) {
  if (axis_angle.allFinite() && trans.allFinite()) return PoseFromAxisAngle(body, axis_angle, trans);
  BodyPose pose;
  pose.rotations.assign(size_t(body.num_joints()), Eigen::Matrix3d::Constant(std::nan("")));
  pose.trans.setConstant(std::nan(""));
  return pose;
}

PosesGiven PosesFrom(const BodyModel& body, const py::object& poses, const py::object& trans, const py::object& betas) {
  const auto angles = NumbersFrom<double>(poses, "poses", {"T", "3J"});
  const py::ssize_t T = angles.shape(0), columns = angles.shape(1);
  BODYLOOM_CHECK(columns % 3 == 0 && columns <= 3 * body.num_joints(), "poses: expected numbers of shape (T, ",
                 3 * body.num_joints(), ") or fewer joints, found shape (", T, ", ", columns, ")");
  RowMajorArray<double> places;
  if (!trans.is_none()) places = NumbersFrom<double>(trans, "trans", {T, 3});
  PosesGiven given;
  if (!betas.is_none()) given.betas = VectorFrom(betas, "betas", "B");
  BODYLOOM_CHECK(given.betas.size() <= body.num_betas(), "betas: expected at most ", body.num_betas(),
                 " shape components, found ", given.betas.size());
  BODYLOOM_CHECK(given.betas.allFinite(), "betas: holds numbers that are not finite");
  given.poses.reserve(size_t(T));
  for (py::ssize_t t = 0; t < T; ++t) {
    const Eigen::Map<const Eigen::VectorXd> angles_of_frame(angles.data() + t * columns, columns);
    const Eigen::Vector3d place = trans.is_none() ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                                  : Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(places.data(t)));
    given.poses.push_back(PoseOrNan(body, angles_of_frame, place));
  }
  return given;
}

SkinnerOptions SkinnerOptionsFrom(const BodyModel& body, const py::object& vertices, int threads) {
  CheckThreads(threads);
  SkinnerOptions options;
  options.num_threads = ThreadsFor(threads);
  if (vertices.is_none()) return options;
  const auto chosen = NumbersFrom<double>(vertices, "vertices", {"N"});
  for (py::ssize_t i = 0; i < chosen.size(); ++i) {
    const double vertex = chosen.at(i);
    BODYLOOM_CHECK(vertex >= 0 && vertex < body.num_vertices() && vertex == std::floor(vertex), "vertices: entry ", i,
                   " is ", vertex, ", expected a vertex from 0 to ", body.num_vertices() - 1);
    options.vertices.push_back(int(vertex));
  }
  BODYLOOM_CHECK(!options.vertices.empty(), "vertices: expected at least one, found none");
  return options;
}

py::array VerticesOfPoses(const BodyModel& body, const py::object& poses, const py::object& betas,
                          const py::object& trans, const py::object& vertices, int threads) {
  const PosesGiven given = PosesFrom(body, poses, trans, betas);
  const Skinner skinner(body, SkinnerOptionsFrom(body, vertices, threads));
  const auto T = py::ssize_t(given.poses.size());
  const size_t row = 3 * size_t(skinner.num_vertices());
  py::array_t<double> surface({T, py::ssize_t(skinner.num_vertices()), py::ssize_t(3)});
  double* out = surface.mutable_data();
  PythonCallbacks(py::none()).Run([&](const PipelineCallbacks& callbacks) {
    const ShapedBody shaped = skinner.Shape(given.betas);
    const std::span<const BodyPose> all(given.poses);
    for (size_t t = 0; t < all.size(); t += kFramesAtOnce) {
      callbacks.Update("vertices", double(t) / double(all.size()));
      const std::span<const BodyPose> part = all.subspan(t, std::min<size_t>(kFramesAtOnce, all.size() - t));
      skinner.Skin(shaped, part, {out + t * row, part.size() * row});
    }
  });
  return surface;
}

py::array JointsOfPoses(const BodyModel& body, const py::object& poses, const py::object& betas,
                        const py::object& trans) {
  const PosesGiven given = PosesFrom(body, poses, trans, betas);
  const MatrixX3d rest = body.RestJoints(given.betas);
  py::array_t<double> joints({py::ssize_t(given.poses.size()), py::ssize_t(rest.rows()), py::ssize_t(3)});
  double* out = joints.mutable_data();
  for (const BodyPose& pose : given.poses) {
    const MatrixX3d places = PoseSkeleton(body, rest, pose).joints;
    out = std::copy_n(places.data(), places.size(), out);
  }
  return joints;
}

std::vector<std::string> LandmarksOf(const BodyModel& body) {
  std::vector<std::string> names;
  for (const Landmark& landmark : body.data().landmarks) names.push_back(landmark.name);
  return names;
}

/// A read-only property that views a member of the body's data; no rows where the body has none.
template <typename Member>
auto DataView(Member member) {
  return [member](const py::object& self) { return MatrixView(self.cast<const BodyModel&>().data().*member, self); };
}

py::array ShapedirsOf(const py::object& self) {
  const auto& body = self.cast<const BodyModel&>();
  return View(body.data().shapedirs.data(), {body.num_vertices(), 3, body.num_betas()}, self);
}

}  // namespace

void BindBody(py::module_& module) {
  py::class_<BodyModel, std::shared_ptr<BodyModel>>(module, "Body", kBodyDoc)
      .def_static(
          "builtin",
          [](bool hands) { return std::const_pointer_cast<BodyModel>(BodyOrBuiltin(hands ? kBodyWithHands : "")); },
          py::kw_only(), py::arg("hands") = false, py::call_guard<py::gil_scoped_release>(),
          "The body that ships; built once. hands: with SMPL-H's finger joints, 52 in all (also body=\"hands\").")
      .def_static(
          "load",
          [](const Path& path, int max_betas, bool flat_hand_mean) {
            LoadBodyOptions options;
            options.max_betas = max_betas;
            options.flat_hand_mean = flat_hand_mean;
            BODYLOOM_CHECK(max_betas >= 0, "max_betas: expected 0 or more, found ", max_betas);
            return std::make_shared<BodyModel>(LoadBody(path.string(), options));
          },
          py::arg("path"), py::kw_only(), py::arg("max_betas") = 0, py::arg("flat_hand_mean") = false,
          py::call_guard<py::gil_scoped_release>(), kBodyLoadDoc)
      .def("vertices", &VerticesOfPoses, py::arg("poses"), py::arg("betas") = py::none(), py::arg("trans") = py::none(),
           py::kw_only(), py::arg("vertices") = py::none(), py::arg("threads") = 0, kVerticesDoc)
      .def("joints", &JointsOfPoses, py::arg("poses"), py::arg("betas") = py::none(), py::arg("trans") = py::none(),
           kJointsDoc)
      .def_property_readonly("name", &BodyModel::name, "\"bodyloom\", \"smpl\", \"smplh\", \"smplx\", ...")
      .def_property_readonly("num_vertices", &BodyModel::num_vertices)
      .def_property_readonly("num_joints", &BodyModel::num_joints)
      .def_property_readonly("num_betas", &BodyModel::num_betas)
      .def_property_readonly("joint_names", [](const BodyModel& self) { return self.data().joint_names; })
      .def_property_readonly("landmark_names", &LandmarksOf, "Points that 2D joints are compared with, by name.")
      .def_property_readonly(
          "parents",
          [](const py::object& self) {
            const auto& parents = self.cast<const BodyModel&>().parents();
            return View(parents.data(), {py::ssize_t(parents.size())}, self);
          },
          "(J,) int32 view; the root's is -1.")
      .def_property_readonly("v_template", DataView(&BodyModelData::v_template), "(V, 3) float64 view, metres, T-pose.")
      .def_property_readonly("shapedirs", &ShapedirsOf, "(V, 3, B) float32 view, metres per unit of beta.")
      .def_property_readonly("faces", DataView(&BodyModelData::faces),
                             "(F, 3) int32 view of vertex indices, counter-clockwise seen from outside.")
      .def_property_readonly("vt", DataView(&BodyModelData::vt),
                             "(U, 2) float32 view of UV coordinates, v up; no rows for a body without them.")
      .def_property_readonly("ft", DataView(&BodyModelData::ft),
                             "(F, 3) int32 view of indices into vt; no rows for a body without UV coordinates.")
      .def_property_readonly(
          "rest_joints",
          [](const py::object& self) { return MatrixView(self.cast<const BodyModel&>().joint_template(), self); },
          "(J, 3) float64 view: joints of the mean shape at rest, metres.")
      .def("__repr__", [](const BodyModel& self) {
        return Concatenate("Body(", self.name(), ", ", self.num_vertices(), " vertices, ", self.num_joints(),
                           " joints, ", self.num_betas(), " betas)");
      });
}

}  // namespace bodyloom::python
