// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/load_estimate.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/formats/npz.h"
#include "tests/data_tools/estimates/estimate_files.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"

namespace bodyloom::load_estimate_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace estimate_files;  // NOLINT(google-build-using-namespace)

constexpr int kWidth = 1280, kHeight = 720;
constexpr double kFloat = 1e-6;

BodyEstimate Load(const std::string& bytes) {
  return EstimateFromBytes(bytes, "e.pkl", {.image_width = kWidth, .image_height = kHeight});
}
std::string ErrorOf(const std::string& bytes, const LoadEstimateOptions& options = {kWidth, kHeight}) {
  return FileErrorOf("e.pkl", [&] { EstimateFromBytes(bytes, "e.pkl", options); });
}

void ExpectSame(const PersonEstimate& read, const PersonEstimate& written, Eigen::Index columns = 72) {
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.frames, written.frames);
  EXPECT_LT((read.poses - written.poses).leftCols(columns).cwiseAbs().maxCoeff(), kFloat);
  EXPECT_LT((read.trans - written.trans).cwiseAbs().maxCoeff(), kFloat);
  EXPECT_LT((read.betas - written.betas).cwiseAbs().maxCoeff(), kFloat);
  ASSERT_EQ(read.cameras.size(), written.cameras.size());
  for (size_t i = 0; i < read.cameras.size(); ++i) {
    const Camera &a = read.cameras[i], &b = written.cameras[i];
    EXPECT_EQ(a.model, b.model);
    if (a.model == CameraModel::kPinhole) {
      EXPECT_TRUE(a.K().isApprox(b.K(), kFloat)) << a.K() << "\n" << b.K();
    } else {
      EXPECT_NEAR(a.scale, b.scale, 1e-4);
      EXPECT_NEAR(a.tx, b.tx, kFloat);
      EXPECT_NEAR(a.ty, b.ty, kFloat);
      EXPECT_EQ(a.cx, b.cx);
    }
  }
}

/// The camera that the systems with a guessed focal length use.
Camera DiagonalCamera() { return CentredCamera(kWidth, kHeight, std::hypot(kWidth, kHeight)); }

TEST(LoadEstimate, Wham) {
  const PersonEstimate small = MakePerson("3", {0, 1}, DiagonalCamera(), {1, 0, 9});
  const PersonEstimate large = MakePerson("7", {1, 2, 5}, DiagonalCamera(), {-0.5, 0.2, 4});
  const BodyEstimate estimate = Load(WhamFile({small, large}));
  EXPECT_EQ(estimate.system, "WHAM");
  EXPECT_EQ(estimate.body, "smpl");
  ASSERT_EQ(estimate.people.size(), 2U);
  ExpectSame(estimate.people[0], large);  // the largest and longest in view
  ExpectSame(estimate.people[1], small);
  EXPECT_THAT(ErrorOf(WhamFile({small}), {}), HasSubstr("image size, which is not known; give --video"));
}

Camera WeakCamera(double scale, double tx, double ty) {
  Camera camera = DiagonalCamera();
  camera.model = CameraModel::kWeakPerspective;
  camera.scale = scale;
  camera.tx = tx;
  camera.ty = ty;
  return camera;
}

TEST(LoadEstimate, Vibe) {
  const PersonEstimate person = MakePerson("1", {4, 5, 9}, WeakCamera(210, 0.3, -0.4), {0, 0, 0});
  const BodyEstimate estimate = Load(VibeFile({person}));
  EXPECT_EQ(estimate.system, "VIBE");
  ASSERT_EQ(estimate.people.size(), 1U);
  ExpectSame(estimate.people[0], person);
  EXPECT_THAT(ErrorOf(VibeFile({person}), {720, 1280}), HasSubstr("expected 720x1280"));
  EXPECT_THAT(ErrorOf(VibeFile({person}), {}), HasSubstr("give --video"));
  EXPECT_THAT(ErrorOf(VibeFile({MakePerson("1", {4}, WeakCamera(-1, 0, 0), {0, 0, 0})})), HasSubstr("positive"));
}

TEST(LoadEstimate, PhalpLeavesGhostsOut) {
  const Camera camera = CentredCamera(kWidth, kHeight, 5000.0 / 256 * kWidth);
  const PersonEstimate first = MakePerson("4", {0, 1, 2}, camera, {0.5, 0, 60});
  const PersonEstimate second = MakePerson("2", {2}, camera, {-1, 0, 70});
  const BodyEstimate estimate = EstimateFromBytes(PhalpFile({first, second}, 4), "e.pkl");
  EXPECT_EQ(estimate.system, "PHALP");
  EXPECT_EQ(estimate.num_frames, 0);
  ASSERT_EQ(estimate.people.size(), 2U);
  ExpectSame(estimate.people[0], first);
  ExpectSame(estimate.people[1], second);
}

TEST(LoadEstimate, Gvhmr) {
  const PersonEstimate person = MakePerson("0", {0, 1, 2}, DiagonalCamera(), {0.5, 0, 5});
  const BodyEstimate estimate = EstimateFromBytes(GvhmrFile(person), "e.pt");
  EXPECT_EQ(estimate.system, "GVHMR");
  EXPECT_EQ(estimate.body, "smplx");
  EXPECT_EQ(estimate.num_frames, 3);
  ASSERT_EQ(estimate.people.size(), 1U);
  ExpectSame(estimate.people[0], person, 66);
  EXPECT_TRUE(estimate.people[0].poses.rightCols(6).isZero());
}

/// A result of SAM 3D Body: 70 points on a bent curve, moved by cam_t, seen with that focal length.
NpzArrays Sam3dBody(double focal_px, double x_off_px = 0) {
  std::vector<double> points, pixels, place = {0.4, 1.1, 5};
  for (int k = 0; k < 70; ++k) {
    const Eigen::Vector3d p(0.3 * std::sin(k), -1.7 + 0.02 * k, 0.2 * std::cos(2.0 * k));
    points.insert(points.end(), p.data(), p.data() + 3);
    const double z = p.z() + place[2];
    pixels.push_back(focal_px * (p.x() + place[0]) / z + 640 + (k == 3 ? x_off_px : 0));
    pixels.push_back(focal_px * (p.y() + place[1]) / z + 360);
  }
  return {{"pred_keypoints_3d", NdArray::FromDoubles(points.data(), {70, 3})},
          {"pred_keypoints_2d", NdArray::FromDoubles(pixels.data(), {70, 2})},
          {"pred_cam_t", NdArray::FromDoubles(place.data(), {3})}};
}

TEST(LoadEstimate, Sam3dBodyGivesLandmarksAndItsCamera) {
  const BodyEstimate estimate = EstimateFromBytes(NpzBytes(Sam3dBody(900)), "e.pkl");
  EXPECT_EQ(estimate.system, "SAM 3D Body");
  EXPECT_TRUE(estimate.has_landmarks);
  ASSERT_EQ(estimate.people.size(), 1U);
  const PersonEstimate& person = estimate.people[0];
  ASSERT_EQ(person.landmarks.size(), 1U);
  EXPECT_NEAR(person.cameras[0].fx, 900, 1e-6);
  EXPECT_NEAR(person.cameras[0].cx, 640, 1e-6);
  EXPECT_NEAR(person.cameras[0].cy, 360, 1e-6);
  const auto mhr = [](int k) {
    return Eigen::RowVector3d(0.3 * std::sin(k) + 0.4, -0.6 + 0.02 * k, 0.2 * std::cos(2.0 * k) + 5);
  };
  const Eigen::RowVector3d hips = 0.5 * (mhr(9) + mhr(10));
  EXPECT_LT((person.trans.row(0) - hips).norm(), 1e-9);
  const std::vector<std::pair<int, int>> pairs = {{0, 0},   {9, 62},  {10, 41}, {11, 9}, {16, 14},
                                                  {17, 15}, {18, 18}, {19, 17}, {20, 20}};
  for (const auto& [landmark, k] : pairs) {
    EXPECT_LT((person.landmarks[0].row(landmark) + hips - mhr(k)).norm(), 1e-9) << landmark;
  }
  EXPECT_THAT(ErrorOf(NpzBytes(Sam3dBody(900, 8))), HasSubstr("px off a projection of pred_keypoints_3d"));
  NpzArrays broken = Sam3dBody(900);
  broken.erase("pred_keypoints_2d");
  EXPECT_THAT(ErrorOf(NpzBytes(broken)), HasSubstr("pred_keypoints_2d"));
}

TEST(LoadEstimate, AFolderOfSam3dBodyIsAClip) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.File("sam"));
  for (const char* name : {"f_0007_subj00.npz", "f_0005_subj01.npz", "f_0005_subj00.npz"}) {
    WriteNpz(folder.File(std::string("sam/") + name), Sam3dBody(900));
  }
  WriteNpz(folder.File("sam/other.npz"), {{"x", NdArray::FromDouble(1)}});
  const BodyEstimate estimate = LoadEstimate(folder.File("sam"));
  ASSERT_EQ(estimate.people.size(), 2U);
  EXPECT_EQ(estimate.people[0].name, "00");
  EXPECT_THAT(estimate.people[0].frames, ElementsAre(5, 7));
  EXPECT_THAT(estimate.people[1].frames, ElementsAre(5));
  std::filesystem::create_directories(folder.File("none"));
  EXPECT_THAT(FileErrorOf(folder.File("none"), [&] { LoadEstimate(folder.File("none")); }), HasSubstr("nobody"));
}

// Two people of one photo. What is called 2D there is the 3D as its own camera sees it: not a measurement.
TEST(LoadEstimate, GenuineSam3dBody) {
  const std::string path = SharedDir() + "/data/mhr_sam3d/img_subj00.npz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared/data/mhr_sam3d beside the repository";
  const BodyEstimate estimate = LoadEstimate(path);
  const PersonEstimate& person = estimate.people.at(0);
  EXPECT_NEAR(person.cameras[0].fx, 2535.266, 0.01);
  EXPECT_NEAR(person.cameras[0].cx, 960, 0.01);
  EXPECT_NEAR(person.cameras[0].cy, 445, 0.01);
  EXPECT_NEAR(person.trans(0, 2), 8.26, 0.1);
  const double thigh_m = (person.landmarks[0].row(11) - person.landmarks[0].row(13)).norm();
  EXPECT_GT(thigh_m, 0.35);
  EXPECT_LT(thigh_m, 0.5);
}

TEST(LoadEstimate, SortsFramesAndRefusesDoubles) {
  PersonEstimate person = MakePerson("1", {0, 1, 2}, DiagonalCamera(), {0, 0, 4});
  person.frames = {7, 3, 5};
  const BodyEstimate estimate = Load(WhamFile({person}));
  EXPECT_THAT(estimate.people[0].frames, ElementsAre(3, 5, 7));
  EXPECT_LT((estimate.people[0].poses.row(0) - person.poses.row(1)).norm(), 1e-5);
  person.frames = {3, 5, 3};
  EXPECT_THAT(ErrorOf(WhamFile({person})), HasSubstr("person 1: frame 3 occurs twice"));
  person.frames = {3, -5, 4};
  EXPECT_THAT(ErrorOf(WhamFile({person})), HasSubstr("frame_ids: -5, expected frame numbers from 0"));
}

TEST(LoadEstimate, SaysWhatItFoundAndWhatItExpected) {
  EXPECT_THAT(ErrorOf(""), HasSubstr("the file is empty; expected a track .npz, wham_output.pkl"));
  EXPECT_THAT(ErrorOf("text"), HasSubstr("unknown kind of file; expected"));
  EXPECT_THAT(ErrorOf(Pickle(4, "}")), HasSubstr("nobody was found"));
  EXPECT_THAT(ErrorOf(Pickle(4, Dict({{Unicode("a"), Dict({{Unicode("b"), Int(1)}})}}))),
              HasSubstr("a pickle that holds no known poses; expected"));
  EXPECT_THAT(ErrorOf(torch_stream::Archive("}", {})), HasSubstr("without 'smpl_params_incam'"));
  const PersonEstimate nobody = MakePerson("1", {}, DiagonalCamera(), {0, 0, 4});
  EXPECT_THAT(ErrorOf(WhamFile({nobody})), HasSubstr("nobody in any frame"));
  PersonEstimate person = MakePerson("1", {0, 1}, DiagonalCamera(), {0, 0, 4});
  person.poses(1, 5) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(ErrorOf(WhamFile({person})), HasSubstr("person 1: pose: row 1 is not finite"));
  person = MakePerson("1", {0, 1}, DiagonalCamera(), {0, 0, 4});
  NpzArrays none = Sam3dBody(900);
  none.erase("pred_cam_t");
  EXPECT_THAT(ErrorOf(NpzBytes(none)), HasSubstr("an .npz without 'poses' and 'trans'; expected a track .npz"));
  const std::string short_ids = JoblibStream()
                                    .Add("}(" + Int(1) + "}(" + Unicode("pose"))
                                    .AddFloats(Floats(person.poses), {2, 72})
                                    .Add(Unicode("trans"))
                                    .AddFloats(Floats(person.trans), {2, 3})
                                    .Add(Unicode("betas"))
                                    .AddFloats(BetasOfFrames(person), {2, 10})
                                    .Add(Unicode("frame_ids"))
                                    .AddInts({4})
                                    .Add("uu")
                                    .Finish();
  EXPECT_THAT(ErrorOf(short_ids), HasSubstr("person 1: frame_ids: 1, expected 2"));
}

TEST(LoadEstimate, EveryTruncationIsAnError) {
  const PersonEstimate person = MakePerson("0", {0}, DiagonalCamera(), {0.5, 0, 5});
  for (const std::string& good : {WhamFile({person}), PhalpFile({person}, 1), GvhmrFile(person)}) {
    for (size_t size = 0; size < good.size(); size += 1 + good.size() / 300) ErrorOf(good.substr(0, size));
  }
}

}  // namespace
}  // namespace bodyloom::load_estimate_test
