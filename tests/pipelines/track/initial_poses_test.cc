// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/initial_poses.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/observations_npz.h"
#include "pipelines/synthesis/synthesize_clip.h"
#include "pipelines/track/track_clip.h"
#include "tests/data_tools/estimates/estimate_files.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/support/paths.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom::initial_poses_test {
namespace {

using ::testing::HasSubstr;
using namespace estimate_files;  // NOLINT(google-build-using-namespace)

/// A synthetic clip and what a system like WHAM would have made of it: the true poses of SMPL's joints, in its own
/// camera, with frames missing, beside somebody else.
class InitialPosesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    SynthesizeClipRequest request;
    request.motion = {.name = "demo", .fps = 15, .num_frames = 8};
    request.out = folder_ / "clip";
    request.clip.dense_per_frame = 0;
    clip_ = SynthesizeClip(request).files;
    truth_ = ReadTrack(clip_.truth);
    own_ =
        CentredCamera(truth_.camera.width, truth_.camera.height, std::hypot(truth_.camera.width, truth_.camera.height));
  }

  /// The true person in another system's camera, as that system's body.
  PersonEstimate TruePerson(const std::string& body, const std::vector<int>& frames, const Camera& camera) const {
    PersonEstimate true_person;
    true_person.betas = Eigen::VectorXd::Zero(10);
    for (int t = 0; t < truth_.num_frames(); ++t) {
      true_person.frames.push_back(t);
      true_person.cameras.push_back(truth_.camera);
    }
    true_person.poses = truth_.motion.poses.leftCols<72>();
    true_person.trans = truth_.motion.trans;
    const Eigen::Vector3d pelvis = truth_.joints[0].row(0).transpose() - truth_.motion.trans.row(0).transpose();
    const Motion moved = EstimateInCamera(true_person, camera, truth_.num_frames(), pelvis, MeanPelvis(body));
    PersonEstimate person;
    person.name = "5";
    person.frames = frames;
    person.betas = Eigen::VectorXd::Constant(10, 0.5);
    person.poses.resize(static_cast<Eigen::Index>(frames.size()), 72);
    person.trans.resize(static_cast<Eigen::Index>(frames.size()), 3);
    for (size_t i = 0; i < frames.size(); ++i) {
      person.poses.row(static_cast<Eigen::Index>(i)) = moved.poses.row(frames[i]);
      person.trans.row(static_cast<Eigen::Index>(i)) = moved.trans.row(frames[i]);
    }
    person.cameras.assign(frames.size(), camera);
    return person;
  }

  std::string Write(const std::string& name, const std::string& bytes) const {
    WriteFileAtomically(folder_ / name, bytes);
    return folder_ / name;
  }

  TrackRequest Request(const std::string& init) const {
    TrackRequest request;
    request.detections = clip_.observations;
    request.cameras = clip_.camera;
    request.init = init;
    request.out = folder_ / "track.npz";
    request.json = folder_ / "track.json";
    return request;
  }

  InitialPoses Read(const std::string& path) const {
    const KeypointSequence keypoints = KeypointsFromNpz(ReadNpz(clip_.observations), clip_.observations);
    InitialPosesRequest request;
    request.path = path;
    request.body = &BuiltinBody();
    request.keypoints = &keypoints;
    request.camera = truth_.camera;
    request.num_frames = truth_.num_frames();
    return ReadInitialPoses(request);
  }
  std::string ErrorOf(const std::string& path) const {
    return FileErrorOf(path, [&] { Read(path); });
  }

  void ExpectTruth(const InitialPoses& poses, const std::vector<int>& frames) const {
    EXPECT_EQ(poses.frames, static_cast<int>(frames.size()));
    EXPECT_EQ(poses.motion.num_frames(), truth_.num_frames());
    for (const int t : frames) {
      ASSERT_TRUE(poses.motion.HasPose(t)) << t;
      EXPECT_LT((poses.motion.poses.row(t).head<66>() - truth_.motion.poses.row(t).head<66>()).norm(), 1e-3) << t;
      // The pelvis of the true shape is not the mean shape's.
      EXPECT_LT((poses.motion.trans.row(t) - truth_.motion.trans.row(t)).norm(), 0.05) << t;
    }
  }

  const ScratchFolder folder_;
  SynthClipFiles clip_;
  Track truth_;
  Camera own_;
};

TEST_F(InitialPosesTest, TheTrackedPersonOfAllSystemsInTheCamerasOfAllSystems) {
  const std::vector<int> some = {1, 2, 3, 6}, all = {0, 1, 2, 3, 4, 5, 6, 7};
  const PersonEstimate other = MakePerson("4", all, own_, {3, 0, 4});
  const InitialPoses wham = Read(Write("wham_output.pkl", WhamFile({other, TruePerson("smpl", some, own_)})));
  EXPECT_EQ(wham.system, "WHAM");
  EXPECT_EQ(wham.person, "5");
  EXPECT_EQ(wham.people, 2);
  EXPECT_FALSE(wham.has_shape) << "SMPL's betas are not the built-in body's";
  EXPECT_EQ(wham.motion.betas.size(), 0);
  ExpectTruth(wham, some);
  EXPECT_FALSE(wham.motion.HasPose(0));

  const Camera telephoto = CentredCamera(own_.width, own_.height, 5000.0 / 256 * std::max(own_.width, own_.height));
  PersonEstimate far = MakePerson("4", all, telephoto, {20, 0, 100});
  const InitialPoses phalp = Read(Write("demo.pkl", PhalpFile({far, TruePerson("smpl", some, telephoto)}, 8)));
  EXPECT_EQ(phalp.system, "PHALP");
  ExpectTruth(phalp, some);

  const InitialPoses gvhmr = Read(Write("hmr4d_results.pt", GvhmrFile(TruePerson("smplx", all, own_))));
  EXPECT_EQ(gvhmr.system, "GVHMR");
  ExpectTruth(gvhmr, all);

  const PersonEstimate smplx = TruePerson("smplx", all, own_);
  const InitialPoses gem = Read(Write("smpl_params.pt", GemFile(smplx)));
  EXPECT_EQ(gem.system, "GEM");
  ExpectTruth(gem, all);

  PersonEstimate hips = smplx;  // whose translation is that of the hips
  hips.trans.rowwise() += MeanPelvis("smplx").transpose();
  const InitialPoses gem_x = Read(Write("hpe_results.pt", GemXFile(hips, SomaPose(hips))));
  EXPECT_EQ(gem_x.system, "GEM-X");
  ExpectTruth(gem_x, all);

  const std::vector<PersonEstimate> two = {other, TruePerson("smplx", some, own_)};
  const InitialPoses prompthmr =
      Read(Write("results.pkl", PromptHmrFile(two, own_.width / 2, own_.height / 2, float(own_.fx / 2))));
  EXPECT_EQ(prompthmr.system, "PromptHMR");
  EXPECT_EQ(prompthmr.person, "5");
  ExpectTruth(prompthmr, some);

  const InitialPoses track = Read(clip_.truth);
  EXPECT_EQ(track.system, "track");
  EXPECT_TRUE(track.has_shape);
  EXPECT_LT((track.motion.trans - truth_.motion.trans).norm(), 1e-6);
}

TEST_F(InitialPosesTest, SaysWhatDoesNotFit) {
  const PersonEstimate other = MakePerson("4", {0, 1, 2}, own_, {3, 0, 4});
  EXPECT_THAT(ErrorOf(Write("other.pkl", WhamFile({other}))),
              HasSubstr("WHAM: of 1 person in it nobody is where the detections have the person"));
  PersonEstimate longer = TruePerson("smpl", {0, 1, 2}, own_);
  longer.frames.back() = 8;
  EXPECT_THAT(ErrorOf(Write("longer.pkl", WhamFile({longer}))),
              HasSubstr("person 5: frame 8 (from 0), expected none beyond the 8 of the detections"));
  EXPECT_THAT(ErrorOf(Write("short.pt", GvhmrFile(TruePerson("smplx", {0, 1, 2}, own_)))),
              HasSubstr("3 frames, expected the 8 of the detections"));

  const Camera larger = CentredCamera(2 * own_.width, 2 * own_.height, 2 * own_.fx);
  EXPECT_THAT(ErrorOf(Write("larger.pt", GvhmrFile(TruePerson("smplx", {0, 1, 2, 3, 4, 5, 6, 7}, larger)))),
              HasSubstr("made on images of 1920x1440, expected 960x720"));
  EXPECT_THAT(ErrorOf(Write("text.npz", "text")), HasSubstr("unknown kind of file; expected a track .npz"));
}

TEST_F(InitialPosesTest, TheReportSaysHowFarItMovedAndWhatThatGained) {
  PersonEstimate person = TruePerson("smpl", {0, 1, 2, 3, 4, 5}, own_);
  for (Eigen::Index i = 0; i < person.poses.rows(); ++i) person.poses(i, 3 * 16) += 0.3;  // a raised left arm
  const TrackRequest request = Request(Write("wham_output.pkl", WhamFile({person})));
  const TrackReport report = TrackClip(request);
  ASSERT_TRUE(report.initialiser.has_value());
  const InitialiserGain& gain = report.initialiser->gain;
  EXPECT_EQ(gain.frames, 6);
  EXPECT_GT(gain.landmarks, 0);
  EXPECT_LT(gain.fit_px.median, gain.initialiser_px.median);
  const nlohmann::json json = nlohmann::json::parse(FileBytes(request.json))["initialiser"];
  EXPECT_EQ(json["system"], "WHAM");
  EXPECT_EQ(json["person"], "5");
  EXPECT_EQ(json["frames"], 6);
  EXPECT_EQ(json["joint_median_mm"], gain.joint_mm.median);
  EXPECT_EQ(json["rotation_p95_deg"], gain.rotation_deg.p95);
  EXPECT_EQ(json["initialiser_median_px"], gain.initialiser_px.median);
  EXPECT_EQ(json["fit_median_px"], gain.fit_px.median);
  const std::string text = ToText(report);
  EXPECT_THAT(text, HasSubstr("start    WHAM, person 5, 6 of 8 frames; its shape is another body's and left out\n"));
  EXPECT_THAT(text, HasSubstr("\nmoved    joints by "));
  EXPECT_THAT(text, HasSubstr("\ngain     2D joints: "));
}

TEST_F(InitialPosesTest, WithoutOneTheReportIsSilent) {
  const TrackReport report = TrackClip(Request(""));
  EXPECT_FALSE(report.initialiser.has_value());
  EXPECT_FALSE(nlohmann::json::parse(ToJson(report)).contains("initialiser"));
}

// The real file beside its own "2D": the start cannot be improved upon, because it is what the joints were drawn from.
TEST(Sam3dBody, AStartOfLandmarksAlone) {
  const std::string path = SharedDir() + "/data/mhr_sam3d/img_subj01.npz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared/data/mhr_sam3d beside the repository";
  const ScratchFolder folder;
  const NpzArrays arrays = ReadNpz(path);
  const RowMatrixXd pixels = arrays.at("pred_keypoints_2d").ToMatrix();
  KeypointSequence joints;
  joints.convention = "coco17";
  joints.names = CocoNames();
  joints.timestamps = {0};
  joints.image_width = 1920;
  joints.image_height = 890;
  for (const int k : {0, 1, 2, 3, 4, 5, 6, 7, 8, 62, 41, 9, 10, 11, 12, 13, 14}) {
    joints.points.push_back({static_cast<float>(pixels(k, 0)), static_cast<float>(pixels(k, 1)), 0.9F});
  }
  WriteObservations(folder / "joints.npz", &joints, nullptr);
  TrackRequest request;
  request.detections = folder / "joints.npz";
  request.focal_px = 2535.266;
  request.init = path;
  request.out = folder / "track.npz";
  const TrackReport report = TrackClip(request);
  ASSERT_TRUE(report.initialiser.has_value());
  EXPECT_TRUE(report.initialiser->gives_landmarks);
  const InitialiserGain& gain = report.initialiser->gain;
  EXPECT_EQ(gain.frames, 1);
  EXPECT_LT(gain.initialiser_px.p95, 0.1);
  EXPECT_LT(gain.fit_px.median, 15) << "of a person 700 px high";
  EXPECT_LT(gain.joint_mm.median, 100);
  EXPECT_THAT(ToText(report), HasSubstr("start    SAM 3D Body, person 0, 1 of 1 frames; 3D landmarks alone\n"));
}

// The real people as SAM3DBody-cpp writes them: landmarks without a place, in one list.
TEST(Sam3dBody, SkeletonsWithoutAPlaceStandWhereTheDetectionsAre) {
  const std::string folder = SharedDir() + "/data/mhr_sam3d/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared/data/mhr_sam3d beside the repository";
  const ScratchFolder scratch;
  const std::string path = scratch / "points.csv";
  std::string text = "frame,skeleton_id,nose_x,nose_y,nose_z";
  for (int k = 3; k < 3 * 70; ++k) text += ",c";
  KeypointSequence joints;
  joints.names = CocoNames();
  joints.timestamps = {0};
  for (const int person : {0, 1}) {
    const NpzArrays arrays = ReadNpz(folder + "img_subj0" + std::to_string(person) + ".npz");
    text += "\n1," + std::to_string(person);
    for (const double value : arrays.at("pred_keypoints_3d").ToDoubles()) text += "," + std::to_string(value);
    if (person == 0) continue;
    const RowMatrixXd pixels = arrays.at("pred_keypoints_2d").ToMatrix();
    for (const int k : {0, 1, 2, 3, 4, 5, 6, 7, 8, 62, 41, 9, 10, 11, 12, 13, 14}) {
      joints.points.push_back({static_cast<float>(pixels(k, 0)), static_cast<float>(pixels(k, 1)), 0.9F});
    }
  }
  WriteFileAtomically(path, text + "\n");
  InitialPosesRequest request;
  request.path = path;
  request.body = &BuiltinBody();
  request.camera = CentredCamera(1920, 890, 2535.266);
  request.num_frames = 1;
  EXPECT_THAT(FileErrorOf(path, [&] { ReadInitialPoses(request); }), HasSubstr("give 2D joints, too"));
  request.keypoints = &joints;
  const InitialPoses placed = ReadInitialPoses(request);
  request.path = folder + "img_subj01.npz";
  const InitialPoses written = ReadInitialPoses(request);
  ASSERT_EQ(placed.frames, 1);
  EXPECT_EQ(placed.system, "SAM3DBody-cpp");
  EXPECT_LT((placed.landmarks[0] - written.landmarks[0]).rowwise().norm().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace bodyloom::initial_poses_test
