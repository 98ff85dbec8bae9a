// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_library.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/amass.h"
#include "data_tools/motion/bvh_writer.h"
#include "data_tools/motion/motion_floor.h"
#include "data_tools/motion/motion_split.h"
#include "data_tools/motion/smpl_rest.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/motion/motion_support.h"
#include "tests/support/paths.h"

namespace bodyloom::motion_library_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

void WriteText(const std::string& path, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream(path) << text;
}

/// As AMASS has it: z up; the reader gives back the same 22 joints with another `trans` by a constant.
void WriteClip(const std::string& path, const Motion& motion) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  WriteAmass(path, motion, Eigen::Vector3d::Zero());
}

TEST(MotionLibrary, VisitsSortedClassesSplitsAndSaysWhatItLeftOut) {
  const TemporaryFolder folder;
  WriteClip(folder.File("b/05_02.npz"), WalkingMotion(60, 3));
  WriteClip(folder.File("a/gBR_sBM_cAll_d06_mBR2_ch06.npz"), WalkingMotion(60, 2));
  WriteClip(folder.File("b/stranger.npz"), WalkingMotion(60, 1));
  WriteText(folder.File("b/LICENSE"), "all yours");
  WriteText(folder.File("c/empty.bvh"), "");
  MotionLibraryOptions options;
  options.split_path = folder.File("split.txt");
  WriteText(options.split_path, "# comment\n05_02 kick test\n\n gBR_sBM_cAll_d06_mBR2_ch06 dance train # a dancer\n");
  MotionLibrarySummary summary;
  const std::vector<LibraryClip> clips =
      LoadMotionLibrary({folder.File("a"), folder.File("b"), folder.File("c")}, options, &summary);
  ASSERT_EQ(clips.size(), 3);
  EXPECT_EQ(clips[0].name, "gBR_sBM_cAll_d06_mBR2_ch06.npz");
  EXPECT_EQ(clips[0].subject, "d06");
  EXPECT_EQ(clips[0].motion_class, "dance");
  EXPECT_FALSE(clips[0].test);
  EXPECT_EQ(clips[1].name, "05_02.npz");
  EXPECT_EQ(clips[1].subject, "05");
  EXPECT_EQ(clips[1].motion_class, "kick");
  EXPECT_TRUE(clips[1].test);
  EXPECT_EQ(clips[2].subject, "stranger");
  EXPECT_EQ(clips[2].motion_class, "other");
  EXPECT_FALSE(clips[2].test);
  EXPECT_EQ(summary.clips, 3);
  EXPECT_NEAR(summary.seconds, 6, 0.1);
  EXPECT_NEAR(summary.test_seconds_by_class["kick"], 3, 0.05);
  EXPECT_NEAR(summary.train_seconds_by_class["dance"], 2, 0.05);
  EXPECT_NEAR(summary.train_seconds_by_source["amass"], 3, 0.1);
  EXPECT_THAT(summary.unnamed, ElementsAre("stranger.npz"));
  ASSERT_EQ(summary.left_out.size(), 2);
  EXPECT_EQ(summary.left_out[0].first, "LICENSE");
  EXPECT_THAT(summary.left_out[0].second, HasSubstr("unknown kind of file"));
  EXPECT_EQ(summary.left_out[1].first, "empty.bvh");

  options.visit_train = false;
  int visited = 0;
  const MotionLibrarySummary again = VisitMotionLibrary({folder.File("b")}, options, [&](LibraryClip&& clip) {
    EXPECT_TRUE(clip.test);
    ++visited;
  });
  EXPECT_EQ(visited, 1);
  EXPECT_EQ(again.clips, 2) << "clips for training are counted, not visited";
}

TEST(MotionLibrary, NamesKeepThePathBelowTheFolderAndTheSourceIsTheFormat) {
  const TemporaryFolder folder;
  const Motion motion = WalkingMotion(60, 1);
  std::filesystem::create_directories(folder.File("cmu"));
  WriteBvh(folder.File("cmu/07_01.bvh"), motion, BuiltinBody());
  WriteBvh(folder.File("cmu/wave.bvh"), motion, BuiltinBody());
  std::vector<LibraryClip> clips = LoadMotionLibrary({folder.File("")});
  ASSERT_EQ(clips.size(), 2);
  EXPECT_EQ(clips[0].name, "cmu/07_01.bvh");
  EXPECT_EQ(clips[0].source, "cmu_bvh");
  EXPECT_EQ(clips[0].subject, "07");
  EXPECT_EQ(clips[1].source, "bvh");
  clips = LoadMotionLibrary({folder.File("cmu/wave.bvh")});  // a file instead of a folder
  ASSERT_EQ(clips.size(), 1);
  EXPECT_EQ(clips[0].name, "wave.bvh");
}

TEST(MotionLibrary, FasterClipsAreResampledSlowerOnesAreLeft) {
  const TemporaryFolder folder;
  WriteClip(folder.File("a120.npz"), WalkingMotion(120, 2));
  WriteClip(folder.File("b30.npz"), WalkingMotion(30, 2));
  const std::vector<LibraryClip> clips = LoadMotionLibrary({folder.File("")});
  ASSERT_EQ(clips.size(), 2);
  EXPECT_NEAR(clips[0].source_fps, 120, 1e-6);
  EXPECT_NEAR(clips[0].motion.timestamps[1], 1 / 60.0, 1e-9);
  EXPECT_EQ(clips[1].motion.num_frames(), WalkingMotion(30, 2).num_frames());
  // Every second frame of the source, exactly.
  const Motion source = WalkingMotion(120, 2);
  ASSERT_EQ(clips[0].motion.num_frames(), (source.num_frames() + 1) / 2);
  for (int t = 0; t < clips[0].motion.num_frames(); ++t) {
    EXPECT_LT((clips[0].motion.poses.row(t).leftCols(66) - source.poses.row(2 * t).leftCols(66)).norm(), 1e-6) << t;
  }
}

TEST(MotionLibrary, StandsOnItsFloorWhereverTheRecordingHadIt) {
  const TemporaryFolder folder;
  Motion high = WalkingMotion(60, 3);
  high.trans.col(1).array() += 0.7;
  WriteClip(folder.File("high.npz"), high);
  WriteClip(folder.File("low.npz"), WalkingMotion(60, 3));
  const std::vector<LibraryClip> clips = LoadMotionLibrary({folder.File("")});
  ASSERT_EQ(clips.size(), 2);
  EXPECT_NEAR(clips[0].floor_shift_m - clips[1].floor_shift_m, 0.7, 1e-6);
  for (const LibraryClip& clip : clips) {
    EXPECT_TRUE(clip.has_floor) << clip.name;
    std::vector<double> lowest;
    for (const MatrixX3d& joints : PoseSmplJoints(clip.motion)) lowest.push_back(LowestPoint(joints));
    std::sort(lowest.begin(), lowest.end());
    EXPECT_NEAR(lowest[lowest.size() / 2], 0, 0.03) << clip.name << ": the bearing foot is on y = 0";
  }
  EXPECT_LT((clips[0].motion.trans - clips[1].motion.trans).norm(), 1e-6);
}

TEST(MotionLibrary, PiecesBetweenFaultsAreClipsOfTheirOwn) {
  const TemporaryFolder folder;
  Motion motion = WalkingMotion(60, 4);
  const Eigen::RowVector3d elsewhere(0, 0, 3);
  for (int t = 100; t < motion.num_frames(); ++t) motion.trans.row(t) += elsewhere;
  WriteClip(folder.File("05_01.npz"), motion);
  MotionLibraryOptions options;
  options.split_path = folder.File("split.txt");
  WriteText(options.split_path, "05_01 walk test\n");
  const std::vector<LibraryClip> clips = LoadMotionLibrary({folder.File("05_01.npz")}, options);
  ASSERT_EQ(clips.size(), 2);
  EXPECT_EQ(clips[1].name, "05_01.npz#2");
  EXPECT_TRUE(clips[1].test) << "a piece is what its recording is";
  EXPECT_EQ(clips[1].subject, "05");
  EXPECT_EQ(clips[0].jumps, 1);
  EXPECT_EQ(clips[1].jumps, 0);
  EXPECT_EQ(clips[0].motion.timestamps.front(), 0);
  EXPECT_EQ(clips[1].motion.timestamps.front(), 0);
  const int margin = 3;  // frames within 0.04 s of the jump's own
  EXPECT_EQ(clips[0].motion.num_frames(), 100 - margin);
  EXPECT_EQ(clips[0].frames_dropped, 2 * margin);
}

TEST(MotionLibrary, TracksInACamerasFrameAndGlimpsesAreLeftOut) {
  const TemporaryFolder folder;
  WriteClip(folder.File("short.npz"), StandingMotion(60, 0.2));  // too short as well
  WriteClip(folder.File("track.npz"), WalkingMotion(60, 1));
  NpzArrays arrays = ReadNpz(folder.File("track.npz"));
  arrays["camera_model"] = NdArray::FromString("pinhole");
  WriteNpz(folder.File("track.npz"), arrays);
  MotionLibrarySummary summary;
  EXPECT_THAT(LoadMotionLibrary({folder.File("")}, {}, &summary), IsEmpty());
  ASSERT_EQ(summary.left_out.size(), 2);
  EXPECT_THAT(summary.left_out[0].second, HasSubstr("none in a sound piece of 0.5 s"));
  EXPECT_THAT(summary.left_out[1].second, HasSubstr("which way is up"));
}

TEST(MotionLibrary, WhatIsNotThereIsAnError) {
  const TemporaryFolder folder;
  FileErrorOf("nowhere", [&] { LoadMotionLibrary({folder.File("nowhere")}); });
  MotionLibraryOptions options;
  options.split_path = folder.File("no_split.txt");
  FileErrorOf("no_split.txt", [&] { LoadMotionLibrary({folder.File("")}, options); });
  options = {};
  options.max_fps = 0;
  EXPECT_THROW(LoadMotionLibrary({folder.File("")}, options), std::invalid_argument);
}

TEST(FilesBelow, SortedThroughFoldersAndAFileIsItself) {
  const TemporaryFolder folder;
  for (const char* name : {"z.txt", "a/y.txt", "a/b/x.txt"}) WriteText(folder.File(name), "");
  EXPECT_THAT(FilesBelow(folder.File("")),
              ElementsAre(folder.File("a/b/x.txt"), folder.File("a/y.txt"), folder.File("z.txt")));
  EXPECT_THAT(FilesBelow(folder.File("z.txt")), ElementsAre(folder.File("z.txt")));
}

TEST(MotionSplit, TheLongestNameThatFitsCounts) {
  const MotionSplit split = MotionSplitFromText("05_02 walk train\nbvh/05_02 dance test\n", "split");
  std::string name;
  EXPECT_EQ(split.Find("cmu/bvh/05_02.bvh.gz", &name)->motion_class, "dance");
  EXPECT_EQ(name, "bvh/05_02");
  EXPECT_EQ(split.Find("amc/05_02.amc")->motion_class, "walk");
  EXPECT_EQ(split.Find("05_02")->motion_class, "walk");
  EXPECT_EQ(split.Find("otherbvh/05_02.bvh")->motion_class, "walk") << "names match whole parts of the path";
  EXPECT_EQ(split.Find("amc/105_02.amc"), nullptr);
  EXPECT_EQ(split.Find(""), nullptr);
}

TEST(MotionSplit, MalformedLinesNameFileAndLine) {
  const auto error = [](const std::string& text) {
    return FileErrorOf("some/split.txt: line 2",
                       [&] { MotionSplitFromText("a walk train\n" + text, "some/split.txt"); });
  };
  EXPECT_THAT(error("b walk"), HasSubstr("found 2 words"));
  EXPECT_THAT(error("b"), HasSubstr("found 1 words"));
  for (const char* detail : {"now", "fps=", "fps=0", "fps=60x", "fps=nan", "fps=1e9", "performer="}) {
    EXPECT_THAT(error(std::string("b walk train ") + detail), HasSubstr(std::string("found '") + detail + "'"));
  }
  EXPECT_THAT(error("b fly train"), HasSubstr("'fly', expected one of walk, run"));
  EXPECT_THAT(error("b walk maybe"), HasSubstr("'maybe', expected train or test"));
  EXPECT_THAT(error("a walk test"), HasSubstr("a second time"));
  EXPECT_THAT(error(std::string("b walk tr\0in", 12)), HasSubstr("found 'tr?in'"));
  EXPECT_THAT(error(std::string(100000, 'x')), HasSubstr("1 words"));
}

TEST(MotionSplit, PatternsGiveWayToNamesAndShorterPatternsToLonger) {
  const MotionSplit split =
      MotionSplitFromText("49_* dance train\n49_02 jump test\n49_1* walk train\na/49_* run train\n", "");
  EXPECT_EQ(split.Find("x/49_03.bvh.gz")->motion_class, "dance");
  EXPECT_EQ(split.Find("x/49_02.bvh.gz")->motion_class, "jump");
  EXPECT_EQ(split.Find("x/49_12.bvh")->motion_class, "walk");
  EXPECT_EQ(split.Find("a/49_12.bvh")->motion_class, "run") << "the longest part of the path that is named";
  EXPECT_EQ(split.Find("149_03.bvh"), nullptr);
}

TEST(MotionSplit, TellsPerformersAndRates) {
  const MotionSplit split =
      MotionSplitFromText("salsa_01 dance train performer=60\n143_04 run test fps=60 performer=a\n", "");
  EXPECT_EQ(split.Find("salsa_01.bvh")->performer, "60");
  EXPECT_EQ(split.Find("salsa_01.bvh")->fps, 0);
  EXPECT_EQ(split.Find("143_04.bvh")->fps, 60);
  EXPECT_EQ(split.Find("143_04.bvh")->performer, "a");
}

/// The split that ships, on the recordings it was made for.
class RealLibrary : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(motion_)) GTEST_SKIP() << "no recordings in " << motion_;
  }
  const std::string shared_ = SharedDir() + "/data";
  const std::string motion_ = shared_ + "/motion", aist_ = shared_ + "/aistpp/motions";
};

TEST_F(RealLibrary, EveryClipIsNamedAndNoPerformerIsInBoth) {
  MotionLibrarySummary summary;
  std::map<std::string, std::set<bool>> by_performer;
  std::set<const MotionSplitEntry*> found;
  double test_s = 0;
  std::set<std::string> test_classes;
  int clips = 0;
  summary = VisitMotionLibrary({motion_, aist_}, {}, [&](LibraryClip&& clip) {
    ++clips;
    by_performer[clip.source == "hdm05" ? clip.subject : clip.source.substr(0, 3) + " " + clip.subject].insert(
        clip.test);
    std::string name;
    const MotionSplitEntry* entry = BuiltinMotionSplit().Find(clip.name.substr(0, clip.name.find('#')), &name);
    ASSERT_NE(entry, nullptr) << clip.name;
    found.insert(entry);
    if (clip.test) {
      test_s += clip.motion.timestamps.back();
      test_classes.insert(clip.motion_class);
    }
    EXPECT_TRUE(clip.source != "hdm05" || clip.test) << clip.name << ": share-alike, nothing that ships learns from it";
    EXPECT_TRUE(!clip.name.starts_with("gBR") || clip.test);
    EXPECT_TRUE(!clip.name.starts_with("gJS") || clip.test);
    EXPECT_TRUE(clip.motion.poses.allFinite() && clip.motion.trans.allFinite()) << clip.name;
    EXPECT_LE(clip.motion.num_frames(), 60.1 * clip.motion.timestamps.back() + 1) << clip.name;
    const bool is_climb = clip.motion_class == "climb" || clip.motion_class == "sit" || clip.subject == "03";
    if (is_climb) {
      EXPECT_FALSE(clip.has_floor) << clip.name << ": a climbing frame, or uneven ground";
    } else if (clip.motion_class != "floor" && clip.source != "hdm05" && clip.name != "cmu_bvh_gym49/49_21.bvh.gz") {
      EXPECT_TRUE(clip.has_floor) << clip.name;
    }
    EXPECT_TRUE(!clip.source.starts_with("cmu") || std::abs(clip.floor_shift_m) < 0.15)
        << clip.name << ": the laboratory's floor is at 0, found at " << clip.floor_shift_m;
  });
  EXPECT_GE(clips, 80);
  EXPECT_THAT(summary.unnamed, IsEmpty());
  EXPECT_EQ(found.size(), BuiltinMotionSplit().entries().size()) << "the split names clips that are not there";
  for (const auto& [performer, halves] : by_performer) {
    if (performer == "cmu 01") continue;  // the exception that the split's header declares
    EXPECT_EQ(halves.size(), 1) << performer << " is in training and in testing";
  }
  for (const char* name : {"floor", "kick", "dance", "sit"}) EXPECT_EQ(test_classes.count(name), 1) << name;
  EXPECT_GT(test_s / summary.seconds, 0.20);
  EXPECT_LT(test_s / summary.seconds, 0.25);
}

}  // namespace
}  // namespace bodyloom::motion_library_test
