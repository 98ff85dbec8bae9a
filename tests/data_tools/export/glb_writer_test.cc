// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/glb_writer.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "data_tools/export/skinned_mesh.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/data_tools/export/exported_scene.h"
#include "tests/data_tools/export/gltf_twin.h"

namespace bodyloom::glb_writer_test {
namespace {

/// Largest distance between the file's vertices and the body's, where `key` shows frame t.
double Farthest(const GltfTwin& file, const ExportPerson& person, const Track& track, int key, int t) {
  const Eigen::MatrixXd posed = file.Pose(file.Node("person_0_body"), key);
  const MatrixX3d truth = VerticesInWorld(track, t);
  const SkinnedMesh mesh = MakeSkinnedMesh(person, 0);  // for who is whom
  EXPECT_EQ(posed.rows(), Eigen::Index(mesh.body_vertex.size()));
  double farthest = 0;
  for (Eigen::Index v = 0; v < posed.rows(); ++v) {
    farthest = std::max(farthest, (posed.row(v) - truth.row(mesh.body_vertex[size_t(v)])).norm());
  }
  return farthest;
}

TEST(GlbWriter, PosesTheBodyWhereItIs) {
  const Track track = TrackWithAGap();
  const ExportScene scene = SceneOf(track);
  SkinSummary with, without;
  const GltfTwin file(GlbText(scene, {}, &with)), plain(GlbText(scene, {.correctives = 0}, &without));
  ASSERT_EQ(track.num_frames(), 12);
  for (const auto& [key, t] : {std::pair(0, 0), std::pair(3, 5), std::pair(9, 11)}) {
    EXPECT_LT(Farthest(file, scene.people[0], track, key, t), 1e-3);
    EXPECT_LT(Farthest(file, scene.people[0], track, key, t), with.max_error_m + 2e-6);
    EXPECT_LT(Farthest(plain, scene.people[0], track, key, t), without.max_error_m + 2e-6);
  }
  EXPECT_GT(without.max_error_m, 2 * with.max_error_m) << "correctives are worth it";
  EXPECT_GT(with.shapes, 0);
  EXPECT_LE(with.shapes, 8);
  EXPECT_EQ(without.shapes, 0);
  EXPECT_FALSE(plain.json["meshes"][0]["primitives"][0].contains("targets"));
}

TEST(GlbWriter, PosesTheFingers) {
  const BodyModel& body = BuiltinBodyWithHands();
  const Track track = TrackWithHands();
  const ExportScene scene = SceneOf(track, body);
  SkinSummary summary;
  const GltfTwin file(GlbText(scene, {.correctives = 12}, &summary));
  EXPECT_EQ(summary.reduced_vertices, 0) << "no vertex has more than four joints";
  EXPECT_LT(summary.max_error_m, 2e-5);
  EXPECT_EQ(file.json["skins"][0]["joints"].size(), 52U);
  const Eigen::MatrixXd posed = file.Pose(file.Node("person_0_body"), 7);
  const MatrixX3d truth = VerticesInWorld(track, 7, body);
  const SkinnedMesh mesh = MakeSkinnedMesh(scene.people[0], 0);
  for (Eigen::Index v = 0; v < posed.rows(); ++v) {
    ASSERT_LT((posed.row(v) - truth.row(mesh.body_vertex[size_t(v)])).norm(), 3e-5) << v;
  }
  const Eigen::MatrixXd q = file.Keys(file.Node("r_middle2"), "rotation", true);
  ASSERT_EQ(q.rows(), 12);
  const Eigen::Quaterniond expected(
      RotationFromAxisAngle(track.motion.poses.row(5).segment<3>(3 * body.FindJoint("r_middle2")).transpose()));
  EXPECT_NEAR(std::abs(q.row(5).dot(expected.coeffs().transpose())), 1, 1e-6);
}

TEST(GlbWriter, EnoughShapesAreExact) {
  const Track track = TrackWithAGap();
  const ExportScene scene = SceneOf(track);
  SkinSummary summary;
  const GltfTwin file(GlbText(scene, {.correctives = 10}, &summary));  // as many as there are frames
  EXPECT_LT(summary.max_error_m, 2e-5);
  EXPECT_LT(Farthest(file, scene.people[0], track, 7, 9), 3e-5);
}

TEST(GlbWriter, KeysAreTheTracksAndSignsDoNotJump) {
  const Track track = TrackWithAGap();
  const ExportScene scene = SceneOf(track);
  SkinSummary summary;
  const GltfTwin file(GlbText(scene, {}, &summary));
  const int pelvis = file.Node("pelvis"), elbow = file.Node("l_elbow");
  const Eigen::MatrixXd times = file.Keys(pelvis, "translation", false);
  ASSERT_EQ(times.rows(), 10);
  EXPECT_EQ(times(0, 0), 0) << "the clip begins at once";
  EXPECT_NEAR(times(3, 0), 5 / 6.0, 1e-6);
  const Eigen::MatrixXd q = file.Keys(elbow, "rotation", true);
  for (Eigen::Index t = 1; t < q.rows(); ++t) EXPECT_GT(q.row(t).dot(q.row(t - 1)), 0);
  const Eigen::MatrixXd seen = file.Keys(pelvis, "scale", true), when = file.Keys(pelvis, "scale", false);
  ASSERT_EQ(seen.rows(), 3) << "there, lost, there";
  EXPECT_EQ(seen.col(0), Eigen::Vector3d(1, 0, 1));
  EXPECT_NEAR(when(1, 0), 2.5 / 6, 1e-6);
  EXPECT_NEAR(when(2, 0), 5 / 6.0, 1e-6);
}

TEST(GlbWriter, CameraSeesWhatTheClipsDid) {
  const Track track = TrackWithAGap();
  const ExportScene scene = SceneOf(track);
  SkinSummary summary;
  const GltfTwin file(GlbText(scene, {}, &summary));
  const nlohmann::json camera = file.json["cameras"][0]["perspective"];
  const Eigen::Matrix4d view = file.Global(file.Node("camera"), 0).inverse();
  const Eigen::MatrixXd posed = file.Pose(file.Node("person_0_body"), 0);
  const BodyPose pose =
      PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(0).transpose(), track.motion.trans.row(0).transpose());
  const MatrixX3d truth = PoseVertices(BuiltinBody(), track.motion.betas, pose);
  const double f = 0.5 * track.camera.height / std::tan(camera["yfov"].get<double>() / 2);
  for (const int v : {0, 1000, 5000}) {
    const Eigen::Vector4d p = view * Eigen::Vector4d(posed(v, 0), posed(v, 1), posed(v, 2), 1);
    Eigen::Vector2d px;
    ASSERT_TRUE(track.camera.Project(truth.row(v).transpose(), &px));
    EXPECT_NEAR(track.camera.cx + f * p.x() / -p.z(), px.x(), 0.3);
    EXPECT_NEAR(track.camera.cy - f * p.y() / -p.z(), px.y(), 0.3);
  }
}

TEST(GlbWriter, ACameraThatMovesSeesEveryFrame) {
  const Track track = ShortTrack(6, SynthCameraMotion::kWalking);
  const ExportScene scene = SceneOf(track);
  SkinSummary summary;
  const GltfTwin file(GlbText(scene, {}, &summary));
  const double f =
      0.5 * track.camera.height / std::tan(file.json["cameras"][0]["perspective"]["yfov"].get<double>() / 2);
  for (const int t : {0, 4, 11}) {
    EXPECT_NEAR(file.Keys(file.Node("camera"), "translation", false)(t, 0), scene.people[0].seconds[size_t(t)], 1e-6);
    const Eigen::Matrix4d view = file.Global(file.Node("camera"), t).inverse();
    const Eigen::MatrixXd posed = file.Pose(file.Node("person_0_body"), t);
    const BodyPose pose =
        PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
    const MatrixX3d seen =
        MovedPoints(track.camera_from_scene[size_t(t)], PoseVertices(BuiltinBody(), track.motion.betas, pose));
    for (const int v : {0, 1000, 5000}) {
      const Eigen::Vector4d p = view * Eigen::Vector4d(posed(v, 0), posed(v, 1), posed(v, 2), 1);
      Eigen::Vector2d px;
      ASSERT_TRUE(track.camera.Project(seen.row(v).transpose(), &px));
      EXPECT_NEAR(track.camera.cx + f * p.x() / -p.z(), px.x(), 0.3);
      EXPECT_NEAR(track.camera.cy - f * p.y() / -p.z(), px.y(), 0.3);
    }
  }
}

TEST(GlbWriter, TwoPeopleShareOneAnimation) {
  const Track first = TrackWithAGap();
  Track second = ShortTrack();
  for (double& time : second.motion.timestamps) time += 1.5;  // comes later
  const std::array<const BodyModel*, 2> bodies = {&BuiltinBody(), &BuiltinBody()};
  const std::array<const Track*, 2> tracks = {&first, &second};
  SkinSummary summary;
  const GltfTwin file(GlbText(MakeExportScene(bodies, tracks, TiltedWorld()), {}, &summary));
  EXPECT_EQ(file.json["animations"].size(), 1U);
  EXPECT_EQ(file.json["skins"].size(), 2U);
  const int pelvis = file.json["skins"][1]["joints"][0];
  EXPECT_NEAR(file.Keys(pelvis, "translation", false)(0, 0), 1, 1e-6);
  EXPECT_EQ(file.Keys(pelvis, "scale", true)(0, 0), 0);
}

TEST(GlbWriter, RefusesWhatIsNoImage) {
  const Track track = TrackWithAGap();
  SkinSummary summary;
  EXPECT_THROW(GlbText(SceneOf(track), {.textures = {"JFIF"}}, &summary), std::invalid_argument);
  EXPECT_THROW(GlbText(SceneOf(track), {.correctives = 65}, &summary), std::invalid_argument);
  const GltfTwin file(GlbText(SceneOf(track), {.textures = {"\x89PNG and so on"}}, &summary));
  EXPECT_EQ(file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
  EXPECT_EQ(file.json["images"][0]["mimeType"], "image/png");
}

TEST(SkinnedMesh, KeepsSeamsAndWeights) {
  const ExportScene scene = SceneOf(TrackWithAGap());
  const SkinnedMesh mesh = MakeSkinnedMesh(scene.people[0], 8);
  const BodyModelData& body = BuiltinBody().data();
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(mesh.body_vertex[size_t(mesh.faces(f, k))], body.faces(f, k));
      ASSERT_EQ(mesh.uv.row(mesh.faces(f, k)), body.vt.row(body.ft(f, k)));
    }
  }
  for (const auto& weights : mesh.weights) {
    EXPECT_NEAR(double(weights[0]) + weights[1] + weights[2] + weights[3], 1, 1e-7);
    for (const float w : weights) EXPECT_GE(w, 0);
  }
  EXPECT_GE(mesh.shape_weights.minCoeff(), 0);
  EXPECT_LE(mesh.shape_weights.maxCoeff(), 1);
}

}  // namespace
}  // namespace bodyloom::glb_writer_test
