// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/body_io.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>

#include "data_tools/body/body_compact.h"
#include "data_tools/body/body_smpl.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/observations.h"
#include "tests/data_tools/body/small_body.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"

namespace bodyloom::body_io_test {
namespace {

using ::testing::HasSubstr;

BodyModel LoadArrays(const NpzArrays& arrays, const LoadBodyOptions& options = {}) {
  return BodyModel(BodyFromArrays(NamedArrays(arrays, "model.npz"), options));
}

std::string LoadErrorOf(const NpzArrays& arrays) {
  const TemporaryFolder folder;
  WriteNpz(folder.File("model.npz"), arrays);
  return FileErrorOf(folder.File("model.npz"), [&] { LoadBody(folder.File("model.npz")); });
}

/// The first element of an array set to another value of its type.
template <typename T>
NpzArrays With(NpzArrays arrays, const std::string& name, T value, size_t index = 0) {
  std::memcpy(arrays.at(name).bytes.data() + index * sizeof(T), &value, sizeof(T));
  return arrays;
}

void ExpectSameData(const BodyModelData& a, const BodyModelData& b) {
  EXPECT_EQ(a.joint_names, b.joint_names);
  EXPECT_EQ(a.parents, b.parents);
  EXPECT_EQ(a.v_template, b.v_template);
  EXPECT_EQ(a.shapedirs, b.shapedirs);
  EXPECT_EQ(a.posedirs.begin, b.posedirs.begin);
  EXPECT_EQ(a.posedirs.joint, b.posedirs.joint);
  EXPECT_EQ(a.posedirs.block, b.posedirs.block);
  EXPECT_EQ(Eigen::MatrixXd(a.J_regressor), Eigen::MatrixXd(b.J_regressor));
  EXPECT_EQ(Eigen::MatrixXd(a.weights), Eigen::MatrixXd(b.weights));
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.pose_mean, b.pose_mean);
  EXPECT_EQ(a.vt, b.vt);
  EXPECT_EQ(a.ft, b.ft);
  EXPECT_EQ(a.face_part, b.face_part);
  EXPECT_EQ(a.face_iuv, b.face_iuv);
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  for (size_t i = 0; i < a.landmarks.size(); ++i) {
    EXPECT_EQ(a.landmarks[i].name, b.landmarks[i].name);
    EXPECT_EQ(a.landmarks[i].vertices, b.landmarks[i].vertices);
    EXPECT_EQ(a.landmarks[i].weights, b.landmarks[i].weights);
  }
}

/// Largest coordinate difference of the two bodies over random shapes and poses (joint angles up to `angle` radians).
double LargestPosedDifference(const BodyModel& a, const BodyModel& b, double angle) {
  std::srand(3);
  double largest = 0;
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::VectorXd betas = 3 * Eigen::VectorXd::Random(a.num_betas());
    const Eigen::VectorXd pose = angle / std::sqrt(3.0) * Eigen::VectorXd::Random(3 * a.num_joints());
    const MatrixX3d va = PoseVertices(a, betas, PoseFromAxisAngle(a, pose, Eigen::Vector3d(0.1, 0.2, 3)));
    const MatrixX3d vb = PoseVertices(b, betas, PoseFromAxisAngle(b, pose, Eigen::Vector3d(0.1, 0.2, 3)));
    largest = std::max(largest, (va - vb).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(BodyIo, OfficialPickleHoldsWhatWasWritten) {
  const TemporaryFolder folder;
  const BodyArrays arrays = MakeBodyArrays(97, 24, 4, true);
  WriteFileAtomically(folder.File("model.pkl"), OfficialPickle(arrays));
  const BodyModel body = LoadBody(folder.File("model.pkl"));
  EXPECT_EQ(body.num_vertices(), 97);
  EXPECT_EQ(body.num_joints(), 24);
  EXPECT_EQ(body.num_betas(), 4);
  EXPECT_EQ(body.parents(), SmplParents());
  EXPECT_EQ(body.data().joint_names, SmplJointNames());
  EXPECT_EQ(body.name(), "model");
  EXPECT_FALSE(body.has_uv());
  EXPECT_EQ(Eigen::Map<const MatrixX3d>(arrays.v_template.data(), 97, 3), body.data().v_template);
  EXPECT_EQ(Eigen::Map<const RowMatrixXd>(arrays.shapedirs.data(), 291, 4).cast<float>(), body.data().shapedirs);
  EXPECT_TRUE(Eigen::MatrixXd(body.data().weights)
                  .isApprox(Eigen::Map<const RowMatrixXd>(arrays.weights.data(), 97, 24), 1e-14));
  EXPECT_TRUE(Eigen::MatrixXd(body.data().J_regressor)
                  .isApprox(Eigen::Map<const RowMatrixXd>(arrays.J_regressor.data(), 24, 97), 1e-14));
  ASSERT_EQ(body.data().posedirs.joint.size(), 97U * 23U);
  // Vertex 5, joint 7, coordinate 2, entry 4 of the rotation: posedirs[5, 2, 9·6 + 4].
  const size_t block = 5 * 23 + 6;
  EXPECT_EQ(body.data().posedirs.joint[block], 7);
  EXPECT_EQ(body.data().posedirs.block[block * 27 + 2 * 9 + 4],
            static_cast<float>(arrays.posedirs[(5 * 3 + 2) * 207 + 9 * 6 + 4]));
}

TEST(BodyIo, PickleAndNpzGiveTheSameBody) {
  const TemporaryFolder folder;
  const BodyArrays arrays = MakeBodyArrays(60, 24, 3, true);
  WriteFileAtomically(folder.File("any_name.bin"), OfficialPickle(arrays));
  WriteNpz(folder.File("model.npz"), OfficialNpz(arrays));
  ExpectSameData(LoadBodyData(folder.File("any_name.bin")), LoadBodyData(folder.File("model.npz")));
}

TEST(BodyIo, SmplTopologyGetsTheDetectorsLandmarks) {
  const BodyModel body = LoadArrays(OfficialNpz(MakeBodyArrays(6890, 24, 2, false)));
  EXPECT_EQ(body.name(), "smpl");
  for (const std::string& name : CocoNames()) EXPECT_GE(body.FindLandmark(name), 0) << name;
  EXPECT_EQ(body.data().landmarks.size(), 23U);
  BodyPose pose;
  pose.rotations.assign(24, Eigen::Matrix3d::Identity());
  const MatrixX3d points =
      PoseLandmarks(body, Eigen::VectorXd(), pose, {"nose", "right_heel", "left_knee", "right_wrist"});
  EXPECT_TRUE(points.row(0).isApprox(body.data().v_template.row(332), 1e-12));
  EXPECT_TRUE(points.row(1).isApprox(body.data().v_template.row(6787), 1e-12));
  EXPECT_TRUE(points.row(2).isApprox(body.joint_template().row(4), 1e-12));
  EXPECT_TRUE(points.row(3).isApprox(body.joint_template().row(21), 1e-12));
}

TEST(BodyIo, LandmarksAreTheNormalisedRegressorRows) {
  BodyArrays arrays = MakeBodyArrays(6890, 24, 1, false);
  for (int v = 0; v < 6890; ++v) arrays.J_regressor[4 * 6890 + v] *= 1.0005;  // still a file that is accepted
  const BodyModel body = LoadArrays(OfficialNpz(arrays));
  const Landmark& knee = body.data().landmarks[body.FindLandmark("left_knee")];
  EXPECT_NEAR(std::accumulate(knee.weights.begin(), knee.weights.end(), 0.0), 1, 1e-12);
}

TEST(BodyIo, CompactFileDropsWeightsBelowItsGrid) {
  BodyArrays arrays = MakeBodyArrays(50, 24, 1, false);
  arrays.weights[5] = 1e-9;  // vertex 0, joint 5
  const BodyModel body = LoadArrays(OfficialNpz(arrays));
  const TemporaryFolder folder;
  SaveBodyCompact(folder.File("a.npz"), body.data());
  EXPECT_EQ(LoadBodyData(folder.File("a.npz")).weights.nonZeros(), body.data().weights.nonZeros() - 1);
}

TEST(BodyIo, HandsOfSmplhAndSmplx) {
  const BodyArrays arrays = MakeBodyArrays(80, 52, 16, false);
  const BodyModel smplh = LoadArrays(OfficialNpz(arrays));
  ASSERT_EQ(smplh.data().pose_mean.size(), 156);
  EXPECT_EQ(smplh.data().pose_mean.head<66>().norm(), 0);
  EXPECT_EQ(smplh.data().pose_mean[66], arrays.hands_mean[0][0]);
  EXPECT_EQ(smplh.data().pose_mean[155], arrays.hands_mean[1][44]);
  EXPECT_EQ(smplh.FindJoint("l_index1"), 22);
  EXPECT_EQ(smplh.FindJoint("r_thumb3"), 51);
  LoadBodyOptions flat;
  flat.flat_hand_mean = true;
  flat.max_betas = 10;
  EXPECT_EQ(LoadArrays(OfficialNpz(arrays), flat).data().pose_mean.size(), 0);
  EXPECT_EQ(LoadArrays(OfficialNpz(arrays), flat).num_betas(), 10);

  const BodyArrays x = MakeBodyArrays(10475, 55, 20, false);
  const BodyModel smplx = LoadArrays(OfficialNpz(x));
  EXPECT_EQ(smplx.name(), "smplx");
  EXPECT_EQ(smplx.num_betas(), 10) << "the last ten components are expression, not shape";
  EXPECT_EQ(smplx.data().shapedirs(7, 9), static_cast<float>(x.shapedirs[7 * 20 + 9]));
  EXPECT_EQ(smplx.FindJoint("jaw"), 22);
  EXPECT_EQ(smplx.data().pose_mean[75], x.hands_mean[0][0]);
  EXPECT_EQ(smplx.data().pose_mean[120], x.hands_mean[1][0]);
  EXPECT_EQ(smplx.data().landmarks[smplx.FindLandmark("nose")].vertices, std::vector<int>{9120});
}

TEST(BodyIo, RootParentOfEveryKind) {
  const NpzArrays arrays = OfficialNpz(MakeBodyArrays(50, 24, 1, false));
  for (const int64_t root : {int64_t{-1}, int64_t{0}, int64_t{4294967295}}) {
    EXPECT_EQ(LoadArrays(With(arrays, "kintree_table", root)).parents()[0], -1);
  }
  EXPECT_THAT(LoadErrorOf(With(arrays, "kintree_table", int64_t{5})), HasSubstr("root's parent is 5"));
  EXPECT_THAT(LoadErrorOf(With(arrays, "kintree_table", int64_t{9}, 4)), HasSubstr("parent of joint 4 is 9"));
  EXPECT_THAT(LoadErrorOf(With(arrays, "kintree_table", int64_t{-1}, 4)), HasSubstr("parent of joint 4 is -1"));
}

TEST(BodyIo, BrokenArraysAreNamed) {
  const NpzArrays arrays = OfficialNpz(MakeBodyArrays(50, 24, 2, true));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(LoadErrorOf(With(arrays, "v_template", nan)), HasSubstr("v_template holds NaN"));
  EXPECT_THAT(LoadErrorOf(With(arrays, "shapedirs", nan)), HasSubstr("shapedirs holds NaN"));
  EXPECT_THAT(LoadErrorOf(With(arrays, "posedirs", nan)), HasSubstr("posedirs holds NaN"));
  EXPECT_THAT(LoadErrorOf(With(arrays, "weights", nan)), HasSubstr("row 0 of weights sums to nan"));
  EXPECT_THAT(LoadErrorOf(With(arrays, "weights", 7.0)), HasSubstr("row 0 of weights"));
  EXPECT_THAT(LoadErrorOf(With(arrays, "J_regressor", -0.5)), HasSubstr("row 0 of J_regressor"));
  EXPECT_THAT(LoadErrorOf(With(arrays, "f", int32_t{50}, 4)), HasSubstr("f: row 1 names index 50, expected 0..49"));
  EXPECT_THAT(LoadErrorOf(With(arrays, "f", int32_t{-1})), HasSubstr("names index -1"));
  const auto without = [&](const std::string& name) {
    NpzArrays less = arrays;
    less.erase(name);
    return less;
  };
  for (const char* name : {"v_template", "f", "weights", "kintree_table", "J_regressor"}) {
    EXPECT_THAT(LoadErrorOf(without(name)), HasSubstr(std::string("no array '") + name + "'"));
  }
  EXPECT_TRUE(LoadArrays(without("posedirs")).data().posedirs.empty());
  EXPECT_EQ(LoadArrays(without("shapedirs")).num_betas(), 0);
  const std::vector<double> zeros(50 * 3 * 93, 0.0);
  const auto replaced = [&](const std::string& name, const std::vector<int64_t>& shape) {
    NpzArrays other = arrays;
    other[name] = NdArray::FromDoubles(zeros.data(), shape);
    return other;
  };
  EXPECT_THAT(LoadErrorOf(replaced("posedirs", {50, 3, 93})), HasSubstr("posedirs: 50x3x93, expected 50x3x207"));
  EXPECT_THAT(LoadErrorOf(replaced("v_template", {50, 2})), HasSubstr("v_template: 50x2, expected nx3"));
  EXPECT_THAT(LoadErrorOf(replaced("v_template", {0, 3})), HasSubstr("0 vertices"));
  EXPECT_THAT(LoadErrorOf(replaced("weights", {50, 23})), HasSubstr("weights: 50x23, expected 50x24"));
  NpzArrays text = arrays;
  text["v_template"] = NdArray::FromString("no");
  EXPECT_THAT(LoadErrorOf(text), HasSubstr("not an array of numbers"));
}

TEST(BodyIo, FilesOfOtherKinds) {
  const TemporaryFolder folder;
  const std::string path = folder.File("model.pkl");
  const auto error_of = [&](const std::string& bytes) {
    WriteFileAtomically(path, bytes);
    return FileErrorOf(path, [&] { LoadBody(path); });
  };
  EXPECT_THAT(error_of(""), HasSubstr("empty"));
  EXPECT_THAT(error_of("cos\nsystem\n(S'true'\ntR."), HasSubstr("'os.system'"));
  EXPECT_THAT(error_of("]."), HasSubstr("no dictionary"));
  EXPECT_THAT(error_of("}."), HasSubstr("no array 'v_template'"));
  error_of("{\"v_template\": []}");
  FileErrorOf(folder.File("absent.pkl"), [&] { LoadBody(folder.File("absent.pkl")); });
}

TEST(BodyIo, TruncatedFilesAreRefused) {
  const BodyArrays arrays = MakeBodyArrays(40, 24, 1, false);
  const TemporaryFolder folder;
  WriteNpz(folder.File("model.npz"), OfficialNpz(arrays));
  const BodyModel body = LoadBody(folder.File("model.npz"));
  SaveBodyCompact(folder.File("compact.npz"), body.data());
  for (const std::string& bytes :
       {OfficialPickle(arrays), ReadFileBytes(folder.File("model.npz")), ReadFileBytes(folder.File("compact.npz"))}) {
    for (size_t n = 0; n < bytes.size(); n += n < 300 || n + 300 > bytes.size() ? 1 : 37) {
      FileErrorOf("cut.pkl", [&] { LoadBodyBytes(bytes.substr(0, n), "cut.pkl"); });
    }
  }
}

TEST(BodyIo, CompactFileIsCloseAndStable) {
  const TemporaryFolder folder;
  const std::string first = folder.File("a.npz"), second = folder.File("b.npz");
  for (const auto& [V, J, with_posedirs] :
       {std::tuple(97, 24, true), std::tuple(60, 52, false), std::tuple(31, 2, true)}) {
    const BodyModel body = LoadArrays(OfficialNpz(MakeBodyArrays(V, J, 5, with_posedirs)));
    SaveBodyCompact(first, body.data());
    const BodyModel compact = LoadBody(first);
    EXPECT_LT(LargestPosedDifference(body, compact, 1.5), 1e-5);
    EXPECT_EQ(compact.name(), body.name());
    SaveBodyCompact(second, compact.data());
    EXPECT_EQ(ReadFileBytes(first), ReadFileBytes(second));
    ExpectSameData(compact.data(), LoadBodyData(second));
  }
}

TEST(BodyIo, CompactFileKeepsADecimalGridOfCorrectivesExactly) {
  BodyArrays arrays = MakeBodyArrays(50, 24, 1, true);
  for (double& x : arrays.posedirs) x = std::abs(x) < 0.008 ? 0.0 : static_cast<float>(std::nearbyint(x / 5e-5) * 5e-5);
  const BodyModel body = LoadArrays(OfficialNpz(arrays));
  const TemporaryFolder folder;
  SaveBodyCompact(folder.File("a.npz"), body.data());
  EXPECT_EQ(LoadBodyData(folder.File("a.npz")).posedirs.block, body.data().posedirs.block);
}

TEST(BodyIo, CompactFileOfAnSmplSizedBody) {
  const BodyModel body = LoadArrays(OfficialNpz(MakeBodyArrays(6890, 24, 10, true)));
  const TemporaryFolder folder;
  SaveBodyCompact(folder.File("a.npz"), body.data());
  const BodyModel compact = LoadBody(folder.File("a.npz"));
  EXPECT_EQ(compact.data().posedirs.joint.size(), 6890U * 23U);
  EXPECT_LT(LargestPosedDifference(body, compact, 1.0), 1e-5);
}

TEST(BodyIo, BrokenCompactFilesAreRefused) {
  const TemporaryFolder folder;
  BodyModelData data = LoadArrays(OfficialNpz(MakeBodyArrays(50, 24, 2, true))).data();
  data.landmarks = {{"nose", {3, 4}, {0.25, 0.75}}};
  data.vt = MatrixX2f::Random(50, 2).cwiseAbs();
  data.ft = data.faces;
  data.face_part.assign(data.faces.rows(), 7);
  data.face_iuv = RowMatrixXf::Random(data.faces.rows(), 6).cwiseAbs();
  const NpzArrays whole = CompactFromBody(BodyModel(data).data());
  ASSERT_NO_THROW(BodyFromCompact(whole, "c.npz", {}));
  ExpectSameData(BodyFromCompact(CompactFromBody(BodyFromCompact(whole, "c.npz", {})), "c.npz", {}),
                 BodyFromCompact(whole, "c.npz", {}));
  const auto error_of = [&](const NpzArrays& arrays) {
    return FileErrorOf("c.npz", [&] {
      try {
        BodyModel body(BodyFromCompact(arrays, "c.npz", {}));
      } catch (const std::invalid_argument& error) {
        throw std::runtime_error(std::string("c.npz: ") + error.what());
      }
    });
  };
  const std::set<std::string> optional = {"pose_mean", "shapedirs", "posedirs_block", "vt",         "ft",
                                          "face_iuv",  "face_part", "landmark_names", "joint_names"};
  for (const auto& [name, array] : whole) {
    NpzArrays changed = whole;
    changed.erase(name);
    if (optional.count(name) == 0) {
      EXPECT_THAT(error_of(changed), HasSubstr("no array '" + name + "'"));
    }
    changed[name] = NdArray::FromDoubles(nullptr, {0, 0, 0});
    error_of(changed);
    changed[name] = NdArray::FromDouble(std::numeric_limits<double>::quiet_NaN());
    error_of(changed);
    if (array.dtype == DType::kU8 && name != "face_part" && name != "vt" && name != "face_iuv") {
      changed[name] = array;  // the largest of residuals everywhere
      changed[name].bytes.assign(array.bytes.size(), '\xff');
      if (name != "v_template" && name != "shapedirs" && name != "posedirs_block" &&
          name.find("weight") == std::string::npos) {
        error_of(changed);
      }
    }
  }
  NpzArrays future = whole;
  future["format"] = NdArray::FromString("bodyloom-body-9");
  EXPECT_THAT(error_of(future), HasSubstr("'bodyloom-body-9', expected 'bodyloom-body-1'"));
}

TEST(BodyIo, SavingRefusesWhatCannotBeAFile) {
  const TemporaryFolder folder;
  BodyModelData data = LoadArrays(OfficialNpz(MakeBodyArrays(50, 24, 2, false))).data();
  FileErrorOf("absent/a.npz", [&] { SaveBodyCompact(folder.File("absent/a.npz"), data); });
  data.v_template(3, 1) = 1e6;
  EXPECT_THROW(SaveBodyCompact(folder.File("a.npz"), data), std::invalid_argument);
  data.v_template(3, 1) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(SaveBodyCompact(folder.File("a.npz"), data), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder.File("a.npz")));
}

TEST(BodyIo, DescribesWhatABodyHas) {
  const std::string text = DescribeBody(LoadArrays(OfficialNpz(MakeBodyArrays(6890, 24, 10, false))));
  EXPECT_THAT(text, HasSubstr("name             smpl\n"));
  EXPECT_THAT(text, HasSubstr("vertices         6890\n"));
  EXPECT_THAT(text, HasSubstr("shape components 10\n"));
  EXPECT_THAT(text, HasSubstr("pose correctives none\n"));
  EXPECT_THAT(text, HasSubstr("UV               none"));
  EXPECT_THAT(text, HasSubstr("landmarks        23\n"));
}

TEST(BodyIo, BuiltInBodyDenseAndCompact) {
  const std::string path = SharedDir() + "/assets/body/body.npz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no dense built-in body at " << path;
  const BodyModel body = LoadBody(path);
  EXPECT_EQ(body.name(), "bodyloom");
  EXPECT_EQ(body.num_vertices(), 7874);
  EXPECT_EQ(body.num_faces(), 15744);
  EXPECT_TRUE(body.has_uv());
  EXPECT_TRUE(body.has_parts());
  for (const std::string& name : CocoNames()) EXPECT_GE(body.FindLandmark(name), 0) << name;
  const TemporaryFolder folder;
  const std::string compact_path = folder.File("compact.npz");
  SaveBodyCompact(compact_path, body.data());
  EXPECT_LT(std::filesystem::file_size(compact_path), 700'000U);
  const BodyModel compact = LoadBody(compact_path);
  EXPECT_EQ(compact.data().posedirs.block, body.data().posedirs.block);
  EXPECT_EQ(compact.data().ft, body.data().ft);
  EXPECT_EQ(compact.data().face_part, body.data().face_part);
  EXPECT_LT((compact.data().vt - body.data().vt).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((compact.data().face_iuv - body.data().face_iuv).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(LargestPosedDifference(body, compact, 1.5), 1e-5);
  SaveBodyCompact(folder.File("again.npz"), compact.data());
  EXPECT_EQ(ReadFileBytes(compact_path), ReadFileBytes(folder.File("again.npz")));
}

}  // namespace
}  // namespace bodyloom::body_io_test
