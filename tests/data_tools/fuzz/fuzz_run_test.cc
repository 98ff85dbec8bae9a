// SPDX-License-Identifier: Apache-2.0
/// Inputs of jobs other than weights, images and observations, without LibTorch: a run's config.json, the light, a
/// batch's manifest and records.
#include "tests/fuzz/fuzz_run_targets.h"

#include "tests/fuzz/run_mutations.h"

namespace bodyloom::fuzz::fuzz_run_test {
namespace {

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

}  // namespace
}  // namespace bodyloom::fuzz::fuzz_run_test
