// SPDX-License-Identifier: Apache-2.0
#include "tests/data_tools/fuzz/fuzz_array_seeds.h"

#include <matio.h>

#include <cmath>
#include <memory>

#include "data_tools/avatar/avatar_file.h"
#include "data_tools/body_making/make_builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/inflate.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/zip.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/parser_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_writer.h"
#include "tests/data_tools/datasets/still_camera_files.h"
#include "tests/data_tools/datasets/video_truth_files.h"
#include "tests/data_tools/estimates/estimate_files.h"
#include "tests/data_tools/formats/pickle_writer.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/random_image_unet.h"
#include "tests/support/stick_person.h"
#include "tests/support/toy_body.h"

namespace bodyloom::fuzz {
namespace {

/// Bytes that a writer writes to a file.
template <typename Write>
std::string BytesOf(const std::string& name, const Write& write) {
  const TemporaryFolder folder;
  write(folder.File(name));
  return ReadFileBytes(folder.File(name));
}

template <typename Write>
std::string FramedBytesOf(const Write& write) {
  return FrameArrays(ReadNpzBytes(BytesOf("arrays.npz", write), "arrays.npz"));
}

KeypointSequence TwoFrames() {
  KeypointSequence keypoints;
  keypoints.convention = "coco17";
  keypoints.names = {"nose", "left_hip"};
  keypoints.timestamps = {0, 0.04};
  keypoints.points = {{1, 2, 0.5F}, {3, 4, 1}, {5, 6, 0}, {7, 8, 0.25F}};
  keypoints.image_width = 640;
  keypoints.image_height = 480;
  return keypoints;
}

DenseSequence TwoDenseFrames() {
  DenseSequence dense;
  dense.frames.resize(2);
  dense.frames[1].resize(2);
  dense.timestamps = {0, 0.04};
  dense.image_width = 640;
  dense.image_height = 480;
  dense.uv_sigma = 0.02;
  return dense;
}

AvatarCheckpoint SmallAvatar(bool has_garment) {
  GaussianBody body;
  body.Resize(3);
  for (int i = 0; i < body.size(); ++i) {
    body.joints[GaussianBody::kInfluences * i + 1] = i;
    body.anchors[i].face = 2 - i;
    body.parameters(i, GaussianBody::kPosition + 1) = 0.5F * static_cast<float>(i);
  }
  AvatarCheckpoint checkpoint;
  checkpoint.avatar.betas = Eigen::VectorXd::Constant(2, 0.5);
  checkpoint.avatar.num_joints = checkpoint.avatar.num_vertices = checkpoint.avatar.num_faces = 4;
  if (has_garment) {
    AvatarGarment& garment = checkpoint.avatar.garment.emplace();
    garment.offsets_m.assign(4, 0.01F);
    garment.nodes = MatrixX3f::Constant(2, 3, 0.25F);
    body.joints[0] = 5, body.kinds[0] = GaussianKind::kCloth;
  }
  checkpoint.state = AvatarTrainingState::Of(std::move(body));
  checkpoint.options = "{}";
  return checkpoint;
}

PosePrior SmallPrior() {
  PosePrior prior = BuiltinPosePrior();
  prior.joints.resize(2);
  prior.log_weights = Eigen::VectorXd::Zero(1);
  prior.means = RowMatrixXd::Zero(1, 6);
  prior.covariances = {Eigen::MatrixXd::Identity(6, 6)};
  return prior;
}

LifterWeights SmallLifter() {
  LifterWeights weights;
  weights.input = RowMatrixXf::Ones(2, 3);
  weights.input_bias = weights.norm_scale = weights.norm_shift = Eigen::VectorXf::Ones(2);
  LifterWeights::Block& block = weights.blocks.emplace_back();
  block.norm_scale = block.norm_shift = block.dilated_bias = block.mix_bias = Eigen::VectorXf::Ones(2);
  block.dilated = RowMatrixXf::Ones(2, 6);
  block.mix = RowMatrixXf::Ones(2, 2);
  weights.output = RowMatrixXf::Ones(LifterOutput::kSize, 2);
  weights.output_bias = Eigen::VectorXf::Zero(LifterOutput::kSize);
  weights.recipe = "none";
  return weights;
}

std::string PartLabels() {
  std::vector<uint8_t> labels(size_t{2} * 6 * 5, 0);
  for (const size_t i : {7U, 8U, 12U, 13U, 37U, 38U, 42U}) labels[i] = 2;
  NpzArrays arrays;
  arrays["labels"] = NdArray::FromUInt8(labels.data(), {2, 6, 5});
  const std::vector<double> times = {0, 0.04};
  arrays["timestamps"] = NdArray::FromDoubles(times.data(), {2});
  return FrameArrays(arrays);
}

std::string Masks() {
  PartLabelSequence mask;
  mask.image_width = 7, mask.image_height = 6;
  mask.frames = {LabelImage{1, 2, 3, 2, {0, 1, 1, 1, 0, 0}}, {}};
  NpzArrays arrays = MaskRuns(mask);
  arrays["label_kind"] = NdArray::FromString("person");
  return FrameArrays(arrays);
}

/// DensePose's file for the toy body's first faces, each corner a point of its own.
std::string MatBytes() {
  constexpr size_t kFaces = 4;
  const BodyModelData& body = ToyBody().data();
  std::vector<double> faces(3 * kFaces), parts, vertices, u, v;
  for (size_t f = 0; f < kFaces; ++f) {
    parts.push_back(static_cast<double>(f + 1));
    for (size_t c = 0; c < 3; ++c) {
      faces[c * kFaces + f] = static_cast<double>(vertices.size() + 1);
      vertices.push_back(body.faces(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(c)) + 1);
      u.push_back(0.25);
      v.push_back(0.5);
    }
  }
  return BytesOf("parts.mat", [&](const std::string& path) {
    const std::unique_ptr<mat_t, decltype(&Mat_Close)> file(Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5),
                                                            &Mat_Close);
    const auto add = [&](const char* name, size_t rows, size_t columns, std::vector<double> values) {
      size_t dims[] = {rows, columns};
      const std::unique_ptr<matvar_t, decltype(&Mat_VarFree)> variable(
          Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, values.data(), 0), &Mat_VarFree);
      Mat_VarWrite(file.get(), variable.get(), MAT_COMPRESSION_NONE);
    };
    add("All_Faces", kFaces, 3, faces);
    add("All_FaceIndices", kFaces, 1, parts);
    add("All_vertices", 1, vertices.size(), vertices);
    add("All_U_norm", u.size(), 1, u);
    add("All_V_norm", v.size(), 1, v);
  });
}

/// Two frames as AMASS stores them; not compressed, so that a mutation reaches the arrays.
std::string AmassBytes() {
  const std::vector<double> values(size_t{2} * 156, 0.1);
  return MakeZip({{"poses.npy", NpyBytes(NdArray::FromDoubles(values.data(), {2, 156}))},
                  {"trans.npy", NpyBytes(NdArray::FromDoubles(values.data(), {2, 3}))},
                  {"betas.npy", NpyBytes(NdArray::FromDoubles(values.data(), {16}))},
                  {"mocap_framerate.npy", NpyBytes(NdArray::FromDouble(120))}},
                 0);
}

std::string PersonJson() {
  std::string labels;
  for (const char* name : kPersonLabelNames) labels += (labels.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  return R"({"format": "bodyloom person set", "version": 1, "frames": 1, "width": 4, "height": 3, "fps": 30, "labels": [)" +
         labels +
         R"(], "has": {"labels": true, "normals": false, "iuv": true, "background": false}, "seed": 3, "motion": ")" +
         std::string(600, 'm') + R"("})";
}

void WriteThreeFrames(const std::string& path) {
  VideoWriter writer(path, 32, 16, 25);
  for (const uint8_t level : {20, 120, 220}) writer.Write(Image(32, 16, {level, 100, 3}));
  writer.Finish();
}

/// SAM 3D Body's 70 points, 2 m away, seen by a camera of 640×480 pixels.
RowMatrixXd MhrPoints() {
  RowMatrixXd points(70, 3);
  for (int k = 0; k < 70; ++k) points.row(k) << 0.3 * std::sin(k), 0.02 * k - 0.7, 0.1 * std::cos(2.0 * k);
  return points;
}

std::string Sam3dBodyJson() {
  RowMatrixXd points = MhrPoints(), pixels(70, 2);
  for (int k = 0; k < 70; ++k) {
    pixels.row(k) = 500 / (points(k, 2) + 2) * points.row(k).head<2>() + Eigen::RowVector2d(320, 240);
  }
  return "[{\"pred_keypoints_3d\": " + JsonRows(points) + ", \"pred_keypoints_2d\": " + JsonRows(pixels) +
         ", \"pred_cam_t\": [0, 0, 2], \"focal_length\": 500}]";
}

/// Two frames of SAM3DBody-cpp.
std::string Sam3dBodyCsv() {
  std::string text = "frame,skeleton_id,nose_x,nose_y,nose_z";
  for (int k = 1; k < 70; ++k) {
    for (const char* axis : {"_x", "_y", "_z"}) text += ",p" + std::to_string(k) + axis;
  }
  const RowMatrixXd points = MhrPoints();
  for (const char* row : {"\n1,0", "\n2,0"}) {
    text += row;
    for (Eigen::Index i = 0; i < points.size(); ++i) text += "," + std::to_string(points.data()[i]);
  }
  return text + "\n";
}

/// WHAM's, VIBE's and PromptHMR's results (PHALP's are compressed, which no mutation survives; here they are not),
/// GVHMR's and GEM's tensors, SAM 3D Body's texts.
std::vector<std::string> EstimateSeeds() {
  using namespace estimate_files;  // NOLINT(google-build-using-namespace)
  Camera camera = MakePinhole(640, 480, 800);
  const PersonEstimate person = MakePerson("1", {0, 2}, camera, {0.2, 0, 4});
  NpzArrays gvhmr;
  const std::vector<double> values(2 * 63, 0.25), k = {800, 0, 320, 0, 800, 240, 0, 0, 1};
  gvhmr["smpl_params_incam.body_pose"] = NdArray::FromDoubles(values.data(), {1, 63});
  gvhmr["smpl_params_incam.global_orient"] = NdArray::FromDoubles(values.data(), {1, 3});
  gvhmr["smpl_params_incam.transl"] = NdArray::FromDoubles(values.data(), {1, 3});
  gvhmr["smpl_params_incam.betas"] = NdArray::FromDoubles(values.data(), {1, 10});
  gvhmr["K_fullimg"] = NdArray::FromDoubles(k.data(), {1, 3, 3});
  camera.model = CameraModel::kWeakPerspective;
  camera.scale = 200;
  NpzArrays gem_x;
  const std::vector<double> soma(228, 0.1);
  gem_x["body_params_incam.body_pose"] = NdArray::FromDoubles(soma.data(), {1, 228});
  for (const char* key : {"global_orient", "transl"}) {
    gem_x[std::string("body_params_incam.") + key] = NdArray::FromDoubles(values.data(), {1, 3});
  }
  gem_x["K_fullimg"] = gvhmr["K_fullimg"];
  return {WhamFile({person}),
          VibeFile({MakePerson("1", {0, 2}, camera, {0, 0, 0})}),
          Inflate(PhalpFile({person}, 3), "seed.pkl", size_t{1} << 20),
          FrameArrays(gvhmr),
          PromptHmrFile({person}, 640, 480, 700),
          FrameArrays(gem_x),
          Sam3dBodyJson(),
          Sam3dBodyCsv()};
}

/// Two people of two frames whose camera moves, in the form of either data set.
std::vector<std::string> VideoTruthSeeds() {
  Track track;
  track.motion.poses = RowMatrixXd::Constant(2, 72, 0.1);
  track.motion.trans = MatrixX3d::Constant(2, 3, 0.5);
  track.motion.betas = Eigen::VectorXd::Zero(10);
  track.camera = MakePinhole(640, 480, 800);
  track.camera_from_scene.resize(2);
  const std::vector<uint8_t> good = {1, 0};
  return {EmdbPickle(track, good, "male"), ThreeDpwPickle({track, track}, {good, good})};
}

/// A motion of two frames, of 66 columns of which the rest is 0.
Motion TwoPoses() {
  Motion motion;
  motion.poses = RowMatrixXd::Constant(2, 72, 0.1);
  motion.trans = MatrixX3d::Constant(2, 3, 0.5);
  motion.betas = Eigen::VectorXd::Constant(10, 0.25);
  return motion;
}

/// positions_2d and metadata of a set of one video, one after the other.
std::string VideoPose3dPickles() {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const std::string cameras = "](" + Doubles2(std::vector<double>(2 * 17 * 2, 50), {2, 17, 2}) + "e";
  return Pickle(2, Dict({{Str2("a.mp4"), Dict({{Str2("custom"), cameras}})}})) +
         Pickle(2, Dict({{Str2("layout_name"), Str2("coco")},
                         {Str2("keypoints_symmetry"), "](](" + Int(1) + "e](" + Int(2) + "ee"},
                         {Str2("video_metadata"),
                          Dict({{Str2("a.mp4"), Dict({{Str2("w"), Int(640)}, {Str2("h"), Int(480)}})}})}}));
}

/// COCO's landmarks with confidences as a bare array.
std::string KeypointArrayBytes() {
  std::vector<double> values;
  for (int t = 0; t < 2; ++t) {
    for (const std::string& name : Coco17().names) {
      const auto [x, y] = StickLandmark(name, 100, 200, 300);
      values.insert(values.end(), {x, y, 0.5});
    }
  }
  return NpyBytes(NdArray::FromDoubles(values.data(), {2, 17, 3}));
}

}  // namespace

void AddArraySeeds(std::map<std::string, std::vector<std::string>>* seeds) {
  const KeypointSequence keypoints = TwoFrames();
  const DenseSequence dense = TwoDenseFrames();
  const auto write = [&](const std::string& path) { WriteObservations(path, &keypoints, &dense); };
  (*seeds)["observations"] = {FramedBytesOf(write)};
  (*seeds)["part_labels"] = {PartLabels(), Masks()};
  (*seeds)["videopose3d"] = {VideoPose3dPickles()};
  for (const bool has_garment : {false, true}) {
    (*seeds)["avatar"].push_back(
        FramedBytesOf([&](const std::string& path) { WriteAvatarCheckpoint(path, SmallAvatar(has_garment)); }));
  }
  (*seeds)["pose_prior"] = {FramedBytesOf([](const std::string& path) { WritePosePrior(path, SmallPrior()); })};
  (*seeds)["lifter"] = {FramedBytesOf([](const std::string& path) { WriteLifterWeights(path, SmallLifter()); })};
  (*seeds)["parser"] = {FramedBytesOf([](const std::string& path) { WriteParserWeights(path, RandomParser(1)); })};
  (*seeds)["left_half"] = {FrameArrays(ReadNpzBytes(EmbeddedBuiltinBodySources().parts_bytes, "parts.npz"))};
  (*seeds)["motion"] = {(*seeds)["deepmimic"][0], AmassBytes()};
  (*seeds)["detections_file"] = (*seeds)["detections"];
  (*seeds)["detections_file"].push_back(BytesOf("observations.npz", write));
  const std::vector<double> landmarks(2 * 33 * 2, 100);
  (*seeds)["detections_file"].push_back(NpyBytes(NdArray::FromDoubles(landmarks.data(), {2, 33, 2})));
  (*seeds)["detections_file"].push_back(KeypointArrayBytes());
  (*seeds)["detections_file"].push_back((*seeds)["deeplabcut"][0]);
  (*seeds)["estimate"] = EstimateSeeds();
  (*seeds)["video_truth"] = VideoTruthSeeds();
  (*seeds)["rich"] = {RichXml(RoomCamera()), RichPickle(TwoPoses(), 0)};
  const std::vector<MatrixX3d> joints(2, MatrixX3d::Constant(17, 3, 0.5));
  (*seeds)["human36m"] = {Human36mJointsJson(joints), Human36mSmplJson(TwoPoses(), 1),
                          pickle_writer::Pickle(2, Human36mPositions(joints))};
  (*seeds)["cameras"].push_back(Human36mCameraJson(RoomCamera(), false));
  Image image(6, 4, {12, 200, 3});
  (*seeds)["image"] = {BytesOf("image.png", [&](const std::string& path) { WriteImage(path, image); }),
                       BytesOf("image.jpg", [&](const std::string& path) { WriteImage(path, image); })};
  (*seeds)["video"] = {BytesOf("video.mp4", WriteThreeFrames)};
  (*seeds)["single_person_dataset"] = {PersonJson()};
  (*seeds)["split"] = {"# name class part\n05_02 dance train\ncmu_bvh/05_03  walk test\n"};
  (*seeds)["mat"] = {MatBytes()};
}

}  // namespace bodyloom::fuzz
