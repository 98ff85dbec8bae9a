// SPDX-License-Identifier: Apache-2.0
/// The fuzzers' functions on a few thousand fixed mutations of valid files.
#include "tests/fuzz/fuzz_array_targets.h"
#include "tests/fuzz/fuzz_file_targets.h"
#include "tests/fuzz/fuzz_network_targets.h"
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

}  // namespace
}  // namespace bodyloom::fuzz::fuzz_corpus_test
