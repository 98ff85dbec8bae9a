// SPDX-License-Identifier: Apache-2.0
/// Files in the form of RICH's and Human3.6M's, whose cameras stand still.
#pragma once

#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "data_tools/formats/zip.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"
#include "tests/data_tools/formats/object_npy_bytes.h"
#include "tests/data_tools/formats/pickle_writer.h"

namespace bodyloom {

/// Rows of numbers as JSON, with brackets around each row if there are several.
inline std::string JsonRows(const RowMatrixXd& rows) {
  std::ostringstream text;
  text << std::setprecision(17) << "[";
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    if (rows.rows() > 1) text << (r > 0 ? ",[" : "[");
    for (Eigen::Index c = 0; c < rows.cols(); ++c) text << (c > 0 ? "," : "") << rows(r, c);
    if (rows.rows() > 1) text << "]";
  }
  return text.str() + "]";
}

/// A camera 5 m from the middle of a room, 1.5 m above its floor (z up), as Human3.6M's stand.
inline NamedCamera RoomCamera(int width = 1000, int height = 1002) {
  NamedCamera named;
  named.name = "1";
  named.has_pose = true;
  named.camera.width = width, named.camera.height = height;
  named.camera.fx = 1145, named.camera.fy = 1144, named.camera.cx = 512, named.camera.cy = 515;
  const Eigen::Vector3d centre(1.9, -4.8, 1.5), forward = -Eigen::Vector3d(1.9, -4.8, 0.4).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d& R = named.pose.camera_from_world_rotation;
  R.row(0) = right.transpose(), R.row(1) = forward.cross(right).transpose(), R.row(2) = forward.transpose();
  named.pose.camera_from_world_translation = -R * centre;
  return named;
}

/// `is_centre`: t is where the camera stands, as in older files.
inline std::string Human36mCameraJson(const NamedCamera& named, bool is_centre) {
  const CameraPose& pose = named.pose;
  const Eigen::Vector3d t =
      is_centre ? Eigen::Vector3d(-pose.camera_from_world_rotation.transpose() * pose.camera_from_world_translation)
                : pose.camera_from_world_translation;
  const Camera& camera = named.camera;
  return "{\"1\": {\"R\": " + JsonRows(pose.camera_from_world_rotation) + ", \"t\": " + JsonRows(1000 * t.transpose()) +
         ", \"f\": " + JsonRows(Eigen::RowVector2d(camera.fx, camera.fy)) +
         ", \"c\": " + JsonRows(Eigen::RowVector2d(camera.cx, camera.cy)) + "}}";
}

/// Action 2, subaction 1, with these joints of frames (metres); frames without rows are left out.
inline std::string Human36mJointsJson(const std::vector<MatrixX3d>& joints) {
  std::string frames;
  for (size_t t = 0; t < joints.size(); ++t) {
    if (joints[t].rows() == 0) continue;
    frames += (frames.empty() ? "\"" : ", \"") + std::to_string(t) + "\": " + JsonRows(1000 * joints[t]);
  }
  return "{\"2\": {\"1\": {" + frames + "}}}";
}

/// Every `step`-th frame of SMPL's motion.
inline std::string Human36mSmplJson(const Motion& motion, int step) {
  std::string frames;
  for (int t = 0; t < motion.num_frames(); t += step) {
    frames += (t > 0 ? ", \"" : "\"") + std::to_string(t) + "\": {\"pose\": " + JsonRows(motion.poses.row(t)) +
              ", \"shape\": " + JsonRows(motion.betas.transpose()) + ", \"trans\": [" + JsonRows(motion.trans.row(t)) +
              "], \"fitted_3d_pose\": [[0, 0, 0]]}";
  }
  return "{\"2\": {\"1\": {" + frames + "}}}";
}

/// positions_3d of S9, "Directions 1": the 17 joints among 32, the others far off.
inline std::string Human36mPositions(const std::vector<MatrixX3d>& joints) {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const std::vector<int> of_32 = {0, 1, 2, 3, 6, 7, 8, 12, 13, 14, 15, 17, 18, 19, 25, 26, 27};
  std::vector<double> values(joints.size() * 32 * 3, 77);
  for (size_t t = 0; t < joints.size(); ++t) {
    for (size_t j = 0; j < of_32.size(); ++j) {
      for (size_t c = 0; c < 3; ++c) {
        values[3 * (32 * t + size_t(of_32[j])) + c] = joints[t](Eigen::Index(j), Eigen::Index(c));
      }
    }
  }
  return Dict({{Str2("S9"), Dict({{Str2("Directions 1"), Doubles2(values, {int(joints.size()), 32, 3})}})}});
}

/// data_3d_h36m.npz.
inline std::string Human36mPositionsNpz(const std::vector<MatrixX3d>& joints) {
  return MakeZip({{"positions_3d.npy", ObjectNpyBytes(Human36mPositions(joints))}}, 0);
}

/// One frame of a subject: the first 66 columns of the pose are SMPL-X's.
inline std::string RichPickle(const Motion& motion, int t) {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const auto row = [](const Eigen::RowVectorXd& numbers) {
    return Doubles2({numbers.data(), numbers.data() + numbers.size()}, {1, int(numbers.size())});
  };
  return Pickle(2, Dict({{Str2("betas"), row(motion.betas.transpose())},
                         {Str2("global_orient"), row(motion.poses.row(t).head(3))},
                         {Str2("body_pose"), row(motion.poses.row(t).segment(3, 63))},
                         {Str2("left_hand_pose"), row(Eigen::RowVectorXd::Constant(12, 0.3))},
                         {Str2("transl"), row(motion.trans.row(t))}}));
}

inline std::string RichXml(const NamedCamera& named) {
  const auto matrix = [](const std::string& name, const RowMatrixXd& values) {
    std::ostringstream text;
    text << std::setprecision(17) << "<" << name << " type_id=\"opencv-matrix\">\n  <rows>" << values.rows()
         << "</rows>\n  <cols>" << values.cols() << "</cols>\n  <dt>d</dt>\n  <data>\n    ";
    for (Eigen::Index i = 0; i < values.size(); ++i) text << values.data()[i] << (i % 4 == 3 ? "\n    " : " ");
    return text.str() + "</data></" + name + ">\n";
  };
  RowMatrixXd extrinsics(3, 4);
  extrinsics << named.pose.camera_from_world_rotation, named.pose.camera_from_world_translation;
  return "<?xml version=\"1.0\"?>\n<opencv_storage>\n<Timestamp>2019</Timestamp>\n" +
         matrix("CameraMatrix", extrinsics) + matrix("Intrinsics", named.camera.K()) +
         matrix("Distortion", Eigen::Map<const RowMatrixXd>(named.camera.distortion.data(), 1, 8)) +
         "</opencv_storage>\n";
}

}  // namespace bodyloom
