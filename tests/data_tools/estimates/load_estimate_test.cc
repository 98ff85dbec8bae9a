// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/load_estimate.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <sstream>
#include <tuple>

#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/estimates/estimate_readers.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/base/check.h"
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

/// Systems that write one person on SMPL-X, whose hands they leave at rest.
void ExpectOneOfSmplx(const char* system, std::string (*file_of)(const PersonEstimate&)) {
  const PersonEstimate person = MakePerson("0", {0, 1, 2}, DiagonalCamera(), {0.5, 0, 5});
  const BodyEstimate estimate = EstimateFromBytes(file_of(person), "e.pt");
  EXPECT_EQ(estimate.system, system);
  EXPECT_EQ(estimate.body, "smplx");
  EXPECT_EQ(estimate.num_frames, 3);
  ASSERT_EQ(estimate.people.size(), 1U);
  ExpectSame(estimate.people[0], person, 66);
  EXPECT_TRUE(estimate.people[0].poses.rightCols(6).isZero());
}

TEST(LoadEstimate, Gvhmr) { ExpectOneOfSmplx("GVHMR", GvhmrFile); }
TEST(LoadEstimate, GemOfSmplx) { ExpectOneOfSmplx("GEM", GemFile); }

TEST(LoadEstimate, GemXOfSomaTurnsSmplsJoints) {
  PersonEstimate person = MakePerson("0", {0, 1}, DiagonalCamera(), {0.5, 0, 5});
  person.poses.rightCols(6).setZero();
  person.betas.resize(0);
  RowMatrixXd soma = SomaPose(person);
  const BodyEstimate estimate = EstimateFromBytes(GemXFile(person, soma), "e.pt");
  EXPECT_EQ(estimate.system, "GEM-X");
  EXPECT_EQ(estimate.body, "soma");
  EXPECT_EQ(estimate.rest_pelvis, Eigen::Vector3d::Zero()) << "transl is the hips' place";
  EXPECT_LT((estimate.people[0].poses - person.poses).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((estimate.people[0].trans - person.trans).cwiseAbs().maxCoeff(), kFloat);

  // SOMA has a second joint of the neck, whose turn the head has in SMPL: here both turn about one axis.
  soma.setZero();
  soma(0, 3 * 4) = 0.2, soma(0, 3 * 5) = 0.3, soma(0, 3 * 6) = 0.1;
  soma(0, 3 * 15 + 2) = 1;  // a thumb, which SMPL lacks
  const BodyEstimate nod = EstimateFromBytes(GemXFile(person, soma), "e.pt");
  Eigen::RowVectorXd expected = Eigen::RowVectorXd::Zero(72);
  expected[3 * 12] = 0.2, expected[3 * 15] = 0.4;
  EXPECT_LT((nod.people[0].poses.row(0) - expected).cwiseAbs().maxCoeff(), kFloat);
  EXPECT_THAT(ErrorOf(GemXFile(person, RowMatrixXd::Constant(2, 231, NAN))), HasSubstr("is not finite"));
}

TEST(LoadEstimate, GemOfAnotherBodyIsRefused) {
  WeightsFile file;
  const std::vector<double> values(12, 0.5);
  file.tensors["body_params_incam.body_pose"] = NdArray::FromDoubles(values.data(), {2, 6});
  EXPECT_TRUE(IsGem(file));
  EXPECT_THAT(FileErrorOf("e.pt", [&] { GemFromTensors(file, "e.pt"); }),
              HasSubstr("body_pose: 2x6, expected Lx63 (SMPL-X) or Lx228 (SOMA)"));
}

TEST(LoadEstimate, PromptHmrIsScaledToTheVideo) {
  const PersonEstimate small = MakePerson("3", {0, 1}, CentredCamera(kWidth, kHeight, 1500), {1, 0, 9});
  const PersonEstimate large = MakePerson("7", {1, 2, 5}, CentredCamera(kWidth, kHeight, 1500), {-0.5, 0.2, 4});
  for (const bool as_matrices : {false, true}) {
    // Loaded at half the size.
    const BodyEstimate estimate = Load(PromptHmrFile({small, large}, kWidth / 2, kHeight / 2, 750, as_matrices));
    EXPECT_EQ(estimate.system, "PromptHMR");
    EXPECT_EQ(estimate.body, "smplx");
    ASSERT_EQ(estimate.people.size(), 2U);
    ExpectSame(estimate.people[0], large, 66);
    ExpectSame(estimate.people[1], small, 66);
    EXPECT_TRUE(estimate.people[0].poses.rightCols(6).isZero());
    EXPECT_EQ(estimate.people[0].cameras[0].width, kWidth);
  }
  const BodyEstimate unscaled = EstimateFromBytes(PromptHmrFile({small}, 640, 360, 750), "e.pkl");
  EXPECT_EQ(unscaled.people[0].cameras[0].fx, 750);
  EXPECT_EQ(unscaled.people[0].cameras[0].width, 640);
  const BodyEstimate other = Load(PromptHmrFile({small}, 360, 640, 750));
  EXPECT_EQ(other.people[0].cameras[0].width, 360) << "another image, which the caller refuses";
  PersonEstimate odd = small;
  odd.trans(1, 2) = NAN;
  EXPECT_THAT(ErrorOf(PromptHmrFile({odd}, kWidth, kHeight, 750)), HasSubstr("person 3: trans: row 1 is not finite"));
  EXPECT_THAT(ErrorOf(PromptHmrFile({small}, kWidth, kHeight, -1)), HasSubstr("expected a focal length above 0"));
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

std::string JsonOf(const NpzArrays& person) {
  std::string text;
  for (const auto& [key, array] : person) {
    const RowMatrixXd matrix = array.ToMatrix();
    std::string rows;
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
      std::string row;
      for (Eigen::Index c = 0; c < matrix.cols(); ++c)
        row += (c > 0 ? "," : "") + Concatenate(std::setprecision(17), matrix(r, c));
      rows += (r > 0 ? "," : "") + (matrix.cols() > 1 ? "[" + row + "]" : row);
    }
    text += (text.empty() ? "{\"" : ",\"") + key + "\":" + (matrix.size() > 1 ? "[" + rows + "]" : rows);
  }
  return text + "}";
}

TEST(LoadEstimate, Sam3dBodyAsJson) {
  const BodyEstimate expected = EstimateFromBytes(NpzBytes(Sam3dBody(900)), "e.npz");
  NpzArrays nearer = Sam3dBody(900);
  const BodyEstimate read = EstimateFromBytes("[" + JsonOf(nearer) + "," + JsonOf(Sam3dBody(500)) + "]", "e.json");
  ASSERT_EQ(read.people.size(), 2U);
  EXPECT_EQ(read.people[0].name, "0") << "the longer focal length shows the larger person";
  EXPECT_LT((read.people[0].landmarks[0] - expected.people[0].landmarks[0]).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((read.people[0].trans - expected.people[0].trans).norm(), 1e-12);
  EXPECT_NEAR(read.people[0].cameras[0].fx, 900, 1e-6);
  EXPECT_NEAR(read.people[1].cameras[0].fx, 500, 1e-6);

  // Without the pixels: the focal length that was saved, and the middle of the image.
  nearer.erase("pred_keypoints_2d");
  EXPECT_THAT(ErrorOf(JsonOf(nearer)), HasSubstr("pred_keypoints_2d"));
  nearer["focal_length"] = NdArray::FromDouble(870);
  const BodyEstimate centred = Load(JsonOf(nearer));
  EXPECT_EQ(centred.people[0].cameras[0].fx, 870);
  EXPECT_EQ(centred.people[0].cameras[0].cx, 640);
  EXPECT_THAT(ErrorOf(JsonOf(nearer), {}), HasSubstr("pred_keypoints_2d"));
  EXPECT_THAT(ErrorOf("{\"people\": []}"), HasSubstr("JSON without 'pred_keypoints_3d'"));
  EXPECT_THAT(ErrorOf("{\"pred_keypoints_3d\": [1, 2], \"pred_cam_t\": [0, 0, 1]}"), HasSubstr("pred_keypoints_3d"));

  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.File("sam"));
  for (const int frame : {3, 8}) {
    WriteFileAtomically(folder.File("sam/f_" + std::to_string(frame) + ".json"), "[" + JsonOf(Sam3dBody(900)) + "]");
  }
  WriteFileAtomically(folder.File("sam/run.json"), "{\"fps\": 30}");
  EXPECT_THAT(LoadEstimate(folder.File("sam")).people.at(0).frames, ElementsAre(3, 8));
}

/// SAM3DBody-cpp's rows: frame from 1, place in its list, 70 points.
std::string CsvOf(const std::vector<std::tuple<int, int, RowMatrixXd>>& rows, bool of_a_person = false) {
  std::ostringstream text;
  text << std::setprecision(9) << (of_a_person ? "" : "frame,skeleton_id,");
  for (int k = 0; k < 70; ++k) {
    const std::string name = k == 0 ? "nose" : "p" + std::to_string(k), middle = of_a_person ? "_3D" : "_";
    for (const char* axis : of_a_person ? std::array{"X", "Y", "Z"} : std::array{"x", "y", "z"}) {
      text << (k > 0 || *axis != (of_a_person ? 'X' : 'x') ? "," : "") << name << middle << axis;
    }
  }
  for (const auto& [frame, skeleton, points] : rows) {
    text << "\n";
    if (!of_a_person) text << frame << "," << skeleton << ",";
    for (Eigen::Index i = 0; i < points.size(); ++i) text << (i > 0 ? "," : "") << points.data()[i];
  }
  return text.str() + "\n";
}

/// 70 points of a person who stands, bent by `bend`.
RowMatrixXd Mhr70(double bend) {
  RowMatrixXd points(70, 3);
  for (int k = 0; k < 70; ++k) {
    points.row(k) << 0.3 * std::sin(k + bend), -0.8 + 0.022 * k, 0.2 * std::cos(2.0 * k + bend);
  }
  return points;
}

TEST(LoadEstimate, Sam3dBodyCppIsPlacedByTheDetections) {
  const Camera camera = MakePinhole(kWidth, kHeight, 1000);
  const auto row = [](int frame, int skeleton, double bend) { return std::tuple(frame, skeleton, Mhr70(bend)); };
  // The person changes places in the list; frame 2 (from 1) is another's alone.
  BodyEstimate estimate = Load(CsvOf({row(1, 0, 0.0), row(1, 1, 2.0), row(2, 0, 2.0), row(3, 1, 0.1), row(3, 0, 2.0)}));
  EXPECT_EQ(estimate.system, "SAM3DBody-cpp");
  EXPECT_FALSE(estimate.has_places);
  EXPECT_TRUE(estimate.has_landmarks);
  ASSERT_EQ(estimate.people.size(), 2U);
  const MatrixX3d places = (MatrixX3d(3, 3) << 0.5, 0.1, 4, 0.6, 0.1, 4, 0.7, 0.1, 4.5).finished();
  KeypointSequence seen;
  seen.names = Coco17().names;
  const std::vector<int> mhr = {0, 1, 2, 3, 4, 5, 6, 7, 8, 62, 41, 9, 10, 11, 12, 13, 14};
  for (int t = 0; t < 3; ++t) {
    seen.timestamps.push_back(t);
    const RowMatrixXd points = Mhr70(t == 2 ? 0.1 : 0);
    const Eigen::RowVector3d hips = 0.5 * (points.row(9) + points.row(10));
    for (const int k : mhr) {
      Eigen::Vector2d pixel;
      ASSERT_TRUE(camera.Project((points.row(k) - hips + places.row(t)).transpose(), &pixel));
      seen.points.push_back({float(pixel.x()), float(pixel.y()), 0.9F});
    }
  }
  PlaceByDetections(seen, camera, "e.csv", &estimate);
  ASSERT_EQ(estimate.people.size(), 1U);
  const PersonEstimate& person = estimate.people[0];
  EXPECT_TRUE(estimate.has_places);
  EXPECT_THAT(person.frames, ElementsAre(0, 2));
  EXPECT_LT((person.trans.row(0) - places.row(0)).norm(), 2e-3);
  EXPECT_LT((person.trans.row(1) - places.row(2)).norm(), 2e-3);
  EXPECT_NEAR(person.landmarks[1](0, 1), Mhr70(0.1)(0, 1) - 0.5 * (Mhr70(0.1)(9, 1) + Mhr70(0.1)(10, 1)), 1e-6);
  for (Keypoint& point : seen.points) point.x = 100;
  BodyEstimate nobody = Load(CsvOf({row(1, 0, 0.0)}));
  EXPECT_THAT(FileErrorOf("e.csv", [&] { PlaceByDetections(seen, camera, "e.csv", &nobody); }),
              HasSubstr("in no frame anybody stands as the detections do"));
}

TEST(LoadEstimate, Sam3dBodyCppsRowsAreChecked) {
  const auto row = [](int frame, int skeleton) { return std::tuple(frame, skeleton, Mhr70(0)); };
  const BodyEstimate rows = Load(CsvOf({row(0, 0), std::tuple(0, 0, RowMatrixXd::Zero(70, 3)), row(0, 0)}, true));
  ASSERT_EQ(rows.people.size(), 1U);
  EXPECT_THAT(rows.people[0].frames, ElementsAre(0, 2)) << "a row of zeros is a frame without the person";
  EXPECT_THAT(ErrorOf(CsvOf({row(0, 0)})), HasSubstr("line 2: found '0', expected a whole number from 1"));
  EXPECT_THAT(ErrorOf(CsvOf({row(1, -1)})), HasSubstr("found '-1', expected a whole number from 0"));
  EXPECT_THAT(ErrorOf(CsvOf({row(1, 0), row(1, 0)})), HasSubstr("frame 0 occurs twice"));
  EXPECT_THAT(ErrorOf(CsvOf({})), HasSubstr("nobody in any frame"));
  EXPECT_THAT(ErrorOf(CsvOf({row(1, 0)}) + "2,0,0.5\n"), HasSubstr("line 3: 3 cells, expected 212"));
  EXPECT_THAT(ErrorOf(CsvOf({std::tuple(1, 0, RowMatrixXd::Constant(70, 3, NAN))})), HasSubstr("that is no number"));
  std::string text = CsvOf({row(1, 0)});
  EXPECT_THAT(ErrorOf(text.replace(text.rfind(','), 1, ",x")), HasSubstr("expected a number or nothing"));
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
  EXPECT_THAT(ErrorOf(torch_stream::Archive("}", {})), HasSubstr("without 'smpl_params_incam' or 'body_params_incam'"));
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
  for (const std::string& good :
       {WhamFile({person}), PhalpFile({person}, 1), GvhmrFile(person), GemXFile(person, SomaPose(person)),
        PromptHmrFile({person}, kWidth, kHeight, 900), "[" + JsonOf(Sam3dBody(900)) + "]"}) {
    for (size_t size = 0; size < good.size(); size += 1 + good.size() / 300) ErrorOf(good.substr(0, size));
  }
}

}  // namespace
}  // namespace bodyloom::load_estimate_test
