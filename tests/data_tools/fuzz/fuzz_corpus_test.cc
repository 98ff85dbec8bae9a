// SPDX-License-Identifier: Apache-2.0
/// The fuzzers' functions on a few thousand fixed mutations of valid files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "data_tools/formats/element_type.h"
#include "data_tools/formats/mat_headers.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/fuzz/fuzz_seeds.h"
#include "tests/fuzz/fuzz_array_targets.h"
#include "tests/fuzz/fuzz_file_targets.h"
#include "tests/fuzz/fuzz_network_targets.h"
#include "tests/fuzz/fuzz_run_targets.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/fuzz_text_targets.h"
#include "tests/fuzz/run_mutations.h"

namespace bodyloom::fuzz::fuzz_corpus_test {
namespace {

TEST(FuzzCorpus, Npz) { RunMutations("npz", AcceptsNpz, 4000); }
TEST(FuzzCorpus, Pickle) { RunMutations("pickle", AcceptsPickle, 4000); }
TEST(FuzzCorpus, Weights) { RunMutations("weights", AcceptsWeights, 4000); }
TEST(FuzzCorpus, Body) { RunMutations("body", AcceptsBody, 3000); }
TEST(FuzzCorpus, Track) { RunMutations("track", AcceptsTrack, 4000); }
TEST(FuzzCorpus, Obj) { RunMutations("obj", AcceptsObj, 4000); }
TEST(FuzzCorpus, Detections) { RunMutations("detections", AcceptsDetections, 6000); }
TEST(FuzzCorpus, DeepLabCut) { RunMutations("deeplabcut", AcceptsDeepLabCut, 4000); }
TEST(FuzzCorpus, VideoPose3d) { RunMutations("videopose3d", AcceptsVideoPose3d, 4000); }
TEST(FuzzCorpus, Cameras) { RunMutations("cameras", AcceptsCameras, 4000); }
TEST(FuzzCorpus, Rig) { RunMutations("rig", AcceptsRig, 4000); }
TEST(FuzzCorpus, CameraPath) { RunMutations("camera_path", AcceptsCameraPath, 4000); }
TEST(FuzzCorpus, Bvh) { RunMutations("bvh", AcceptsBvh, 4000); }
TEST(FuzzCorpus, AsfAmc) { RunMutations("asf_amc", AcceptsAsfAmc, 4000); }
TEST(FuzzCorpus, DeepMimic) { RunMutations("deepmimic", AcceptsDeepMimic, 4000); }
TEST(FuzzCorpus, Observations) { RunMutations("observations", AcceptsObservations, 4000); }
TEST(FuzzCorpus, PartLabels) { RunMutations("part_labels", AcceptsPartLabels, 4000); }
TEST(FuzzCorpus, Avatar) { RunMutations("avatar", AcceptsAvatar, 4000); }
TEST(FuzzCorpus, PosePrior) { RunMutations("pose_prior", AcceptsPosePrior, 500); }
TEST(FuzzCorpus, Lifter) { RunMutations("lifter", AcceptsLifter, 2000); }
TEST(FuzzCorpus, Parser) { RunMutations("parser", AcceptsParser, 200); }
TEST(FuzzCorpus, LeftHalf) { RunMutations("left_half", AcceptsLeftHalf, 50); }
TEST(FuzzCorpus, Motion) { RunMutations("motion", AcceptsMotion, 4000); }
TEST(FuzzCorpus, DetectionsFile) { RunMutations("detections_file", AcceptsDetectionsFile, 4000); }
TEST(FuzzCorpus, Estimate) { RunMutations("estimate", AcceptsEstimate, 4000); }
TEST(FuzzCorpus, VideoTruth) { RunMutations("video_truth", AcceptsVideoTruth, 4000); }
TEST(FuzzCorpus, Rich) { RunMutations("rich", AcceptsRich, 4000); }
TEST(FuzzCorpus, Human36m) { RunMutations("human36m", AcceptsHuman36m, 4000); }
TEST(FuzzCorpus, Image) { RunMutations("image", AcceptsImage, 500); }
TEST(FuzzCorpus, Video) { RunMutations("video", AcceptsVideo, 300); }
TEST(FuzzCorpus, SinglePersonDataset) { RunMutations("single_person_dataset", AcceptsSinglePersonDataset, 1000); }
TEST(FuzzCorpus, Split) { RunMutations("split", AcceptsSplit, 4000); }
TEST(FuzzCorpus, Mat) { RunMutations("mat", AcceptsMat, 300); }
TEST(FuzzCorpus, Tflite) { RunMutations("tflite", AcceptsTflite, 4000); }
TEST(FuzzCorpus, Onnx) { RunMutations("onnx", AcceptsOnnx, 4000); }
TEST(FuzzCorpus, KeypointOutputs) { RunMutations("keypoint_outputs", AcceptsKeypointOutputs, 4000); }
TEST(FuzzCorpus, Cage) { RunMutations("cage", AcceptsCage, 4000); }

// Inputs of jobs other than weights, images and observations, without LibTorch: a run's config.json, the light, a
// batch's manifest and records.

TEST(FuzzCorpus, RunConfig) { RunMutations("run_config", AcceptsRunConfig, 2000); }
TEST(FuzzCorpus, Manifest) { RunMutations("manifest", AcceptsManifest, 4000); }
TEST(FuzzCorpus, ClipRecord) { RunMutations("clip_record", AcceptsClipRecord, 4000); }
TEST(FuzzCorpus, Relight) { RunMutations("relight", AcceptsRelight, 2000); }

/// The seed with one number exchanged.
std::string WithNumber(const std::string& key, const std::string& number) {
  std::string json = Seeds().at("run_config")[0];
  const size_t at = json.find("\"" + key + "\":") + key.size() + 3, end = json.find_first_of(",}", at);
  return json.replace(at, end - at, number);
}

TEST(RunConfigNumbers, OutOfRangeIsRefusedBeforeItIsMultiplied) {
  EXPECT_TRUE(AcceptsRunConfig(WithNumber("past", "10")));
  EXPECT_TRUE(AcceptsRunConfig(WithNumber("reach", "128")));
  for (const char* past : {"-1", "11", "715827882", "1431655775", "2147483647", "2147483648", "1e300", "10.5"}) {
    EXPECT_FALSE(AcceptsRunConfig(WithNumber("past", past))) << past;
  }
  for (const char* reach : {"-1", "129", "2147483647", "1e19"}) {
    EXPECT_FALSE(AcceptsRunConfig(WithNumber("reach", reach))) << reach;
  }
  for (const char* number : {"0", "-30", "1e999", "null"}) {
    EXPECT_FALSE(AcceptsRunConfig(WithNumber("fps", number))) << number;
    EXPECT_FALSE(AcceptsRunConfig(WithNumber("pixels_per_metre", number))) << number;
  }
}

using testing::HasSubstr;

/// A MATLAB file of one variable from 32-bit words.
std::string MatOf(const std::vector<uint32_t>& words) {
  std::string bytes = std::string(124, ' ') + std::string("\0\1IM", 4);
  for (const uint32_t word : words) bytes.append(reinterpret_cast<const char*>(&word), sizeof(word));
  return bytes;
}

std::string ErrorOfMat(const std::string& bytes) {
  const TemporaryFolder folder;
  const std::string path = folder.File("fuzz.mat");
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    CheckMatHeaders(path);
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("fuzz.mat"));
    return error.what();
  }
  return "";
}

// Minimised inputs of faults found by libFuzzer.

// libmatio took 3.6 GB for the dimensions that this file claims.
TEST(FuzzFound, MatlabHeadersThatAskForGigabytes) {
  const std::vector<uint32_t> good = {14, 56, 6, 8, 6, 0, 5, 8, 1, 1, 0x00010001, 'a', 9, 8, 0, 0};
  EXPECT_EQ(ErrorOfMat(MatOf(good)), "");
  const auto with = [&](size_t at, uint32_t value) {
    std::vector<uint32_t> words = good;
    words[at] = value;
    return ErrorOfMat(MatOf(words));
  };
  EXPECT_THAT(with(7, 0xe0000008), HasSubstr("byte 128: a matrix whose sizes take 3758096392 bytes"));
  EXPECT_THAT(with(7, 4), HasSubstr("sizes take 4 bytes"));
  EXPECT_THAT(with(1, 57), HasSubstr("beyond the end of the file"));
  EXPECT_THAT(with(1, 0xffffffff), HasSubstr("beyond the end of the file"));
  EXPECT_THAT(with(1, 16), HasSubstr("cut short"));
  EXPECT_THAT(with(4, 2), HasSubstr("class 2, expected a matrix of numbers"));  // a structure: its fields are counted
  EXPECT_THAT(with(2, 7), HasSubstr("without flags"));
  EXPECT_THAT(with(0, 9), HasSubstr("data of type 9"));
  EXPECT_THAT(with(0, 15), HasSubstr("cut short"));  // not compressed data at all
  EXPECT_THAT(with(10, 1), HasSubstr("name takes 97 bytes"));
  // Neither version 5 nor 7.3: taken for version 4, and 500 MB for a name of 187 bytes.
  std::string other = MatOf(good);
  for (const size_t at : {124, 125, 126, 127}) {
    other[at] ^= 2;
    EXPECT_THAT(ErrorOfMat(other), HasSubstr("not a MATLAB version 5 file")) << at;
    other[at] ^= 2;
  }
  EXPECT_THAT(ErrorOfMat(other.substr(0, 127)), HasSubstr("not a MATLAB version 5 file"));
  EXPECT_FALSE(AcceptsMat(MatOf({14, 0xa0, 6, 8, 0xfffffe06, 0xd8, 5, 0xe0000008})));
}

// OpenCV hands such files to GDCM, which ended the process.
TEST(FuzzFound, ImagesThatAreTakenForDicom) {
  EXPECT_FALSE(AcceptsImage(std::string(128, ';') + "DICM;"));
  EXPECT_FALSE(AcceptsImage("RIFF;;;;WEBP" + std::string(116, ';') + "DICM;"));
}

// Text of no bytes in the other order took forever; text of some was turned around.
TEST(FuzzFound, BytesHaveNoOrder) {
  const auto read = [](const std::string& type, const std::string& bytes) {
    return ArrayFromBytes(*ParseElementType(type), {2}, false, bytes);
  };
  EXPECT_EQ(read(">a0", "").bytes, "");
  EXPECT_EQ(read(">S3", "abcdef").bytes, "abcdef");
  EXPECT_EQ(read(">u2", "abcd").bytes, "badc");
  EXPECT_EQ(read(">U1", "abcdefgh").bytes, "dcbahgfe");
}

// The body's landmarks, tracks and observations name their file; so must every array of whole numbers.
TEST(FuzzFound, IndicesThatAreNoWholeNumbers) {
  const std::vector<double> values = {1.0625, 2};
  NpzArrays observations = FramedArrays(Seeds().at("observations")[0]);
  ASSERT_EQ(observations.at("dense_frame").shape, std::vector<int64_t>{2});
  for (const char* name : {"dense_frame", "dense_face"}) {
    NpzArrays broken = observations;
    broken[name] = NdArray::FromDoubles(values.data(), {2});
    broken.erase("keypoints");
    EXPECT_FALSE(AcceptsObservations(FrameArrays(broken))) << name;
  }
  NpzArrays lifter = FramedArrays(Seeds().at("lifter")[0]);
  lifter["dilations"] = NdArray::FromDoubles(values.data(), {2});
  EXPECT_FALSE(AcceptsLifter(FrameArrays(lifter)));
  lifter["dilations"] = NdArray::FromString("two");
  EXPECT_FALSE(AcceptsLifter(FrameArrays(lifter)));
}

}  // namespace

}  // namespace bodyloom::fuzz::fuzz_corpus_test
