// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "data_tools/observations/load_cameras.h"
#include "geometry/base/check.h"
#include "geometry/scene/camera.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/track_object.h"

namespace bodyloom::python {
namespace {

constexpr const char* kCameraDoc =
    R"(How a point in the camera frame (x right, y down, z forward, metres) becomes a pixel.

Camera(width, height, focal_px=F)               a centred pinhole without distortion
Camera(width, height, K=K, distortion=d)        K is (3, 3) in pixels; d has 4, 5 or 8 numbers in OpenCV's order
                                                k1 k2 p1 p2 [k3 [k4 k5 k6]]
Pixel centres lie at integer coordinates, as in OpenCV. Raises ValueError for a size, focal length or K that cannot be.)";

constexpr const char* kCameraLoadDoc =
    R"(A calibrated camera from a file or folder: AIST++, Pose2Sim, a Calib.toml, or this project's JSON.

`view` names it where there are several; `sequence` is the clip's name, by which an AIST++ folder finds its setting.
Raises RuntimeError naming the file, the place and what was expected.)";

Camera MakeCamera(int width, int height, std::optional<double> focal_px, const py::object& K,
                  const py::object& distortion) {
  BODYLOOM_CHECK(width > 0 && height > 0, "image size: expected width and height above 0, found ", width, "x", height);
  BODYLOOM_CHECK(focal_px.has_value() == K.is_none(), "expected focal_px or K, and not both");
  if (focal_px) {
    BODYLOOM_CHECK(*focal_px > 0 && std::isfinite(*focal_px), "focal_px: expected pixels above 0, found ", *focal_px);
    BODYLOOM_CHECK(distortion.is_none(), "distortion: goes with K, found focal_px");
    return MakePinhole(width, height, *focal_px);
  }
  const auto k = NumbersFrom<double>(K, "K", {3, 3});
  Camera camera;
  camera.width = width, camera.height = height;
  camera.fx = k.at(0, 0), camera.fy = k.at(1, 1), camera.cx = k.at(0, 2), camera.cy = k.at(1, 2);
  const bool is_calibration = k.at(0, 1) == 0 && k.at(1, 0) == 0 && k.at(2, 0) == 0 && k.at(2, 1) == 0 &&
                              k.at(2, 2) == 1 && camera.fx > 0 && camera.fy > 0 && camera.K().allFinite();
  BODYLOOM_CHECK(is_calibration, "K: expected [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] with fx and fy above 0");
  if (distortion.is_none()) return camera;
  const Eigen::VectorXd given = VectorFrom(distortion, "distortion", "4, 5 or 8");
  BODYLOOM_CHECK(given.size() == 4 || given.size() == 5 || given.size() == 8,
                 "distortion: expected 4, 5 or 8 numbers, found ", given.size());
  BODYLOOM_CHECK(given.allFinite(), "distortion: holds numbers that are not finite");
  std::copy_n(given.data(), given.size(), camera.distortion.begin());
  return camera;
}

py::array ProjectPoints(const Camera& camera, const py::object& points) {
  const auto in = NumbersFrom<double>(points, "points", {"N", 3});
  py::array_t<double> out({in.shape(0), py::ssize_t(2)});
  for (py::ssize_t i = 0; i < in.shape(0); ++i) {
    Eigen::Vector2d pixel;
    if (!camera.Project(Eigen::Vector3d(in.at(i, 0), in.at(i, 1), in.at(i, 2)), &pixel)) {
      pixel.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    out.mutable_at(i, 0) = pixel.x(), out.mutable_at(i, 1) = pixel.y();
  }
  return out;
}

py::array UnprojectPixels(const Camera& camera, const py::object& pixels) {
  const auto in = NumbersFrom<double>(pixels, "pixels", {"N", 2});
  py::array_t<double> out({in.shape(0), py::ssize_t(2)});
  for (py::ssize_t i = 0; i < in.shape(0); ++i) {
    const Eigen::Vector2d ray = camera.Unproject(Eigen::Vector2d(in.at(i, 0), in.at(i, 1)));
    out.mutable_at(i, 0) = ray.x(), out.mutable_at(i, 1) = ray.y();
  }
  return out;
}

py::array IntrinsicsOf(const Camera& camera) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> K = camera.K();
  return py::array_t<double>({3, 3}, K.data());
}

std::string CameraText(const Camera& camera) {
  return Concatenate("Camera(", ToString(camera.model), ", ", camera.width, "x", camera.height, ", focal length ",
                     camera.fx, " px)");
}

}  // namespace

void BindCamera(py::module_& module) {
  py::class_<Camera>(module, "Camera", kCameraDoc)
      .def(py::init(&MakeCamera), py::arg("width"), py::arg("height"), py::kw_only(), py::arg("focal_px") = py::none(),
           py::arg("K") = py::none(), py::arg("distortion") = py::none())
      .def_static(
          "load",
          [](const Path& path, const std::string& view, const std::string& sequence) {
            return FindCamera(LoadCameras(path.string(), sequence), view, path.string()).camera;
          },
          py::arg("path"), py::kw_only(), py::arg("view") = "", py::arg("sequence") = "",
          py::call_guard<py::gil_scoped_release>(), kCameraLoadDoc)
      .def("project", &ProjectPoints, py::arg("points"),
           "Pixels (N, 2) float64 of points (N, 3) in the camera frame, metres; NaN for points behind the camera and "
           "outside the lens' field of view.")
      .def("unproject", &UnprojectPixels, py::arg("pixels"),
           "Rays (N, 2) float64, x/z and y/z without distortion, of pixels (N, 2); of a weak camera the metric X and "
           "Y.")
      .def_property_readonly(
          "model", [](const Camera& self) { return ToString(self.model); }, "\"pinhole\" or \"weak\".")
      .def_readonly("width", &Camera::width, "Of the image, pixels.")
      .def_readonly("height", &Camera::height, "Of the image, pixels.")
      .def_property_readonly("K", &IntrinsicsOf, "(3, 3) float64: fx, fy, cx, cy in pixels.")
      .def_property_readonly(
          "distortion", [](const Camera& self) { return py::array_t<double>(8, self.distortion.data()); },
          "(8,) float64 in OpenCV's order k1 k2 p1 p2 k3 k4 k5 k6; zeros mean none.")
      .def_property_readonly(
          "weak", [](const Camera& self) { return py::make_tuple(self.scale, self.tx, self.ty); },
          "Of a weak camera (scale in pixels a metre, tx, ty in metres): pixel = scale * (X + tx, Y + ty) + (cx, cy).")
      .def("__repr__", &CameraText);
}

}  // namespace bodyloom::python
