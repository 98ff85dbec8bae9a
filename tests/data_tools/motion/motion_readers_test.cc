// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <zlib.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/motion/motion_readers.h"
#include "data_tools/motion/text_scanner.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/object_npy_bytes.h"
#include "tests/data_tools/formats/pickle_writer.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::motion_readers_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kDegree = M_PI / 180;

Eigen::Matrix3d Rot(int axis, double degrees) {
  return RotationFromAxisAngle(Eigen::Vector3d::Unit(axis) * (degrees * kDegree));
}

std::string Gzip(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(text.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

TEST(TextFile, GzipIsInflatedAndDamageIsReported) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 300000; ++i) text += std::to_string(i % 1000 * 7919 % 1000);
  const std::string gz = Gzip(text);
  WriteFileAtomically(folder.File("a.gz"), gz);
  EXPECT_TRUE(ReadTextFile(folder.File("a.gz")) == text);
  EXPECT_THAT(FileErrorOf("a.gz", [&] { ReadTextFile(folder.File("a.gz"), 1000); }), HasSubstr("at most 1000"));
  for (size_t n = 2; n < gz.size(); n += gz.size() / 20) {
    WriteFileAtomically(folder.File("b.gz"), gz.substr(0, n));
    FileErrorOf("b.gz", [&] { ReadTextFile(folder.File("b.gz")); });
  }
  std::string damaged = gz;
  damaged[gz.size() / 2] ^= 0x55;
  WriteFileAtomically(folder.File("c.gz"), damaged);
  FileErrorOf("c.gz", [&] { ReadTextFile(folder.File("c.gz")); });
  // A bomb: a thousand times smaller than what it holds.
  const std::string inflated(50'000'000, 'x');  // NOLINT(bugprone-string-constructor): large is meant
  WriteFileAtomically(folder.File("d.gz"), Gzip(inflated));
  EXPECT_THAT(FileErrorOf("d.gz", [&] { ReadTextFile(folder.File("d.gz"), 1'000'000); }),
              HasSubstr("inflates to more"));
}

const char* const kBvh = R"(HIERARCHY
ROOT Hips
{
  OFFSET 1 2 3
  CHANNELS 6 Zposition Xposition Yposition Yrotation Xrotation Zrotation
  JOINT Left Leg
  {
    OFFSET 0 -1e0 +.5
    CHANNELS 3 Zrotation Yrotation Xrotation
    End Site
    {
      OFFSET 0 -2 0
    }
  }
}
MOTION
Frames: 2
Frame Time: .0333333
0 0 0 0 0 0 0 0 0
30 10 20 90 10 20 5 6 7
)";

TEST(Bvh, ChannelsMeanWhatTheySay) {
  const SkeletonMotion motion = BvhFromText(kBvh, "k.bvh");
  EXPECT_THAT(motion.names, ElementsAre("Hips", "Left Leg", "Left Leg_end"));
  EXPECT_THAT(motion.parents, ElementsAre(-1, 0, 1));
  ASSERT_EQ(motion.num_frames(), 2);
  EXPECT_NEAR(motion.timestamps[1], 0.0333333, 1e-12);
  EXPECT_TRUE(motion.root_positions.row(1).isApprox(Eigen::RowVector3d(10, 20, 30)));
  EXPECT_TRUE(motion.rotations[3].isApprox(Rot(1, 90) * Rot(0, 10) * Rot(2, 20), 1e-12));
  EXPECT_TRUE(motion.rotations[4].isApprox(Rot(2, 5) * Rot(1, 6) * Rot(0, 7), 1e-12));
  const SkeletonFrame frame = PoseSkeletonFrame(motion, 1);
  const Eigen::Vector3d knee = Eigen::Vector3d(10, 20, 30) + motion.rotations[3] * Eigen::Vector3d(0, -1, 0.5);
  EXPECT_TRUE(frame.positions.row(1).transpose().isApprox(knee, 1e-12));
  EXPECT_TRUE(frame.positions.row(2).transpose().isApprox(
      knee + motion.rotations[3] * motion.rotations[4] * Eigen::Vector3d(0, -2, 0), 1e-12));
}

/// The file with one text in place of another.
std::string Changed(const std::string& from, const std::string& to, std::string text = kBvh) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Bvh, SpellingsThatMeanTheSame) {
  const SkeletonMotion expected = BvhFromText(kBvh, "k.bvh");
  std::string channels = kBvh, keywords = kBvh;
  for (const char* axis : {"X", "Y", "Z"}) {
    for (const char* kind : {"rotation", "position"}) {
      const std::string name = std::string(axis) + kind;
      for (size_t at = 0; (at = channels.find(name, at)) != std::string::npos; ++at) {
        channels[at] = static_cast<char>(channels[at] + ('x' - 'X'));
      }
    }
  }
  for (const char* word :
       {"HIERARCHY", "ROOT", "OFFSET", "CHANNELS", "JOINT", "End Site", "MOTION", "Frames", "Frame Time"}) {
    const std::string name = word;
    for (size_t at = 0; (at = keywords.find(name, at)) != std::string::npos; ++at) {
      for (size_t i = 0; i < name.size(); ++i) keywords[at + i] = static_cast<char>(std::tolower(name[i]));
    }
  }
  std::vector<std::string> warnings;
  for (const std::string& text :
       {channels, keywords, "\xEF\xBB\xBF" + std::string(kBvh), Changed("Frames: 2", "Frames:2"),
        Changed("Frame Time: .0333333", "Frame Time:.0333333"), Changed("Frames: 2", "Frames:\t2")}) {
    const SkeletonMotion read = BvhFromText(text, "k.bvh", &warnings);
    EXPECT_EQ(read.names, expected.names);
    EXPECT_EQ(read.timestamps, expected.timestamps);
    EXPECT_EQ(read.root_positions, expected.root_positions);
    for (size_t i = 0; i < expected.rotations.size(); ++i) EXPECT_EQ(read.rotations[i], expected.rotations[i]) << i;
  }
  EXPECT_TRUE(warnings.empty());
}

TEST(Bvh, FramesThatAreThereAreRead) {
  const auto frames_of = [](const std::string& text) {
    std::vector<std::string> warnings;
    const SkeletonMotion motion = BvhFromText(text, "k.bvh", &warnings);
    EXPECT_TRUE(motion.root_positions.row(motion.num_frames() - 1)
                    .isApprox(motion.num_frames() == 1 ? Eigen::RowVector3d(0, 0, 0) : Eigen::RowVector3d(10, 20, 30)));
    EXPECT_EQ(warnings.size(), 1U);
    return std::make_pair(motion.num_frames(), warnings.empty() ? "" : warnings[0]);
  };
  const std::string last = "30 10 20 90 10 20 5 6 7\n";
  const auto more = frames_of(std::string(kBvh) + last);
  EXPECT_EQ(more.first, 3);
  EXPECT_EQ(more.second, "k.bvh: 3 whole frames, the header says 2; those that are there are read");
  EXPECT_EQ(frames_of(Changed(last, "")).first, 1);
  EXPECT_EQ(frames_of(Changed("Frames: 2", "Frames: 1")).first, 2);
  EXPECT_EQ(frames_of(Changed("Frames: 2", "Frames: 0")).first, 2);
  EXPECT_EQ(frames_of(Changed("Frames: 2", "Frames: 2000000")).first, 2);
  EXPECT_EQ(frames_of(Changed(last, "30 10 20 90 10\n")).first, 1) << "a frame that is cut";
  EXPECT_EQ(frames_of(Changed("Frames: 2", "Frames: 3", Changed(last, "30 10 20 90 10 20 5 6 7", kBvh))).first, 1)
      << "its last number may be cut";
}

TEST(Bvh, ATruncationIsAShorterMotionOrAnError) {
  const std::string text = kBvh;
  const size_t first_frame = text.find("\n0 0 0") + 1, first_end = text.find('\n', first_frame);
  for (size_t n = 0; n + 3 < text.size(); ++n) {
    const std::string cut = text.substr(0, n);
    if (n <= first_end) {
      FileErrorOf("k.bvh: line", [&] { BvhFromText(cut, "k.bvh"); });
    } else {
      EXPECT_EQ(BvhFromText(cut, "k.bvh").num_frames(), 1) << n;
    }
  }
}

TEST(Bvh, LyingAndHostileFiles) {
  const auto error = [](const std::string& from, const std::string& to) {
    std::string text = kBvh;
    text.replace(text.find(from), from.size(), to);
    return FileErrorOf("k.bvh: line", [&] { BvhFromText(text, "k.bvh"); });
  };
  EXPECT_THAT(error("Frames: 2", "Frames: 2000000000"), HasSubstr("expected a number of frames"));
  EXPECT_THAT(error("5 6 7\n", "5 6 7\nno number of a frame but nine more words\n"), HasSubstr("found 'no'"));
  EXPECT_THAT(error("0 0 0 0 0 0 0 0 0\n30 10 20 90 10 20 5 6 7\n", ""), HasSubstr("no whole frame of 9 channels"));
  EXPECT_THAT(error("Frames: 2", "Frames: -3"), HasSubstr("expected a number of frames"));
  EXPECT_THAT(error("Time: .0333333", "Time: 0"), HasSubstr("frame time"));
  EXPECT_THAT(error("Time: .0333333", "Time: nan"), HasSubstr("found 'nan'"));
  EXPECT_THAT(error("30 10 20", "30 inf 20"), HasSubstr("found 'inf', expected a channel value of frame 1"));
  EXPECT_THAT(error("30 10 20", "30 1e999 20"), HasSubstr("found '1e999'"));
  EXPECT_THAT(error("Xposition", "Wposition"), HasSubstr("found channel 'Wposition'"));
  EXPECT_THAT(error("CHANNELS 6", "CHANNELS 1000000"), HasSubstr("number of channels"));
  EXPECT_THAT(error("OFFSET 1 2 3", "OFFSET 1 2"), HasSubstr("found 'CHANNELS', expected an offset"));
  EXPECT_THAT(error("JOINT", "JOYNT"), HasSubstr("found 'JOYNT', expected 'JOINT'"));
  EXPECT_THAT(error("HIERARCHY", "HIERARCHIE"), HasSubstr("expected 'HIERARCHY'"));
  // A hierarchy a hundred thousand joints deep.
  std::string deep = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n";
  for (int i = 0; i < 100000; ++i) deep += "JOINT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n";
  EXPECT_THAT(FileErrorOf("deep", [&] { BvhFromText(deep, "deep"); }), HasSubstr("more than 2000 joints"));
  // Small on disk, large in memory: many joints without channels, many short frames.
  std::string wide = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
  for (int i = 0; i < 1900; ++i) wide += "JOINT a\n{\nOFFSET 0 0 0\n}\n";
  wide += "}\nMOTION\nFrames: 100000\nFrame Time: 0.01\n";
  for (int i = 0; i < 100000; ++i) wide += "0\n";
  EXPECT_THAT(FileErrorOf("wide", [&] { BvhFromText(wide, "wide"); }), HasSubstr("too many"));
}

const char* const kAsf = R"(# a comment with begin and :hierarchy
:version 1.10
:units
  mass 1.0
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name thigh
    direction 0 -2 0
    length 7
    axis 10 20 30 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    name shin
    direction 0 -1 0
    length 5
    axis 0 0 20 XYZ
    dof rx
  end
  begin
    name rigid
    direction 1 0 0
    length 3
    axis 0 0 0 XYZ
  end
:hierarchy
  begin
    root thigh rigid
    thigh shin
  end
)";
const char* const kAmc = R"(#!OML:ASF something
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 0 0
thigh 0 0 0
shin 0
2
root 4 5 6 10 20 30
thigh 40 50 60
shin 70
)";

SkeletonMotion Acclaim(const std::string& asf, const std::string& amc) {
  return AsfAmcFromText(asf, "s.asf", amc, "m.amc", 120);
}

TEST(AsfAmc, AxesAndOrder) {
  const SkeletonMotion motion = Acclaim(kAsf, kAmc);
  EXPECT_THAT(motion.names, ElementsAre("root", "thigh", "shin", "rigid", "shin_end", "rigid_end"));
  ASSERT_EQ(motion.num_frames(), 2);
  EXPECT_NEAR(motion.timestamps[1], 1 / 120.0, 1e-12);
  EXPECT_TRUE(motion.offsets.row(1).isZero());
  EXPECT_TRUE(motion.offsets.row(2).isApprox(Eigen::RowVector3d(0, -7, 0))) << "a joint sits at its bone's near end";
  EXPECT_TRUE(motion.offsets.row(4).isApprox(Eigen::RowVector3d(0, -5, 0)));
  EXPECT_TRUE(motion.root_positions.row(1).isApprox(Eigen::RowVector3d(4, 5, 6)));
  const int J = motion.num_joints();
  EXPECT_TRUE(motion.rotations[J].isApprox(Rot(2, 30) * Rot(1, 20) * Rot(0, 10), 1e-12));
  const Eigen::Matrix3d C = Rot(2, 30) * Rot(1, 20) * Rot(0, 10), M = Rot(2, 60) * Rot(1, 50) * Rot(0, 40);
  EXPECT_TRUE(motion.rotations[J + 1].isApprox(C * M * C.transpose(), 1e-12));
  EXPECT_TRUE(motion.rotations[J + 2].isApprox(Rot(2, 20) * Rot(0, 70) * Rot(2, -20), 1e-12));
  EXPECT_TRUE(motion.rotations[J + 3].isIdentity());
}

TEST(AsfAmc, MalformedFiles) {
  const auto asf_error = [](const std::string& from, const std::string& to) {
    std::string text = kAsf;
    text.replace(text.find(from), from.size(), to);
    return FileErrorOf("s.asf: line", [&] { Acclaim(text, kAmc); });
  };
  const auto amc_error = [](const std::string& from, const std::string& to) {
    std::string text = kAmc;
    text.replace(text.find(from), from.size(), to);
    return FileErrorOf("m.amc: line", [&] { Acclaim(kAsf, text); });
  };
  EXPECT_THAT(asf_error("name shin", ""), HasSubstr("without a name"));
  EXPECT_THAT(asf_error("thigh shin", "ghost shin"), HasSubstr("unknown bone 'ghost'"));
  EXPECT_THAT(asf_error("thigh shin", "shin shin"), HasSubstr("'shin' does not hang"));
  EXPECT_THAT(asf_error("thigh shin", ""), HasSubstr("'shin' does not hang"));
  EXPECT_THAT(asf_error("axis 0 0 20 XYZ", "axis 0 0 20 XQZ"), HasSubstr("axis order"));
  EXPECT_THAT(asf_error("length 5", "length NaN"), HasSubstr("found 'NaN', expected a length"));
  EXPECT_THAT(asf_error("angle deg", "angle grad"), HasSubstr("'grad'"));
  EXPECT_THAT(asf_error("axis XYZ\n  position", "wobble\n  position"), HasSubstr("found 'wobble'"));
  EXPECT_THAT(amc_error("shin 70\n", "shin 70 80\n"), HasSubstr("frame 3 lacks the root"));
  EXPECT_THAT(amc_error("shin 70\n", "shin\n"), HasSubstr("the file ends, expected a value of 'shin' in frame 2"));
  EXPECT_THAT(amc_error("shin 70\n", ""), HasSubstr("'shin' is in only one of frames 1 and 2"));
  EXPECT_THAT(amc_error("shin 70\n", "fin 70\n"), HasSubstr("bone 'fin' is not in the skeleton s.asf"));
  EXPECT_THAT(amc_error("shin 70\n", "root 1 2 3 4 5 6\n"), HasSubstr("occurs twice"));
  EXPECT_THAT(amc_error("root 1 2 3 0 0 0\n", ""), HasSubstr("lacks the root"));
  EXPECT_THAT(amc_error(kAmc, "#!OML\n:DEGREES\n"), HasSubstr("no frames"));
  const std::string asf = kAsf, amc = kAmc;
  for (size_t n = 0; n + 8 < asf.size(); ++n) FileErrorOf("s.asf", [&] { Acclaim(asf.substr(0, n), kAmc); });
  // An AMC that stops between two frames is a shorter motion; inside a frame it is an error.
  int errors = 0;
  for (size_t n = 0; n < amc.size(); ++n) {
    try {
      EXPECT_LE(Acclaim(kAsf, amc.substr(0, n)).num_frames(), 2);
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("m.amc: line"));
      ++errors;
    }
  }
  EXPECT_GT(errors, static_cast<int>(amc.size()) * 2 / 3);
}

TEST(AsfAmc, SkeletonIsFoundBesideTheMotion) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("07_02.amc"), kAmc);
  EXPECT_THAT(FileErrorOf("07_02.amc", [&] { ReadAsfAmc(folder.File("07_02.amc")); }),
              HasSubstr("no skeleton beside it"));
  WriteFileAtomically(folder.File("07.asf.gz"), Gzip(kAsf));
  EXPECT_EQ(ReadAsfAmc(folder.File("07_02.amc")).num_frames(), 2);
}

std::string DeepMimicFrame(double duration, const std::string& root_quaternion = "1,0,0,0") {
  std::string text = std::to_string(duration) + ",0.1,0.9,0.2," + root_quaternion;
  for (const int n : {4, 4, 4, 1, 4, 4, 1, 4, 1, 4, 4, 1}) text += n == 4 ? ",1,0,0,0" : ",0.5";
  return "[" + text + "]";
}

SkeletonMotion DeepMimic(const std::string& text) {
  const nlohmann::json json = ParseJson(text, "d.txt");
  return DeepMimicFromJson(JsonNode(json, "d.txt"));
}

TEST(DeepMimic, FramesAndErrors) {
  const SkeletonMotion motion = DeepMimic(R"({"Loop":"wrap","Frames":[)" + DeepMimicFrame(0.04, "0.5,0.5,0.5,0.5") +
                                          "," + DeepMimicFrame(0) + "]}");
  ASSERT_EQ(motion.num_frames(), 2);
  EXPECT_NEAR(motion.timestamps[1], 0.04, 1e-12);
  EXPECT_TRUE(motion.root_positions.row(0).isApprox(Eigen::RowVector3d(0.1, 0.9, 0.2)));
  EXPECT_TRUE((motion.rotations[0] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, 1, 0), 1e-12));
  const int knee = motion.FindJoint("left_knee");
  EXPECT_TRUE(motion.rotations[knee].isApprox(Rot(2, 0.5 / kDegree), 1e-12));
  const auto error = [](const std::string& text) { return FileErrorOf("d.txt", [&] { DeepMimic(text); }); };
  EXPECT_THAT(error(R"({"Frames":[]})"), HasSubstr("not empty"));
  EXPECT_THAT(error(R"({"Frames":[[1,2,3]]})"), HasSubstr("3 numbers, expected 44"));
  EXPECT_THAT(error(R"({"Frames":[)" + DeepMimicFrame(0.1, "0,0,0,0") + "]}"),
              HasSubstr("quaternion of 'root' has length 0"));
  EXPECT_THAT(error(R"({"Frames":[)" + DeepMimicFrame(-1) + "," + DeepMimicFrame(1) + "]}"), HasSubstr("duration"));
}

/// An AMP file of a 16-joint person would be long: three joints are enough for the reader.
std::string AmpNpy(const std::vector<double>& rotations, const std::vector<int>& shape, double fps = 20,
                   int bad_parent = 0) {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const auto arr = [](const std::string& array) { return Dict({{Str2("arr"), array}}); };
  const std::vector<int64_t> parents = {-1, bad_parent, 1};
  const std::string names = "](" + Str2("a") + Str2("b") + Str2("c") + "e";
  std::string fps_bytes = "G";
  for (int i = 7; i >= 0; --i) fps_bytes += RawOf(std::vector<double>{fps})[i];
  const std::string object = Dict(
      {{Str2("rotation"), arr(Doubles2(rotations, shape))},
       {Str2("root_translation"), arr(Doubles2({1, 2, 3}, {1, 3}))},
       {Str2("skeleton_tree"), Dict({{Str2("node_names"), names},
                                     {Str2("parent_indices"), arr(Array2("i8", '<', {3}, false, RawOf(parents)))},
                                     {Str2("local_translation"), arr(Doubles2({0, 0, 0, 0, 0, 1, 0, 0, 2}, {3, 3}))}})},
       {Str2("is_local"), "\x88"},
       {Str2("fps"), fps_bytes}});
  return ObjectNpyBytes(object);
}

TEST(Amp, ReadsAndChecks) {
  const double h = std::sqrt(0.5);
  const std::vector<double> rotations = {0, 0, h, h, h, 0, 0, h, 0, 0, 0, 1};
  const SkeletonMotion motion = AmpFromNpyBytes(AmpNpy(rotations, {1, 3, 4}), "a.npy");
  EXPECT_THAT(motion.names, ElementsAre("a", "b", "c"));
  EXPECT_TRUE(motion.rotations[0].isApprox(Rot(2, 90), 1e-9));
  EXPECT_TRUE(motion.rotations[1].isApprox(Rot(0, 90), 1e-9));
  EXPECT_TRUE(motion.offsets.row(2).isApprox(Eigen::RowVector3d(0, 0, 2)));
  const auto error = [](const std::string& bytes) {
    return FileErrorOf("a.npy", [&] { AmpFromNpyBytes(bytes, "a.npy"); });
  };
  EXPECT_THAT(error(AmpNpy(rotations, {1, 4, 3})), HasSubstr("rotation: shape 1x4x3"));
  EXPECT_THAT(error(AmpNpy({0, 0, h, h, 0, 0, 0, 0, 0, 0, 0, 1}, {1, 3, 4})),
              HasSubstr("joint 'b': a quaternion of length 0"));
  EXPECT_THAT(error(AmpNpy({0, 0, h, h, 0, NAN, 0, 0, 0, 0, 0, 1}, {1, 3, 4})), HasSubstr("joint 'b'"));
  EXPECT_THAT(error(AmpNpy(rotations, {1, 3, 4}, 0)), HasSubstr("fps is 0"));
  EXPECT_THAT(error(AmpNpy(rotations, {1, 3, 4}, 20, 2)), HasSubstr("parent_indices[1] is 2"));
  EXPECT_THAT(error(AmpNpy({}, {0, 3, 4})), HasSubstr("no frames"));
  const std::string bytes = AmpNpy(rotations, {1, 3, 4});
  for (size_t n = 0; n < bytes.size(); ++n) error(bytes.substr(0, n));
}

TEST(LoadMotion, UnknownFilesSayWhatIsRead) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& name, const std::string& bytes) {
    WriteFileAtomically(folder.File(name), bytes);
    return FileErrorOf(folder.File(name), [&] { LoadMotion(folder.File(name)); });
  };
  EXPECT_THAT(error("a", ""), HasSubstr("empty; expected AMASS"));
  EXPECT_THAT(error("a", "hello"), HasSubstr("unknown kind of file; expected AMASS"));
  EXPECT_THAT(error("a.asf", kAsf), HasSubstr("a skeleton without motion"));
  EXPECT_THAT(error("a.amc", kAmc), HasSubstr("no skeleton beside it"));
  EXPECT_THAT(error("a.json", "{}"), HasSubstr("JSON without 'Frames'"));
  EXPECT_THAT(error("a.pkl", "\x80\x02}."), HasSubstr("without 'smpl_poses'"));
  EXPECT_THAT(error("a.bvh", kBvh), HasSubstr("not recognised as a person's"));
  EXPECT_THAT(error("a.bvh.gz", Gzip(kBvh).substr(0, 60)), HasSubstr("cut off"));
  FileErrorOf("nowhere", [] { LoadMotion("/nowhere"); });
}

}  // namespace
}  // namespace bodyloom::motion_readers_test
