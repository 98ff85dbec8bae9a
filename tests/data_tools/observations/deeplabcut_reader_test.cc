// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <gmock/gmock.h>

#include "data_tools/observations/load_detections.h"
#include "tests/data_tools/formats/expect_file_error.h"

namespace bodyloom::deeplabcut_reader_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kSingle =
    "scorer,net,net,net,net,net,net,net,net,net\n"
    "bodyparts,nose,nose,nose,LShoulder,LShoulder,LShoulder,tail,tail,tail\n"
    "coords,x,y,likelihood,x,y,likelihood,x,y,likelihood\n"
    "0,100.5,50,0.9,120,80,0.8,5,6,0.7\n"
    "1,101.5,51,0.25,,,,5,6,0.7\n"
    "3,103.5,53,1e-3,NaN,nan,0.9,5,6,0.7\n";

constexpr const char* kMulti =
    "scorer,net,net,net,net,net,net,net,net,net,net,net,net,net,net,net\n"
    "individuals,ann,ann,ann,ann,ann,ann,bob,bob,bob,bob,bob,bob,single,single,single\n"
    "bodyparts,nose,nose,nose,hip,hip,hip,nose,nose,nose,hip,hip,hip,ball,ball,ball\n"
    "coords,x,y,likelihood,x,y,likelihood,x,y,likelihood,x,y,likelihood,x,y,likelihood\n"
    "0,100,50,0.9,100,150,0.9,400,50,0.8,400,250,0.8,1,2,0.5\n"
    "1,400,50,0.9,400,150,0.9,100,50,0.8,100,250,0.8,1,2,0.5\n"
    "2,,,,,,,100,51,0.8,100,251,0.8,1,2,0.5\n";

KeypointSequence Load(const std::string& text, int person = 0) {
  LoadDetectionsOptions options;
  options.person = person;
  options.fps = 10;
  return DetectionsFromBytes(text, "d.csv", options);
}

TEST(DeepLabCut, OnePersonByNames) {
  const std::string single = kSingle;
  std::string windows = single;
  for (size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) windows.replace(at, 1, "\r\n");
  for (const std::string& text : {single, "\xEF\xBB\xBF" + single, windows}) {
    const KeypointSequence sequence = Load(text);
    EXPECT_THAT(sequence.names, ElementsAre("nose", "left_shoulder", "tail"));
    ASSERT_EQ(sequence.num_frames(), 4);
    EXPECT_EQ(sequence.at(0, 0).x, 100.5F);
    EXPECT_EQ(sequence.at(0, 1).y, 80);
    EXPECT_EQ(sequence.at(0, 1).confidence, 0.8F);
    EXPECT_EQ(sequence.at(1, 0).confidence, 0.25F);
    EXPECT_EQ(sequence.at(1, 1).confidence, 0) << "empty cells";
    EXPECT_EQ(sequence.at(2, 0).confidence, 0) << "frame 2 has no row";
    EXPECT_EQ(sequence.at(3, 0).x, 103.5F);
    EXPECT_EQ(sequence.at(3, 1).confidence, 0) << "NaN";
    EXPECT_NEAR(sequence.timestamps[3], 0.3, 1e-12);
  }
}

TEST(DeepLabCut, IndividualsAreIdentities) {
  const KeypointSequence bob = Load(kMulti), ann = Load(kMulti, 1);
  EXPECT_THAT(bob.names, ElementsAre("nose", "mid_hip")) << "the ball belongs to nobody";
  EXPECT_EQ(bob.at(0, 0).x, 400);
  EXPECT_EQ(bob.at(1, 0).x, 100) << "they change places";
  EXPECT_EQ(bob.at(2, 1).y, 251);
  EXPECT_EQ(ann.at(0, 1).y, 150);
  EXPECT_EQ(ann.at(1, 0).x, 400);
  EXPECT_EQ(ann.at(2, 0).confidence, 0);
}

TEST(DeepLabCut, LabelledFramesHaveNoLikelihood) {
  const KeypointSequence sequence = Load(
      "scorer,,,me,me\nbodyparts,,,nose,nose\ncoords,,,x,y\n"
      "labeled-data,video,img0007.png,10,20\nlabeled-data,video,img0009.png,30,40\n");
  ASSERT_EQ(sequence.num_frames(), 2) << "every second frame is no gap";
  EXPECT_EQ(sequence.at(1, 0).x, 30);
  EXPECT_EQ(sequence.at(1, 0).confidence, 1);
  EXPECT_NEAR(sequence.timestamps[0], 0.7, 1e-12);
}

TEST(DeepLabCut, MalformedFilesAreErrors) {
  const auto error = [](const std::string& from, const std::string& to, const char* text = kSingle) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return FileErrorOf("d.csv", [&] { Load(changed); });
  };
  EXPECT_THAT(error("100.5", "left"), HasSubstr("line 4: found 'left', expected a number or nothing"));
  EXPECT_THAT(error(",0.25", ""), HasSubstr("line 5: 9 cells, expected 10"));
  EXPECT_THAT(error("coords,x,y", "coords,x,z"), HasSubstr("line 3: found 'z', expected x, y or likelihood"));
  EXPECT_THAT(error("bodyparts,nose", "parts,nose"), HasSubstr("line 2: found 'parts'"));
  EXPECT_THAT(error("bodyparts,nose", "bodyparts,nose,nose"), HasSubstr("line 3: 10 cells, expected as many"));
  EXPECT_THAT(error("3,103.5", "1,103.5"), HasSubstr("frame number 1 occurs twice"));
  EXPECT_THAT(error("coords", "scorer"), HasSubstr("found '0', expected scorer"));
  EXPECT_THAT(FileErrorOf("d.csv", [] { Load("scorer,a,a\nbodyparts,paw,paw\ncoords,x,y\n0,1,2\n"); }),
              HasSubstr("body parts paw, none of which is a person's"));
  EXPECT_THAT(FileErrorOf("d.csv", [] { Load("scorer,a\nbodyparts,nose"); }), HasSubstr("the file ends"));
  EXPECT_THAT(FileErrorOf("d.csv", [] { Load("scorer,a,a\nbodyparts,nose,nose\ncoords,x,y\n"); }),
              HasSubstr("no person in any of 0 frames"));
  // Many individuals, each with a part of its own, are more landmarks than the file has numbers.
  std::string scorer = "scorer", individuals = "individuals", parts = "bodyparts", coords = "coords";
  for (int i = 0; i < 1000; ++i) {
    scorer += ",a", individuals += ",i" + std::to_string(i), parts += ",nose" + std::to_string(i), coords += ",x";
  }
  EXPECT_THAT(FileErrorOf("d.csv", [&] { Load(scorer + "\n" + individuals + "\n" + parts + "\n" + coords + "\n"); }),
              HasSubstr("1000 individuals and 1000 body parts, expected the same"));
  const std::string text = kMulti;
  for (size_t n = 0; n < text.size(); n += 5) {
    try {  // a text that is cut between rows is a shorter clip
      EXPECT_LE(Load(text.substr(0, n)).num_frames(), 3);
    } catch (const std::runtime_error& caught) {
      EXPECT_THAT(caught.what(), HasSubstr("d.csv"));
    }
  }
}

}  // namespace
}  // namespace bodyloom::deeplabcut_reader_test
