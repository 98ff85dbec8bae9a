// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/export/usda_writer.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "bodyloom/data_tools/export/skinned_mesh.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/camera_path.h"

namespace bodyloom {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

constexpr double kAperture_mm = 36, kUsdLongestGap = 1.5;

std::string Number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.7g", value);
  return text;
}

/// "(a, b, c)"
template <typename Row>
std::string Tuple(const Row& row) {
  std::string text = "(";
  for (Eigen::Index k = 0; k < row.size(); ++k) text += (k > 0 ? ", " : "") + Number(double(row[k]));
  return text + ")";
}

/// "[x, y, …]" of n elements that `element` writes.
template <typename Element>
std::string List(size_t n, const Element& element) {
  std::string text = "[";
  for (size_t i = 0; i < n; ++i) text += (i > 0 ? ", " : "") + element(i);
  return text + "]";
}

template <typename Matrix>
std::string RowsText(const Matrix& rows) {
  return List(size_t(rows.rows()), [&](size_t i) { return Tuple(rows.row(Eigen::Index(i))); });
}

std::string Quoted(const std::string& text) { return "\"" + text + "\""; }

/// USD multiplies rows: the transpose of the column matrix.
std::string MatrixText(const Matrix4d& matrix) {
  return "(" + Tuple(matrix.col(0)) + ", " + Tuple(matrix.col(1)) + ", " + Tuple(matrix.col(2)) + ", " +
         Tuple(matrix.col(3)) + ")";
}

Matrix4d At(const Vector3d& place, const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity()) {
  Matrix4d matrix = Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = rotation;
  matrix.topRightCorner<3, 1>() = place;
  return matrix;
}

class PersonText {
 public:
  PersonText(const ExportScene& scene, const ExportPerson& person, int correctives)
      : scene_(scene), person_(person), mesh_(MakeSkinnedMesh(person, correctives)) {
    const BodyModel& body = *person.body;
    for (int j = 0; j < body.num_joints(); ++j) {
      const int parent = body.parents()[j];
      paths_.push_back((parent < 0 ? "" : paths_[size_t(parent)] + "/") + body.data().joint_names[j]);
      offsets_.push_back((person.rest_joints.row(j) -
                          (parent < 0 ? Eigen::RowVector3d::Zero().eval() : person.rest_joints.row(parent).eval()))
                             .transpose());
    }
    joints_ = List(paths_.size(), [&](size_t j) { return Quoted(paths_[j]); });
    shapes_ = List(mesh_.shapes.size(), [](size_t k) { return Quoted("corrective_" + std::to_string(k)); });
  }

  [[nodiscard]] std::string Text() const {
    return "    def SkelRoot " + Quoted(person_.name) +
           " (\n        prepend apiSchemas = [\"SkelBindingAPI\"]\n    )\n    {\n" +
           "        float3[] extent = " + RowsText(Extent()) + "\n" + Visibility() + Skeleton() + Animation() + Mesh() +
           "    }\n";
  }

 private:
  /// A time sample for every frame of the person.
  template <typename Value>
  std::string Samples(const Value& value) const {
    std::string text = "{\n";
    for (size_t t = 0; t < person_.poses.size(); ++t) {
      text += "                " + Number(person_.seconds[t] * scene_.fps) + ": " + value(t) + ",\n";
    }
    return text + "            }\n";
  }

  [[nodiscard]] MatrixX3d Extent() const {
    MatrixX3d extent(2, 3);
    extent.row(0).setConstant(1e9);
    extent.row(1).setConstant(-1e9);
    const double reach = mesh_.positions.rowwise().norm().maxCoeff() * 2;
    for (const BodyPose& pose : person_.poses) {
      const Eigen::RowVector3d root = person_.rest_joints.row(0) + pose.trans.transpose();
      extent.row(0) = extent.row(0).cwiseMin((root.array() - reach).matrix());
      extent.row(1) = extent.row(1).cwiseMax((root.array() + reach).matrix());
    }
    return extent;
  }

  [[nodiscard]] std::string Visibility() const {
    std::vector<std::pair<double, bool>> keys;
    const std::vector<double>& seconds = person_.seconds;
    const double step = 1 / scene_.fps;
    if (seconds.front() > 0.5 * step) keys.emplace_back(0, false);
    keys.emplace_back(seconds.front(), true);
    for (size_t t = 1; t < seconds.size(); ++t) {
      if (seconds[t] - seconds[t - 1] <= kUsdLongestGap * step) continue;
      keys.emplace_back(seconds[t - 1] + 0.5 * step, false);
      keys.emplace_back(seconds[t], true);
    }
    if (seconds.back() < scene_.duration_s - 0.5 * step) keys.emplace_back(seconds.back() + 0.5 * step, false);
    if (keys.size() < 2) return "";
    std::string text = "        token visibility.timeSamples = {\n";
    for (const auto& [at, seen] : keys) {
      text += "            " + Number(at * scene_.fps) + ": " + (seen ? "\"inherited\"" : "\"invisible\"") + ",\n";
    }
    return text + "        }\n";
  }

  [[nodiscard]] std::string Skeleton() const {
    std::string text =
        "        def Skeleton \"skeleton\" (\n            prepend apiSchemas = [\"SkelBindingAPI\"]\n        )\n       "
        " {\n";
    text += "            uniform token[] joints = " + joints_ + "\n";
    text += "            uniform matrix4d[] bindTransforms = " +
            List(paths_.size(),
                 [&](size_t j) { return MatrixText(At(person_.rest_joints.row(Eigen::Index(j)).transpose())); }) +
            "\n";
    text += "            uniform matrix4d[] restTransforms = " +
            List(paths_.size(), [&](size_t j) { return MatrixText(At(offsets_[j])); }) + "\n";
    text += "            rel skel:animationSource = </scene/" + person_.name + "/motion>\n        }\n\n";
    return text;
  }

  [[nodiscard]] std::string Animation() const {
    std::string text =
        "        def SkelAnimation \"motion\"\n        {\n            uniform token[] joints = " + joints_ + "\n";
    std::vector<Eigen::Quaterniond> before(paths_.size(), Eigen::Quaterniond::Identity());
    text += "            quatf[] rotations.timeSamples = " + Samples([&](size_t t) {
              return List(paths_.size(), [&](size_t j) {
                Eigen::Quaterniond q(person_.poses[t].rotations[j]);
                q.normalize();
                if (q.dot(before[j]) < 0) q.coeffs() *= -1;
                before[j] = q;
                return Tuple(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
              });
            });
    text += "            float3[] translations.timeSamples = " + Samples([&](size_t t) {
              return List(paths_.size(), [&](size_t j) {
                return Tuple(j == 0 ? Vector3d(offsets_[0] + person_.poses[t].trans) : offsets_[j]);
              });
            });
    text +=
        "            half3[] scales = " + List(paths_.size(), [](size_t) { return std::string("(1, 1, 1)"); }) + "\n";
    if (!mesh_.shapes.empty()) {
      text += "            uniform token[] blendShapes = " + shapes_ + "\n";
      text += "            float[] blendShapeWeights.timeSamples = " + Samples([&](size_t t) {
                return List(mesh_.shapes.size(),
                            [&](size_t k) { return Number(mesh_.shape_weights(Eigen::Index(t), Eigen::Index(k))); });
              });
    }
    return text + "        }\n\n";
  }

  [[nodiscard]] std::string Mesh() const {
    const std::string in = "            ";
    const size_t n = mesh_.body_vertex.size();
    std::string text =
        "        def Mesh \"body\" (\n            prepend apiSchemas = [\"SkelBindingAPI\"]\n        )\n        {\n";
    text += in + "uniform token subdivisionScheme = \"none\"\n";
    text += in + "point3f[] points = " + RowsText(mesh_.positions) + "\n";
    text += in + "normal3f[] normals = " + RowsText(mesh_.normals) + " (\n" + in + "    interpolation = \"vertex\"\n" +
            in + ")\n";
    if (mesh_.uv.rows() > 0) {
      text += in + "texCoord2f[] primvars:st = " + RowsText(mesh_.uv) + " (\n" + in +
              "    interpolation = \"vertex\"\n" + in + ")\n";
    }
    text += in +
            "int[] faceVertexCounts = " + List(size_t(mesh_.faces.rows()), [](size_t) { return std::string("3"); }) +
            "\n";
    text += in + "int[] faceVertexIndices = " +
            List(size_t(mesh_.faces.size()), [&](size_t i) { return std::to_string(mesh_.faces.data()[i]); }) + "\n";
    text += in + "rel skel:skeleton = </scene/" + person_.name + "/skeleton>\n";
    text += in + "matrix4d primvars:skel:geomBindTransform = " + MatrixText(Matrix4d::Identity()) + "\n";
    const std::string meta =
        " (\n" + in + "    elementSize = 4\n" + in + "    interpolation = \"vertex\"\n" + in + ")\n";
    text += in + "int[] primvars:skel:jointIndices = " +
            List(4 * n, [&](size_t i) { return std::to_string(mesh_.joints[i / 4][i % 4]); }) + meta;
    text += in + "float[] primvars:skel:jointWeights = " +
            List(4 * n, [&](size_t i) { return Number(mesh_.weights[i / 4][i % 4]); }) + meta;
    if (!mesh_.shapes.empty()) {
      const std::string path = "/scene/" + person_.name + "/body/corrective_";
      text += in + "uniform token[] skel:blendShapes = " + shapes_ + "\n";
      text += in + "rel skel:blendShapeTargets = " +
              List(mesh_.shapes.size(), [&](size_t k) { return "<" + path + std::to_string(k) + ">"; }) + "\n\n";
    }
    for (size_t k = 0; k < mesh_.shapes.size(); ++k) {
      text += in + "def BlendShape \"corrective_" + std::to_string(k) + "\"\n" + in + "{\n" + in +
              "    uniform vector3f[] offsets = " + RowsText(mesh_.shapes[k]) + "\n" + in + "}\n";
    }
    return text + "        }\n";
  }

  const ExportScene& scene_;
  const ExportPerson& person_;
  const SkinnedMesh mesh_;
  std::vector<std::string> paths_;
  std::vector<Vector3d> offsets_;
  std::string joints_, shapes_;
};

/// A time sample for every key of a camera that moves.
std::string UsdCameraMotion(const ExportScene& scene) {
  std::string text = "        matrix4d xformOp:transform.timeSamples = {\n";
  for (const ExportCameraKey& key : scene.camera_keys) {
    const CameraPose world_from_camera = Inverse(key.camera_from_world);
    const Eigen::Matrix3d rotation = world_from_camera.camera_from_world_rotation * Vector3d(1, -1, -1).asDiagonal();
    text += "            " + Number(key.seconds * scene.fps) + ": " +
            MatrixText(At(world_from_camera.camera_from_world_translation, rotation)) + ",\n";
  }
  return text + "        }\n";
}

/// Focal length and aperture are tenths of the scene's unit in name, and only their ratio counts: here millimetres of a
/// picture that is 36 mm wide.
std::string UsdCamera(const ExportScene& scene) {
  const Camera& camera = scene.camera;
  if (camera.model != CameraModel::kPinhole || camera.width <= 0 || camera.height <= 0) return "";
  const double mm = kAperture_mm / camera.width;
  const Eigen::Matrix3d rotation = scene.world.rotation * Vector3d(1, -1, -1).asDiagonal();
  std::string text = "    def Camera \"camera\"\n    {\n";
  text += "        float focalLength = " + Number(camera.fx * mm) + "\n";
  text += "        float horizontalAperture = " + Number(kAperture_mm) + "\n";
  text += "        float verticalAperture = " + Number(camera.height * mm * camera.fx / camera.fy) + "\n";
  text += "        float horizontalApertureOffset = " + Number(((camera.width - 1) / 2.0 - camera.cx) * mm) + "\n";
  text += "        float verticalApertureOffset = " +
          Number((camera.cy - (camera.height - 1) / 2.0) * mm * camera.fx / camera.fy) + "\n";
  text += "        float2 clippingRange = (0.01, 1000)\n";
  text += "        matrix4d xformOp:transform = " + MatrixText(At(scene.world.translation, rotation)) + "\n";
  if (!scene.camera_keys.empty()) text += UsdCameraMotion(scene);
  return text + "        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n    }\n";
}

}  // namespace

std::string UsdaText(const ExportScene& scene, int correctives) {
  BODYLOOM_CHECK(!scene.people.empty(), "USD: nobody to write");
  const std::string fps = Number(scene.fps);
  std::string text = "#usda 1.0\n(\n    defaultPrim = \"scene\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n";
  text += "    startTimeCode = 0\n    endTimeCode = " + Number(scene.duration_s * scene.fps) + "\n";
  text += "    timeCodesPerSecond = " + fps + "\n    framesPerSecond = " + fps + "\n)\n\n";
  text += "def Xform \"scene\" (\n    kind = \"component\"\n)\n{\n";
  for (const ExportPerson& person : scene.people) text += PersonText(scene, person, correctives).Text();
  return text + UsdCamera(scene) + "}\n";
}

void WriteUsda(const std::string& path, const ExportScene& scene, int correctives) {
  WriteFileAtomically(path, UsdaText(scene, correctives));
}

}  // namespace bodyloom
