// SPDX-License-Identifier: Apache-2.0
/// USD text, read back by a reader of the test's own.
#include "bodyloom/data_tools/export/usda_writer.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "bodyloom/geometry/camera_path.h"
#include "tests/data_tools/export/exported_scene.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

/// The numbers of a list whose brackets may be nested.
std::vector<double> UsdList(std::string list) {
  for (char& c : list) {
    if (c == '(' || c == ')' || c == ',') c = ' ';
  }
  std::istringstream stream(list);
  std::vector<double> numbers;
  for (double x = 0; stream >> x;) numbers.push_back(x);
  return numbers;
}

/// Numbers of "key = [...]" or of one time sample of it.
std::vector<double> UsdNumbers(const std::string& text, const std::string& key, int sample = -1) {
  size_t at = text.find(key);
  EXPECT_NE(at, std::string::npos) << key;
  if (sample >= 0) {
    at = text.find('{', at);
    for (int i = 0; i <= sample; ++i) at = text.find(": [", at + 1);
  }
  const size_t begin = text.find('[', text.find(sample >= 0 ? ": " : "= ", at)), end = text.find(']', begin);
  return UsdList(text.substr(begin + 1, end - begin - 1));
}

/// The matrix of one time sample: "11: ( (…), (…), (…), (…) )".
std::vector<double> UsdMatrixSample(const std::string& text, const std::string& key, int sample) {
  size_t at = text.find(key);
  EXPECT_NE(at, std::string::npos) << key;
  at = text.find('{', at);
  for (int i = 0; i <= sample; ++i) at = text.find(": (", at + 1);
  return UsdList(text.substr(at + 2, text.find('\n', at) - at - 2));
}

TEST(UsdaWriter, ACameraThatMovesHasASampleOfEveryFrame) {
  const Track track = ShortTrack(6, SynthCameraMotion::kHandHeld);
  const ExportScene scene = SceneOf(track);
  const std::string text = UsdaText(scene, 0);
  const std::vector<double> m = UsdMatrixSample(text, "matrix4d xformOp:transform.timeSamples", 11);
  ASSERT_EQ(m.size(), 16U) << "of frame 11";
  EXPECT_EQ(UsdaText(SceneOf(ShortTrack()), 0).find("xformOp:transform.timeSamples"), std::string::npos);
  const Vector3d place(m[12], m[13], m[14]);
  EXPECT_LT((place - CentreOf(scene.camera_keys[11].camera_from_world)).norm(), 1e-5);
  // Rows of the transposed matrix are the camera's axes in the world: −z is where it looks.
  const Vector3d ahead = scene.camera_keys[11].camera_from_world.camera_from_world_rotation.row(2).transpose();
  EXPECT_LT((Vector3d(m[8], m[9], m[10]) + ahead).norm(), 1e-5);
}

TEST(UsdaWriter, PosesTheBodyWhereItIs) {
  const Track track = TrackWithAGap();
  const std::string text = UsdaText(SceneOf(track), 8);
  EXPECT_THAT(text, ::testing::StartsWith("#usda 1.0\n"));
  EXPECT_THAT(text, ::testing::HasSubstr("metersPerUnit = 1\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  EXPECT_THAT(text, ::testing::HasSubstr("2.5: \"invisible\""));
  std::vector<double> points = UsdNumbers(text, "point3f[] points");
  const std::vector<double> weights = UsdNumbers(text, "blendShapeWeights.timeSamples", 3);
  for (size_t k = 0; k < weights.size(); ++k) {
    const std::string shape = text.substr(text.find("def BlendShape \"corrective_" + std::to_string(k)));
    const std::vector<double> offsets = UsdNumbers(shape, "offsets");
    for (size_t i = 0; i < points.size(); ++i) points[i] += weights[k] * offsets[i];
  }
  const std::vector<double> q = UsdNumbers(text, "rotations.timeSamples", 3);
  const std::vector<double> translations = UsdNumbers(text, "translations.timeSamples", 3);
  const std::vector<double> bind = UsdNumbers(text, "bindTransforms"), rest = UsdNumbers(text, "restTransforms");
  const std::vector<double> joints = UsdNumbers(text, "jointIndices"), skin = UsdNumbers(text, "jointWeights");
  std::vector<Eigen::Affine3d> skinning, posed;
  for (size_t j = 0; j < 24; ++j) {
    Eigen::Affine3d local = Eigen::Affine3d::Identity();
    local.translation() = Vector3d(translations[3 * j], translations[3 * j + 1], translations[3 * j + 2]);
    local.linear() = Eigen::Quaterniond(q[4 * j], q[4 * j + 1], q[4 * j + 2], q[4 * j + 3]).toRotationMatrix();
    const int parent = SmplParents()[j];
    posed.push_back(parent < 0 ? local : posed[size_t(parent)] * local);
    EXPECT_EQ(bind[16 * j], 1);
    const Vector3d place(bind[16 * j + 12], bind[16 * j + 13], bind[16 * j + 14]);
    skinning.push_back(posed.back() * Eigen::Translation3d(-place));
    if (j > 0) {
      EXPECT_NEAR(rest[16 * j + 12], translations[3 * j], 1e-6);
    }
  }
  const MatrixX3d truth = VerticesInWorld(track, 5);
  double farthest = 0;
  for (size_t v = 0; v < size_t(truth.rows()); ++v) {
    const Vector3d p(points[3 * v], points[3 * v + 1], points[3 * v + 2]);
    Vector3d at = Vector3d::Zero();
    for (size_t k = 0; k < 4; ++k) at += skin[4 * v + k] * (skinning[size_t(joints[4 * v + k])] * p);
    farthest = std::max(farthest, (at - truth.row(Eigen::Index(v)).transpose()).norm());
  }
  EXPECT_LT(farthest, 1e-3);
}
}  // namespace
}  // namespace bodyloom
