// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/fbx_writer.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "data_tools/export/fbx_animation.h"
#include "data_tools/export/rigged_mesh.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/data_tools/export/exported_scene.h"
#include "tests/data_tools/export/fbx_twin.h"

namespace bodyloom::fbx_writer_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kCentimetre_m = 0.01;

/// Largest distance between the file's vertices and the body's, where `key` shows frame t; metres.
double FarthestVertex(const FbxTwin& file, const Track& track, int key, int t) {
  const Eigen::MatrixXd posed = kCentimetre_m * file.Pose(file.Find("person_0_body", "Geometry"), key);
  return (posed - VerticesInWorld(track, t)).rowwise().norm().maxCoeff();
}

/// Largest distance of the joints' models from the body's joints of a frame; metres.
double FarthestJoint(const FbxTwin& file, const ExportPerson& person, AnimationRig rig, int key) {
  const std::vector<std::string> names = FbxJointNames(rig, *person.body);
  const MatrixX3d joints = PoseSkeleton(*person.body, person.rest_joints, person.poses[size_t(key)]).joints;
  double farthest = 0;
  for (size_t j = 0; j < names.size(); ++j) {
    const Vector3d at = kCentimetre_m * file.Global(file.Find(names[j], "Model"), key).translation();
    farthest = std::max(farthest, (at - joints.row(Eigen::Index(j)).transpose()).norm());
  }
  return farthest;
}

TEST(FbxWriter, PosesTheBodyWhereItIsForEveryRig) {
  const Track track = TrackWithAGap();
  const ExportScene scene = SceneOf(track);
  for (const AnimationRig rig :
       {AnimationRig::kSmpl, AnimationRig::kMixamo, AnimationRig::kUnreal, AnimationRig::kVrm}) {
    SkinSummary summary;
    const FbxTwin file(FbxText(scene, {.rig = rig}, &summary));
    EXPECT_LT(summary.max_error_m, 1e-3);
    EXPECT_EQ(summary.influences, 0);
    for (const auto& [key, t] : {std::pair(0, 0), std::pair(3, 5), std::pair(9, 11)}) {
      EXPECT_LT(FarthestVertex(file, track, key, t), summary.max_error_m + 5e-6);
      EXPECT_LT(FarthestJoint(file, scene.people[0], rig, key), 1e-5);
    }
  }
}

TEST(FbxWriter, PosesTheFingersForEveryRig) {
  const BodyModel& body = BuiltinBodyWithHands();
  const Track track = TrackWithHands();
  const ExportScene scene = SceneOf(track, body);
  for (const AnimationRig rig :
       {AnimationRig::kSmpl, AnimationRig::kMixamo, AnimationRig::kUnreal, AnimationRig::kVrm}) {
    SkinSummary summary;
    const FbxTwin file(FbxText(scene, {.rig = rig, .correctives = 12}, &summary));
    for (const int t : {0, 7}) {
      const Eigen::MatrixXd posed = kCentimetre_m * file.Pose(file.Find("person_0_body", "Geometry"), t);
      EXPECT_LT((posed - VerticesInWorld(track, t, body)).rowwise().norm().maxCoeff(), summary.max_error_m + 5e-6);
      EXPECT_LT(FarthestJoint(file, scene.people[0], rig, t), 1e-5);
    }
  }
}

TEST(FbxWriter, EnoughShapesAreExactAlsoInTheAPose) {
  const ExportScene scene = SceneOf(TrackWithAGap());
  for (const AnimationRig rig : {AnimationRig::kSmpl, AnimationRig::kUnreal}) {
    SkinSummary few, enough;
    FbxText(scene, {.rig = rig, .correctives = 0}, &few);
    FbxText(scene, {.rig = rig, .correctives = 10}, &enough);  // as many as there are frames
    EXPECT_LT(enough.max_error_m, 2e-5);
    EXPECT_GT(few.max_error_m, 50 * enough.max_error_m);
    EXPECT_EQ(few.shapes, 0);
  }
}

TEST(RiggedMesh, JointsTurnedAgainstEachOtherAreExactInTheTPose) {
  // Wrists turned by 170° and more: half-way between the joints the blend of the rotations has no inverse.
  ExportScene scene = SceneOf(TrackWithAGap());
  ExportPerson& person = scene.people[0];
  for (size_t t = 0; t < person.poses.size(); ++t) {
    person.poses[t].rotations[size_t(BuiltinBody().FindJoint("l_wrist"))] =
        RotationFromAxisAngle({2.9 + 0.02 * double(t), 0.1, 0});
  }
  const RiggedMesh mesh = MakeRiggedMesh(person, RigSkeletonOf(AnimationRig::kSmpl, BuiltinBody()), 10);
  EXPECT_LT(mesh.max_error_m, 2e-5);
}

TEST(FbxWriter, RestPoseIsTheRigs) {
  const ExportScene scene = SceneOf(TrackWithAGap());
  for (const auto& [rig, shoulder, wrist, down_deg] :
       {std::tuple(AnimationRig::kMixamo, "mixamorig:LeftArm", "mixamorig:LeftHand", 0.0),
        std::tuple(AnimationRig::kVrm, "leftUpperArm", "leftHand", 0.0),
        std::tuple(AnimationRig::kUnreal, "upperarm_l", "hand_l", 45.0)}) {
    SkinSummary summary;
    const FbxTwin file(FbxText(scene, {.rig = rig}, &summary));
    const Vector3d arm = file.Global(file.Find(wrist, "Model"), -1).translation() -
                         file.Global(file.Find(shoulder, "Model"), -1).translation();
    EXPECT_NEAR(std::atan2(-arm.y(), arm.x()) * 180 / M_PI, down_deg, 3);
    // Clusters, bind pose and models without animation agree, and the mesh hangs on the arm.
    std::map<int64_t, std::vector<double>> bind;
    for (const FbxTwinNode& node : file.objects.at(file.Find("person_0", "Pose"))->nodes) {
      if (node.name == "PoseNode") bind[node.At("Node").properties[0].whole] = node.Numbers("Matrix");
    }
    EXPECT_EQ(bind.size(), size_t(BuiltinBody().num_joints()) + 2);
    const int64_t geometry = file.Find("person_0_body", "Geometry"),
                  skin = file.Children(geometry, "Deformer", "Skin")[0];
    for (const int64_t cluster : file.Children(skin, "Deformer", "Cluster")) {
      const int64_t model = file.Children(cluster, "Model", "LimbNode").at(0);
      const std::vector<double>& link = file.objects.at(cluster)->Numbers("TransformLink");
      EXPECT_EQ(link, bind.at(model));
      const Eigen::Matrix4d rest = file.Global(model, -1).matrix();
      EXPECT_TRUE(rest.isApprox(Eigen::Map<const Eigen::Matrix4d>(link.data()), 1e-9));
    }
    const std::vector<double>& vertices = file.objects.at(geometry)->Numbers("Vertices");
    double lowest_of_far_left = 1e9, farthest = 0;
    for (size_t v = 0; v < vertices.size(); v += 3) farthest = std::max(farthest, vertices[v]);
    for (size_t v = 0; v < vertices.size(); v += 3) {
      if (vertices[v] > farthest - 2) lowest_of_far_left = std::min(lowest_of_far_left, vertices[v + 1]);
    }
    const double wrist_height = file.Global(file.Find(wrist, "Model"), -1).translation().y();
    EXPECT_LT(std::abs(lowest_of_far_left - wrist_height), 25) << "the hand is at the wrist";
  }
}

TEST(FbxWriter, NamesAreTheRigs) {
  const BodyModel& body = BuiltinBody();
  EXPECT_EQ(FbxJointNames(AnimationRig::kSmpl, body), body.data().joint_names);
  const std::vector<std::string> mixamo = FbxJointNames(AnimationRig::kMixamo, body);
  EXPECT_EQ(mixamo[0], "mixamorig:Hips");
  EXPECT_EQ(mixamo[21], "mixamorig:RightHand");
  EXPECT_EQ(mixamo[22], body.data().joint_names[22]) << "the rig has no name for it";
  EXPECT_EQ(FbxJointNames(AnimationRig::kUnreal, body)[18], "lowerarm_l");
  EXPECT_EQ(FbxJointNames(AnimationRig::kVrm, body)[9], "upperChest");
}

TEST(FbxWriter, FingersHaveTheRigsNames) {
  const BodyModel& body = BuiltinBodyWithHands();
  const auto name = [&](AnimationRig rig, const char* joint) {
    return FbxJointNames(rig, body)[size_t(body.FindJoint(joint))];
  };
  EXPECT_EQ(name(AnimationRig::kSmpl, "l_index1"), "l_index1");
  EXPECT_EQ(name(AnimationRig::kMixamo, "l_index1"), "mixamorig:LeftHandIndex1");
  EXPECT_EQ(name(AnimationRig::kMixamo, "r_thumb3"), "mixamorig:RightHandThumb3");
  EXPECT_EQ(name(AnimationRig::kUnreal, "l_pinky2"), "pinky_02_l");
  EXPECT_EQ(name(AnimationRig::kUnreal, "r_thumb1"), "thumb_01_r");
  EXPECT_EQ(name(AnimationRig::kVrm, "l_index1"), "leftIndexProximal");
  EXPECT_EQ(name(AnimationRig::kVrm, "r_pinky2"), "rightLittleIntermediate");
  EXPECT_EQ(name(AnimationRig::kVrm, "l_ring3"), "leftRingDistal");
  EXPECT_EQ(name(AnimationRig::kVrm, "r_thumb1"), "rightThumbMetacarpal");
  EXPECT_EQ(name(AnimationRig::kVrm, "r_thumb2"), "rightThumbProximal");
}

TEST(FbxWriter, KeysAreTheTracksAndTheLostAreGone) {
  const Track track = TrackWithAGap();
  const ExportScene scene = SceneOf(track);
  SkinSummary summary;
  const FbxTwin file(FbxText(scene, {}, &summary));
  const int64_t pelvis = file.Find("pelvis", "Model");
  const FbxTwin::Curve x = file.CurveOf(pelvis, "Lcl Translation", "d|X");
  ASSERT_EQ(x.seconds.size(), 10U);
  EXPECT_EQ(x.seconds[0], 0) << "the clip begins at once";
  EXPECT_NEAR(x.seconds[3], 5 / 6.0, 1e-9);
  const FbxTwin::Curve scale = file.CurveOf(pelvis, "Lcl Scaling", "d|Y");
  EXPECT_EQ(scale.values, (std::vector<double>{1, 1, 0, 0, 1}));
  EXPECT_NEAR(scale.seconds[1], 2.25 / 6, 1e-9);
  EXPECT_NEAR(scale.seconds[2], 2.5 / 6, 1e-9);
  EXPECT_NEAR(scale.seconds[3], 4.75 / 6, 1e-9);
  EXPECT_NEAR(scale.seconds[4], 5 / 6.0, 1e-9);
  const FbxTwinNode& settings = file.root.At("GlobalSettings");
  EXPECT_EQ(settings.Property("UnitScaleFactor"), std::vector<double>{1});
  EXPECT_EQ(settings.Property("UpAxis"), std::vector<double>{1});
  EXPECT_EQ(settings.Property("TimeMode"), std::vector<double>{14});
  EXPECT_NEAR(settings.Property("CustomFrameRate").at(0), 6, 1e-9);
  EXPECT_EQ(file.root.At("Objects").nodes.size(), file.objects.size());
}

TEST(FbxWriter, MeshHasTheBodysFacesNormalsAndUv) {
  const BodyModelData& body = BuiltinBody().data();
  SkinSummary summary;
  const FbxTwin file(FbxText(SceneOf(TrackWithAGap()), {.textures = {"\x89PNG and so on"}}, &summary));
  const FbxTwinNode& mesh = *file.objects.at(file.Find("person_0_body", "Geometry"));
  const std::vector<double>& corners = mesh.Numbers("PolygonVertexIndex");
  const std::vector<double>& uv = mesh.At("LayerElementUV").Numbers("UV");
  const std::vector<double>& uv_index = mesh.At("LayerElementUV").Numbers("UVIndex");
  ASSERT_EQ(corners.size(), size_t(body.faces.size()));
  ASSERT_EQ(uv_index.size(), corners.size());
  for (size_t i = 0; i < corners.size(); ++i) {
    const double corner = i % 3 == 2 ? -corners[i] - 1 : corners[i];
    ASSERT_EQ(corner, body.faces.data()[i]);
    const auto index = size_t(uv_index[i]);
    ASSERT_EQ(uv[2 * index], double(body.vt(body.ft.data()[i], 0)));
    ASSERT_EQ(uv[2 * index + 1], double(body.vt(body.ft.data()[i], 1)));
  }
  const std::vector<double>& normals = mesh.At("LayerElementNormal").Numbers("Normals");
  ASSERT_EQ(normals.size(), size_t(3 * body.v_template.rows()));
  for (size_t i = 0; i < normals.size(); i += 3) {
    ASSERT_NEAR(Vector3d(normals[i], normals[i + 1], normals[i + 2]).norm(), 1, 1e-5);
  }
  EXPECT_EQ(file.objects.at(file.Find("person_0", "Video"))->At("Content").properties[0].text, "\x89PNG and so on");
}

TEST(FbxWriter, CameraSeesWhatTheClipsDid) {
  Track track = TrackWithAGap();
  track.camera.cx += 20;
  track.camera.cy -= 11;
  track.camera.fy *= 1.1;
  const ExportScene scene = SceneOf(track);
  SkinSummary summary;
  const FbxTwin file(FbxText(scene, {}, &summary));
  const FbxTwinNode& lens = *file.objects.at(file.Find("camera", "NodeAttribute"));
  const Eigen::Affine3d camera_from_world = file.Global(file.Find("camera", "Model"), -1).inverse();
  const double mm_per_inch = 25.4, f = lens.Property("FocalLength").at(0);
  const double width = mm_per_inch * lens.Property("FilmWidth").at(0),
               height = mm_per_inch * lens.Property("FilmHeight").at(0);
  const double right = mm_per_inch * lens.Property("FilmOffsetX").at(0),
               up = mm_per_inch * lens.Property("FilmOffsetY").at(0);
  const MatrixX3d world = VerticesInWorld(track, 0);
  const BodyPose pose =
      PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(0).transpose(), track.motion.trans.row(0).transpose());
  const MatrixX3d in_camera = PoseVertices(BuiltinBody(), track.motion.betas, pose);
  for (const int v : {0, 1000, 5000}) {
    const Vector3d p = camera_from_world * (100 * world.row(v).transpose());  // x forward, y up, z right
    Eigen::Vector2d px;
    ASSERT_TRUE(track.camera.Project(in_camera.row(v).transpose(), &px));
    // The film's window is moved right and up.
    EXPECT_NEAR((f * p.z() / p.x() - right + 0.5 * width) / width * track.camera.width - 0.5, px.x(), 1e-6);
    EXPECT_NEAR((0.5 * height - f * p.y() / p.x() + up) / height * track.camera.height - 0.5, px.y(), 1e-6);
  }
}

TEST(FbxWriter, ACameraThatMovesIsWhereItWas) {
  const Track track = ShortTrack(6, SynthCameraMotion::kWalking);
  const ExportScene scene = SceneOf(track);
  SkinSummary summary;
  const FbxTwin file(FbxText(scene, {}, &summary));
  for (const int t : {0, 4, 11}) {
    const CameraPose world_from_camera = Inverse(scene.camera_keys[size_t(t)].camera_from_world);
    const Eigen::Affine3d camera = file.Global(file.Find("camera", "Model"), t);
    EXPECT_LT((camera.translation() / 100 - world_from_camera.camera_from_world_translation).norm(), 1e-5);
    const Matrix3d& R = world_from_camera.camera_from_world_rotation;
    EXPECT_LT((camera.linear().col(0) - R.col(2)).norm(), 1e-5) << "looks along x";
    EXPECT_LT((camera.linear().col(1) + R.col(1)).norm(), 1e-5) << "y is up";
  }
}

TEST(FbxWriter, TwoPeopleShareOneAnimation) {
  const Track first = TrackWithAGap();
  Track second = ShortTrack();
  for (double& time : second.motion.timestamps) time += 1.5;  // comes later
  const std::array<const BodyModel*, 2> bodies = {&BuiltinBody(), &BuiltinBody()};
  const std::array<const Track*, 2> tracks = {&first, &second};
  SkinSummary summary;
  const FbxTwin file(FbxText(MakeExportScene(bodies, tracks, TiltedWorld()), {}, &summary));
  EXPECT_EQ(summary.people, 2);
  int stacks = 0, skins = 0;
  for (const auto& [id, node] : file.objects) {
    stacks += node->name == "AnimationStack";
    skins += node->name == "Deformer" && node->properties[2].text == "Skin";
  }
  EXPECT_EQ(stacks, 1);
  EXPECT_EQ(skins, 2);
  const int64_t pelvis = file.Children(file.Find("person_1", "Model"), "Model", "LimbNode").at(0);
  EXPECT_NEAR(file.CurveOf(pelvis, "Lcl Translation", "d|X").seconds.at(0), 1, 1e-9);
  EXPECT_EQ(file.CurveOf(pelvis, "Lcl Scaling", "d|X").values.at(0), 0);
}

TEST(FbxWriter, TheSameSceneGivesTheSameBytesAndGarbageIsRefused) {
  const ExportScene scene = SceneOf(TrackWithAGap());
  SkinSummary summary;
  EXPECT_EQ(FbxText(scene, {}, &summary), FbxText(scene, {}, &summary));
  EXPECT_THROW(FbxText(scene, {.textures = {"JFIF"}}, &summary), std::invalid_argument);
  EXPECT_THROW(FbxText(scene, {.correctives = 65}, &summary), std::invalid_argument);
  ExportScene nobody = scene;
  nobody.people.clear();
  EXPECT_THROW(FbxText(nobody, {}, &summary), std::invalid_argument);
  EXPECT_THROW(FbxKeys(std::array{0.0, 0.1, 0.1}), std::invalid_argument);
}

Matrix3d FromEulerXyz(const Vector3d& angles) {
  return (Eigen::AngleAxisd(angles.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

TEST(FbxAnimation, ContinuousAnglesComeBackOverSeveralTurns) {
  std::vector<Matrix3d> rotations;
  MatrixX3d truth_deg(401, 3);
  for (int i = 0; i <= 400; ++i) {  // y passes 90° at angles that are not keys: the other representation takes over
    const double a = 0.03 * i;
    const Vector3d angles(0.5 * a, 1.2 * a, std::sin(a));
    truth_deg.row(i) = angles.transpose() * (180 / M_PI);
    rotations.push_back(FromEulerXyz(angles));
  }
  EXPECT_LT((ContinuousEulerXyz_deg(rotations) - truth_deg).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(FbxAnimation, AnglesNearGimbalLockAreTheRotations) {
  std::vector<Matrix3d> rotations;
  for (int i = -20; i <= 20; ++i) {
    rotations.push_back(RotationFromAxisAngle({0, M_PI / 2 + i * 1e-8, 0}) * RotationFromAxisAngle({0.1 * i, 0, 0}));
  }
  const MatrixX3d angles = ContinuousEulerXyz_deg(rotations);
  for (size_t i = 0; i < rotations.size(); ++i) {
    ASSERT_LT((FromEulerXyz(angles.row(Eigen::Index(i)).transpose() * (M_PI / 180)) - rotations[i]).norm(), 1e-6) << i;
  }
}

TEST(FbxAnimation, GimbalLockKeepsTheAngleBefore) {
  const Matrix3d before = RotationFromAxisAngle({0.3, 0, 0});
  const Matrix3d lock = RotationFromAxisAngle({0, M_PI / 2, 0}) * RotationFromAxisAngle({0.5, 0, 0});
  const MatrixX3d angles = ContinuousEulerXyz_deg(std::array{before, lock});
  EXPECT_NEAR(angles(1, 0), 0.3 * 180 / M_PI, 1e-9);
  EXPECT_NEAR(angles(1, 1), 90, 1e-5);
  EXPECT_NEAR(angles(1, 2), -0.2 * 180 / M_PI, 1e-6);
  // A full turn is counted on.
  std::vector<Matrix3d> turn;
  for (int i = 0; i <= 36; ++i) turn.push_back(RotationFromAxisAngle({0, 0, i * M_PI / 18}));
  EXPECT_NEAR(ContinuousEulerXyz_deg(turn)(36, 2), 360, 1e-9);
}

}  // namespace
}  // namespace bodyloom::fbx_writer_test
