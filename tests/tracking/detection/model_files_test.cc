// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/model_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"

namespace bodyloom::model_files_test {
namespace {

namespace fs = std::filesystem;

TEST(ModelFiles, WhatTheUserSaysIsWhereItLooks) {
  EXPECT_EQ(ModelFolders("mine", "theirs", "/usr/bin/bodyloom"), std::vector<std::string>{"mine"});
  EXPECT_EQ(ModelFolders("", "theirs", "/usr/bin/bodyloom"), std::vector<std::string>{"theirs"});
}

TEST(ModelFiles, BesideAnInstalledProgram) {
  EXPECT_EQ(ModelFolders("", "", "/nowhere/usr/bin/bodyloom"),
            std::vector<std::string>{"/nowhere/usr/share/bodyloom/models"});
}

TEST(ModelFiles, BesideAPythonModule) {
  EXPECT_EQ(ModelFolders("", "", "/nowhere/bin/python3", "/site/bodyloom/_bodyloom.so"),
            (std::vector<std::string>{"/nowhere/share/bodyloom/models", "/site/bodyloom/models"}));
  EXPECT_EQ(ModelFolders("mine", "", "/nowhere/bin/python3", "/site/bodyloom/_bodyloom.so"),
            std::vector<std::string>{"mine"});
}

TEST(ModelFiles, AboveABuild) {
  const TemporaryFolder folder;
  fs::create_directories(folder.File("build/release/apps"));
  WriteFileAtomically(folder.File("build/release/CMakeCache.txt"), "");
  EXPECT_EQ(
      ModelFolders("", "", folder.File("build/release/apps/bodyloom")),
      (std::vector<std::string>{folder.File("build/release/share/bodyloom/models"), folder.File("build/models")}));
}

TEST(ModelFiles, FoundOrMissing) {
  const TemporaryFolder folder;
  const std::string home = folder.File("");
  WriteFileAtomically(folder.File("pose_landmark_lite.tflite"), "x");
  EXPECT_TRUE(fs::equivalent(FindModelFile(kPoseLandmarkLiteFile, home), folder.File("pose_landmark_lite.tflite")));
  const std::string message = FileErrorOf(kPoseLandmarkFullFile, [&] { FindModelFile(kPoseLandmarkFullFile, home); });
  for (const char* part : {home.c_str(), "./dev models", "--models DIR", "BODYLOOM_MODELS"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  fs::create_directories(folder.File("pose_landmark_heavy.tflite"));
  FileErrorOf(kPoseLandmarkHeavyFile, [&] { FindModelFile(kPoseLandmarkHeavyFile, home); });
}

// ./dev fetches these.
TEST(ModelFiles, AreThoseOfTheList) {
  std::ifstream list(SourceDir() + "/cmake/models.txt");
  std::vector<std::string> names;
  for (std::string line; std::getline(list, line);) {
    if (line.rfind("file ", 0) == 0) names.push_back(line.substr(6, line.find(' ', 6) - 6));
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{kPoseDetectorFile, kPoseLandmarkLiteFile, kPoseLandmarkFullFile,
                                      kPoseLandmarkHeavyFile, kHandRegionFile, kHandLandmarkFile, kFaceLandmarkFile}));
}

}  // namespace
}  // namespace bodyloom::model_files_test
