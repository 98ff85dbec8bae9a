// SPDX-License-Identifier: Apache-2.0
#include "geometry/base/mailbox.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace bodyloom::mailbox_test {
namespace {

TEST(Mailbox, KeepsTheNewestInOrderAndCountsTheRest) {
  Mailbox<int> box(2);
  for (const int item : {1, 2, 3, 4, 5}) EXPECT_TRUE(box.Put(item));
  EXPECT_EQ(box.num_dropped(), 3);
  EXPECT_EQ(box.Take(), 4);
  EXPECT_EQ(box.Take(), 5);
  EXPECT_TRUE(box.Put(6));
  box.Close();
  EXPECT_FALSE(box.Put(7));
  EXPECT_EQ(box.Take(), 6);
  EXPECT_EQ(box.Take(), std::nullopt);
  EXPECT_EQ(box.num_dropped(), 3);
}

TEST(Mailbox, ThatWaitsLosesNothing) {
  constexpr int kItems = 5000;
  Mailbox<int> box(3, WhenFull::kWait);
  std::thread writer([&] {
    for (int i = 0; i < kItems; ++i) EXPECT_TRUE(box.Put(i));
    box.Close();
  });
  int expected = 0;
  while (const std::optional<int> item = box.Take()) EXPECT_EQ(*item, expected++);
  writer.join();
  EXPECT_EQ(expected, kItems);
  EXPECT_EQ(box.num_dropped(), 0);
}

TEST(Mailbox, ThatDropsNeverReordersNorRepeats) {
  constexpr int kItems = 20'000;
  Mailbox<std::unique_ptr<int>> box(1);
  std::thread writer([&] {
    for (int i = 0; i < kItems; ++i) box.Put(std::make_unique<int>(i));
    box.Close();
  });
  int last = -1, taken = 0;
  while (const auto item = box.Take()) {
    EXPECT_GT(**item, last);
    last = **item;
    ++taken;
  }
  writer.join();
  EXPECT_EQ(last, kItems - 1);  // the newest is never lost
  EXPECT_EQ(taken + box.num_dropped(), kItems);
}

TEST(Mailbox, ClosingWakesWhoeverWaits) {
  Mailbox<int> full(1, WhenFull::kWait), empty(1);
  full.Put(1);
  std::thread writer([&] { EXPECT_FALSE(full.Put(2)); });
  std::thread reader([&] { EXPECT_EQ(empty.Take(), std::nullopt); });
  full.Close();
  empty.Close();
  writer.join();
  reader.join();
}

}  // namespace
}  // namespace bodyloom::mailbox_test
