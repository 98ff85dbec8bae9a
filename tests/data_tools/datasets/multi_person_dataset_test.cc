// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/multi_person_dataset.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <set>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/people/make_multi_person_dataset.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::multi_person_dataset_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(MultiPersonDataset, AClipsNameSaysItsActionAndItsView) {
  EXPECT_EQ(PlaceOfClip("p000/a0_v12").action, "p000/a0");
  EXPECT_EQ(PlaceOfClip("p000/a0_v12").view, "v12");
  for (const char* other : {"p000/walk", "p000/a0_v", "p000/a_v1b", "_v1"}) {
    EXPECT_EQ(PlaceOfClip(other).action, other);
    EXPECT_EQ(PlaceOfClip(other).view, other);
  }
}

MakeMultiPersonDatasetOptions Small() {
  MakeMultiPersonDatasetOptions options;
  options.people = 3, options.actions = 2, options.views = 2, options.frames = 2, options.every = 5;
  options.size_px = 64, options.samples = 1;
  options.test_share = 0.34;
  options.num_threads = 2;
  return options;
}

MakeMultiPersonDatasetSummary MakeSmall(const std::string& path,
                                        const MakeMultiPersonDatasetOptions& options = Small()) {
  return MakeMultiPersonDataset(path, BuiltinBody(), {DemoMotion(BuiltinBody(), 60, 30)}, options);
}

TEST(MultiPersonDataset, PeopleAreDividedAndStayThemselves) {
  const TemporaryFolder folder;
  const std::string path = folder.File("people");
  const MakeMultiPersonDatasetSummary summary = MakeSmall(path);
  EXPECT_TRUE(summary.finished);
  EXPECT_EQ(summary.images, 24);
  EXPECT_EQ(summary.pairs, 3 * 8 * 7);
  const MultiPersonDataset set = ReadMultiPersonDataset(path);
  ASSERT_EQ(set.people.size(), 3U);
  EXPECT_EQ(set.size, 64);
  EXPECT_FALSE(set.people[0].test || set.people[1].test);
  EXPECT_TRUE(set.people[2].test);
  std::set<std::vector<double>> shapes;
  for (const DatasetPerson& person : set.people) {
    ASSERT_EQ(person.clips.size(), 4U);
    std::set<std::vector<double>> of_person;
    for (const std::string& clip : person.clips) {
      const SinglePersonDataset frames((fs::path(path) / clip).string());
      EXPECT_EQ(frames.info().num_frames, 2);
      const Track track = frames.track();
      EXPECT_NEAR(track.motion.timestamps[1] - track.motion.timestamps[0], 5 / 30.0, 1e-9);
      const Eigen::VectorXd& betas = track.motion.betas;
      of_person.insert({betas.begin(), betas.end()});
      // Someone is there, whole: nothing of the person at the image's boundary.
      const PersonFrame frame = frames.Read(1);
      int inside = 0;
      for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
          if (frame.labels.pixel(x, y)[0] == 0) continue;
          ++inside;
          EXPECT_TRUE(x > 0 && y > 0 && x < 63 && y < 63) << clip;
        }
      }
      EXPECT_GT(inside, 150) << clip;
    }
    EXPECT_EQ(of_person.size(), 1U);
    shapes.insert(*of_person.begin());
  }
  EXPECT_EQ(shapes.size(), 3U);
}

TEST(MultiPersonDataset, IsTheSameForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  MakeMultiPersonDatasetOptions options = Small();
  options.people = 2, options.views = 1;
  for (const int threads : {1, 3}) {
    options.num_threads = threads;
    MakeSmall(folder.File(std::to_string(threads)), options);
  }
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder.File("1"))) {
    if (!entry.is_regular_file()) continue;
    const fs::path relative = fs::relative(entry.path(), folder.File("1"));
    EXPECT_EQ(ReadFileBytes(entry.path().string()), ReadFileBytes((folder.File("3") / relative).string())) << relative;
    ++files;
  }
  EXPECT_EQ(files, 1 + 4 * (2 + 4 * 2));
}

TEST(MultiPersonDataset, AStoppedOneIsNoSet) {
  const TemporaryFolder folder;
  MakeMultiPersonDatasetOptions options = Small();
  options.people = 2, options.actions = 3, options.views = 1, options.num_threads = 1;
  MakeSmall(folder.File("people"), options);
  options.progress = [](double done) { return done > 0.4; };
  EXPECT_FALSE(MakeSmall(folder.File("people"), options).finished);
  EXPECT_THAT(FileErrorOf("people.json", [&] { ReadMultiPersonDataset(folder.File("people")); }),
              HasSubstr("written last"));
}

TEST(MultiPersonDataset, BrokenSetsNameThePlace) {
  const TemporaryFolder folder;
  const std::string path = folder.File("people");
  MakeMultiPersonDatasetOptions options = Small();
  options.people = 2, options.actions = 1, options.views = 1;
  MakeSmall(path, options);
  const std::string json = ReadFileBytes(path + "/people.json");
  for (size_t n = 0; n + 2 < json.size(); ++n) {
    WriteFileAtomically(path + "/people.json", json.substr(0, n));
    FileErrorOf("people.json", [&] { ReadMultiPersonDataset(path); });
  }
  const auto with = [&](const std::string& from, const std::string& to, const std::string& where = "people.json") {
    std::string changed = json;
    const size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    WriteFileAtomically(path + "/people.json", changed);
    return FileErrorOf(where, [&] { ReadMultiPersonDataset(path); });
  };
  EXPECT_THAT(with("people set", "crowd"), HasSubstr("expected \"bodyloom people set\""));
  EXPECT_THAT(with("\"version\": 1", "\"version\": 3"), HasSubstr("version"));
  EXPECT_THAT(with("\"size\": 64", "\"size\": -64"), HasSubstr("1 to 16384"));
  EXPECT_THAT(with("\"train\"", "\"both\""), HasSubstr("\"train\" or \"test\""));
  EXPECT_THAT(with("p000/a0_v0", "p000/../../elsewhere"), HasSubstr("below the dataset"));
  EXPECT_THAT(with("p000/a0_v0", "/etc"), HasSubstr("below the dataset"));
  EXPECT_THAT(with("p000/a0_v0", "p000/a9_v0", "p000/a9_v0/person.json"), HasSubstr("names the clip"));
  EXPECT_THAT(with("\"p001\"", "\"p000\""), HasSubstr("nobody else"));
}

TEST(MultiPersonDataset, MakingChecksItsContract) {
  const TemporaryFolder folder;
  const auto make = [&](auto change) {
    MakeMultiPersonDatasetOptions options = Small();
    change(&options);
    MakeSmall(folder.File("people"), options);
  };
  EXPECT_THROW(make([](auto* o) { o->people = 0; }), std::invalid_argument);
  EXPECT_THROW(make([](auto* o) { o->every = 100; }), std::invalid_argument) << "the motion is shorter";
  EXPECT_THROW(make([](auto* o) { o->elevation_low_deg = 30; }), std::invalid_argument);
  EXPECT_THROW(make([](auto* o) { o->test_share = 1; }), std::invalid_argument);
  EXPECT_THROW(MakeMultiPersonDataset(folder.File("people"), BuiltinBody(), {}, Small()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::multi_person_dataset_test
