// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/single_person_dataset.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/densepose_iuv.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/parallel.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::single_person_dataset_test {
namespace {

using ::testing::HasSubstr;

constexpr int kFrames = 6, kWidth = 20, kHeight = 15;

Image Noise(int width, int height, int seed, int values) {
  Image image(width, height);
  uint32_t state = 77 + seed;
  for (uint8_t& byte : image.bgr) {
    state = state * 1664525 + 1013904223;
    byte = static_cast<uint8_t>((state >> 16) % values);
  }
  return image;
}

PersonFrame SampleFrame(int t) {
  PersonFrame frame;
  frame.rgb = Noise(kWidth, kHeight, t, 256);
  frame.normals = Noise(kWidth, kHeight, t + 100, 256);
  frame.iuv = Noise(kWidth, kHeight, t + 200, 25);
  frame.background = Noise(kWidth, kHeight, t + 300, 256);
  frame.labels = Noise(kWidth, kHeight, t + 400, kNumPersonLabels);
  for (size_t i = 0; i < frame.labels.bgr.size(); ++i) frame.labels.bgr[i] = frame.labels.bgr[i - i % 3];
  return frame;
}

Track SampleTrack() {
  Track track;
  track.motion.body = "bodyloom";
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses = RowMatrixXd::Constant(kFrames, 72, 0.125);
  track.motion.trans = MatrixX3d::Constant(kFrames, 3, 2.5);
  for (int t = 0; t < kFrames; ++t) track.motion.timestamps.push_back(t / 25.0);
  track.camera = MakePinhole(kWidth, kHeight, 30);
  track.frame_status.assign(kFrames, FrameStatus::kTracked);
  return track;
}

SinglePersonDatasetInfo SampleInfo() {
  SinglePersonDatasetInfo info;
  info.num_frames = kFrames, info.width = kWidth, info.height = kHeight, info.fps = 25;
  info.seed = 12345678901234567ULL, info.garment = "skirt", info.motion = "a walk.bvh", info.command = "bodyloom \"x\"";
  return info;
}

void WriteSample(const std::string& path, const SinglePersonDatasetInfo& info = SampleInfo()) {
  const SinglePersonDatasetWriter writer(path, info, SampleTrack());
  ParallelFor(kFrames, 3, [&](int t) { writer.Write(t, SampleFrame(t)); });
  writer.Finish();
}

TEST(SinglePersonDataset, ReturnsWhatWasWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.File("set");
  WriteSample(path);
  const SinglePersonDataset set(path);
  EXPECT_EQ(set.info().num_frames, kFrames);
  EXPECT_EQ(set.info().width, kWidth);
  EXPECT_EQ(set.info().height, kHeight);
  EXPECT_EQ(set.info().fps, 25);
  EXPECT_EQ(set.info().seed, 12345678901234567ULL);
  EXPECT_EQ(set.info().garment, "skirt");
  EXPECT_EQ(set.info().motion, "a walk.bvh");
  EXPECT_EQ(set.info().command, "bodyloom \"x\"");
  EXPECT_EQ(set.track().motion.poses, SampleTrack().motion.poses);
  for (int t = 0; t < kFrames; ++t) {
    const PersonFrame read = set.Read(t), written = SampleFrame(t);
    EXPECT_EQ(read.rgb, written.rgb);
    EXPECT_EQ(read.labels, written.labels);
    EXPECT_EQ(read.normals, written.normals);
    EXPECT_EQ(read.iuv, written.iuv);
    EXPECT_EQ(read.background, written.background);
  }
}

TEST(SinglePersonDataset, PngsAreWhatOtherProgramsExpect) {
  const TemporaryFolder folder;
  const std::string path = folder.File("set");
  WriteSample(path);
  // PNG header: byte 24 is the bit depth, byte 25 the colour type (0 grey, 2 RGB).
  const auto header = [&](const char* kind) { return ReadFileBytes(path + "/" + kind + "/000003.png").substr(24, 2); };
  EXPECT_EQ(header("labels"), std::string("\x08\x00", 2));
  for (const char* kind : {"images", "normals", "iuv", "backgrounds"}) {
    EXPECT_EQ(header(kind), std::string("\x08\x02", 2)) << kind;
  }
  const IuvImage iuv = ReadIuvImage(path + "/iuv/000003.png", IuvOrder::kBlueIsPart);
  const Image written = SampleFrame(3).iuv;
  EXPECT_EQ(iuv.part[7], written.bgr[21]);
  EXPECT_EQ(iuv.u[7], written.bgr[22]);
  EXPECT_EQ(iuv.v[7], written.bgr[23]);
}

TEST(SinglePersonDataset, ReadsOnlyWhatIsWantedAndThere) {
  const TemporaryFolder folder;
  SinglePersonDatasetInfo info = SampleInfo();
  info.has = {.labels = false, .normals = true, .iuv = true, .background = false};
  WriteSample(folder.File("set"), info);
  EXPECT_FALSE(std::filesystem::exists(folder.File("set/labels")));
  const SinglePersonDataset set(folder.File("set"));
  EXPECT_FALSE(set.info().has.labels);
  EXPECT_TRUE(set.info().has.normals);
  const PersonFrame frame = set.Read(1, {.labels = true, .normals = true, .iuv = false, .background = true});
  EXPECT_FALSE(frame.rgb.empty());
  EXPECT_FALSE(frame.normals.empty());
  EXPECT_TRUE(frame.labels.empty());
  EXPECT_TRUE(frame.iuv.empty());
  EXPECT_TRUE(frame.background.empty());
  EXPECT_THROW((void)set.Read(kFrames), std::invalid_argument);
  EXPECT_THROW((void)set.Read(-1), std::invalid_argument);
}

TEST(SinglePersonDataset, AnUnfinishedSetIsRecognised) {
  const TemporaryFolder folder;
  const std::string path = folder.File("set");
  const SinglePersonDatasetWriter writer(path, SampleInfo(), SampleTrack());
  for (int t = 0; t < kFrames - 1; ++t) writer.Write(t, SampleFrame(t));
  EXPECT_THAT(FileErrorOf("person.json", [&] { SinglePersonDataset set(path); }), HasSubstr("finished"));
  EXPECT_THAT(FileErrorOf("images/000005.png", [&] { writer.Finish(); }), HasSubstr("never written"));
  EXPECT_FALSE(std::filesystem::exists(path + "/person.json"));
  FileErrorOf("nowhere", [&] { SinglePersonDataset set(folder.File("nowhere")); });
}

TEST(SinglePersonDataset, AReplacedSetLeavesNothingBehind) {
  const TemporaryFolder folder;
  const std::string path = folder.File("set");
  WriteSample(path);
  WriteFileAtomically(path + "/images/mine.png", "a user's own");
  SinglePersonDatasetInfo info = SampleInfo();
  info.num_frames = 2;
  Track track = SampleTrack();
  track.motion.poses.conservativeResize(2, Eigen::NoChange);
  track.motion.trans.conservativeResize(2, Eigen::NoChange);
  track.motion.timestamps.resize(2), track.frame_status.resize(2);
  const SinglePersonDatasetWriter writer(path, info, track);
  EXPECT_FALSE(std::filesystem::exists(path + "/person.json")) << "the half-replaced set must not look finished";
  writer.Write(0, SampleFrame(0)), writer.Write(1, SampleFrame(1));
  writer.Finish();
  EXPECT_EQ(SinglePersonDataset(path).info().num_frames, 2);
  EXPECT_FALSE(std::filesystem::exists(path + "/labels/000002.png"));
  EXPECT_TRUE(std::filesystem::exists(path + "/images/mine.png"));
}

TEST(SinglePersonDataset, BrokenSetsNameTheFile) {
  const TemporaryFolder folder;
  const std::string path = folder.File("set");
  WriteSample(path);
  const std::string json = ReadFileBytes(path + "/person.json");
  for (size_t n = 0; n + 2 < json.size(); ++n) {
    WriteFileAtomically(path + "/person.json", json.substr(0, n));
    FileErrorOf("person.json", [&] { SinglePersonDataset set(path); });
  }
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = json;
    const size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    WriteFileAtomically(path + "/person.json", changed);
    return FileErrorOf("person.json", [&] { SinglePersonDataset set(path); });
  };
  EXPECT_THAT(with("bodyloom person set", "something"), HasSubstr("expected \"bodyloom person set\""));
  EXPECT_THAT(with("\"version\": 1", "\"version\": 2"), HasSubstr("version: found 2"));
  EXPECT_THAT(with("\"frames\": 6", "\"frames\": 0"), HasSubstr("frames: found 0"));
  EXPECT_THAT(with("\"frames\": 6", "\"frames\": 1e300"), HasSubstr("frames"));
  EXPECT_THAT(with("\"width\": 20", "\"width\": -5"), HasSubstr("width: found -5"));
  EXPECT_THAT(with("\"fps\": 25.0", "\"fps\": 0"), HasSubstr("frames a second"));
  EXPECT_THAT(with("\"fps\": 25.0", "\"fps\": NaN"), HasSubstr("person.json"));
  EXPECT_THAT(with("\"face\"", "\"mask\""), HasSubstr("expected \"face\""));
  EXPECT_THAT(with("\"shoes\"", "\"shoes\", \"socks\""), HasSubstr("7 names"));
  EXPECT_THAT(with("\"iuv\": true", "\"iuv\": 1"), HasSubstr("true or false"));
  EXPECT_THAT(with("\"normals\": true,", ""), HasSubstr("normals"));
  WriteFileAtomically(path + "/person.json", std::string(100'000, '['));
  FileErrorOf("person.json", [&] { SinglePersonDataset set(path); });
  // A promise of more frames than there are.
  std::string more = json;
  more.replace(more.find("\"frames\": 6"), 11, "\"frames\": 9");
  WriteFileAtomically(path + "/person.json", more);
  EXPECT_THAT(FileErrorOf("images/000006.png", [&] { SinglePersonDataset set(path); }), HasSubstr("promises 9 frames"));
}

TEST(SinglePersonDataset, BrokenImagesAndTracksNameTheFile) {
  const TemporaryFolder folder;
  const std::string path = folder.File("set");
  WriteSample(path);
  const SinglePersonDataset set(path);
  const std::string file = path + "/labels/000002.png";
  Image wrong = SampleFrame(2).labels;
  wrong.pixel(3, 4)[0] = wrong.pixel(3, 4)[1] = wrong.pixel(3, 4)[2] = 9;
  WriteImage(file, wrong);
  EXPECT_THAT(FileErrorOf("labels/000002.png", [&] { (void)set.Read(2); }), HasSubstr("pixel (3, 4): found 9"));
  WriteImage(file, Image(kWidth, kHeight + 1));
  EXPECT_THAT(FileErrorOf("labels/000002.png", [&] { (void)set.Read(2); }), HasSubstr("20x16 pixels, expected 20x15"));
  const std::string image = ReadFileBytes(path + "/images/000001.png");
  for (size_t n = 0; n + 30 < image.size(); n += 61) {
    WriteFileAtomically(path + "/images/000001.png", image.substr(0, n));
    FileErrorOf("images/000001.png", [&] { (void)set.Read(1); });
  }
  Track track = SampleTrack();
  track.camera.width = kWidth + 1;
  WriteTrack(path + "/track.npz", track);
  EXPECT_THAT(FileErrorOf("track.npz", [&] { (void)set.track(); }), HasSubstr("21x15, expected 20x15"));
  track = SampleTrack();
  track.motion.poses.conservativeResize(3, Eigen::NoChange);
  track.motion.trans.conservativeResize(3, Eigen::NoChange);
  track.motion.timestamps.resize(3), track.frame_status.resize(3);
  WriteTrack(path + "/track.npz", track);
  EXPECT_THAT(FileErrorOf("track.npz", [&] { (void)set.track(); }), HasSubstr("3 frames, expected 6"));
}

TEST(SinglePersonDataset, WritingChecksItsContract) {
  const TemporaryFolder folder;
  const SinglePersonDatasetWriter writer(folder.File("set"), SampleInfo(), SampleTrack());
  PersonFrame frame = SampleFrame(0);
  frame.normals = Image();
  EXPECT_THROW(writer.Write(0, frame), std::invalid_argument);
  EXPECT_THROW(writer.Write(kFrames, SampleFrame(0)), std::invalid_argument);
  SinglePersonDatasetInfo info = SampleInfo();
  info.num_frames = kFrames + 1;
  EXPECT_THROW(SinglePersonDatasetWriter(folder.File("b"), info, SampleTrack()), std::invalid_argument);
  info = SampleInfo(), info.width = 21;
  EXPECT_THROW(SinglePersonDatasetWriter(folder.File("b"), info, SampleTrack()), std::invalid_argument);
  info = SampleInfo(), info.fps = NAN;
  EXPECT_THROW(SinglePersonDatasetWriter(folder.File("b"), info, SampleTrack()), std::invalid_argument);
}

TEST(SinglePersonDataset, NormalsSurviveTheirCode) {
  for (double n = -1; n <= 1; n += 1.0 / 512) EXPECT_NEAR(NormalOfCode(NormalCode(n)), n, 1.0001 / 255);
  EXPECT_EQ(NormalCode(-1), 0);
  EXPECT_EQ(NormalCode(1), 255);
}

}  // namespace
}  // namespace bodyloom::single_person_dataset_test
