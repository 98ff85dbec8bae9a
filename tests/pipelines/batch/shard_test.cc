// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/shard.h"

#include <gtest/gtest.h>

#include <map>

#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {
namespace {

TEST(Shard, EveryClipBelongsToOneShardAndNoneIsLargerThanAnotherByTwo) {
  for (int count = 1; count <= 17; ++count) {
    for (const size_t clips : {0UL, 1UL, 5UL, 16UL, 17UL, 100UL}) {
      size_t least = clips, most = 0;
      std::vector<int> owners(clips, 0);
      for (int i = 0; i < count; ++i) {
        size_t own = 0;
        for (size_t k = 0; k < clips; ++k) {
          if (Shard{i, count}.Holds(k)) {
            ++owners[k];
            ++own;
          }
        }
        least = std::min(least, own);
        most = std::max(most, own);
      }
      EXPECT_EQ(owners, std::vector<int>(clips, 1)) << clips << " clips in " << count << " shards";
      EXPECT_LE(most - least, 1u);
    }
  }
}

TEST(Shard, IsReadFromText) {
  const Shard shard = ShardFromText("2/6");
  EXPECT_EQ(shard.index, 2);
  EXPECT_EQ(shard.count, 6);
  EXPECT_EQ(ShardFromText("0/1").count, 1);
  for (const char* text : {"", "/", "6", "6/6", "7/6", "-1/6", "1/0", "0/0", "1 /6", "1/6 ", "+1/6", "a/b", "1/6/2",
                           "1/", "/6", "0x1/6", "1.0/6", "0/1000001", "0/99999999999"}) {
    EXPECT_THROW(ShardFromText(text), RequestError) << text;
  }
}

using Variables = std::map<std::string, std::string>;

std::optional<Shard> FromSlurm(const Variables& variables) {
  return ShardFromSlurm([&](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

Variables Array(int id, int least, int most, int step, int count) {
  return {{"SLURM_ARRAY_TASK_ID", std::to_string(id)},
          {"SLURM_ARRAY_TASK_MIN", std::to_string(least)},
          {"SLURM_ARRAY_TASK_MAX", std::to_string(most)},
          {"SLURM_ARRAY_TASK_STEP", std::to_string(step)},
          {"SLURM_ARRAY_TASK_COUNT", std::to_string(count)}};
}

TEST(Shard, TasksOfASlurmArrayAreItsShardsWhateverTheyAreNumbered) {
  // --array=0-5, 1-6, 10-20:2, 3
  for (const auto& [least, step, count] : {std::tuple(0, 1, 6), {1, 1, 6}, {10, 2, 6}, {3, 1, 1}}) {
    for (int i = 0; i < count; ++i) {
      const std::optional<Shard> shard =
          FromSlurm(Array(least + step * i, least, least + step * (count - 1), step, count));
      ASSERT_TRUE(shard);
      EXPECT_EQ(shard->index, i);
      EXPECT_EQ(shard->count, count);
    }
  }
}

TEST(Shard, OutsideAnArrayThereIsNone) {
  EXPECT_FALSE(FromSlurm({}));
  EXPECT_FALSE(FromSlurm({{"SLURM_JOB_ID", "7"}}));
  EXPECT_FALSE(FromSlurm({{"SLURM_ARRAY_TASK_ID", "7"}}));
  EXPECT_EQ(FromSlurm({{"SLURM_ARRAY_TASK_ID", "2"}, {"SLURM_ARRAY_TASK_COUNT", "4"}})->index, 2);
}

TEST(Shard, AnUnevenArrayIsRefusedInEveryTask) {
  for (const int id : {1, 3, 7}) EXPECT_THROW(FromSlurm(Array(id, 1, 7, 1, 3)), RequestError) << id;  // --array=1,3,7
  EXPECT_THROW(FromSlurm(Array(4, 0, 6, 3, 2)), RequestError);
  Variables words = Array(1, 0, 5, 1, 6);
  words["SLURM_ARRAY_TASK_ID"] = "one";
  EXPECT_THROW(FromSlurm(words), RequestError);
  words["SLURM_ARRAY_TASK_ID"] = "";
  EXPECT_THROW(FromSlurm(words), RequestError);
  EXPECT_THROW(FromSlurm(Array(1, 0, 5, 0, 6)), RequestError);
  EXPECT_THROW(FromSlurm(Array(9, 0, 5, 1, 6)), RequestError);
}

TEST(Shard, WhatTheUserSaysComesFirst) {
  const auto in_array = [](const char* name) -> const char* {
    return std::string(name) == "SLURM_ARRAY_TASK_ID"      ? "1"
           : std::string(name) == "SLURM_ARRAY_TASK_COUNT" ? "4"
                                                           : nullptr;
  };
  EXPECT_EQ(ChooseShard("0/2", in_array).count, 2);
  EXPECT_EQ(ChooseShard("", in_array).count, 4);
  EXPECT_EQ(ChooseShard("", [](const char*) -> const char* { return nullptr; }).count, 1);
}

}  // namespace
}  // namespace bodyloom
