// SPDX-License-Identifier: Apache-2.0
#include "neural/base/runtime.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/cuda.h>

#include <stdexcept>
#include <string>
#include <thread>

namespace bodyloom::runtime_test {
namespace {

using ::testing::HasSubstr;

TEST(NeuralRuntime, UsesEveryCoreByDefault) {
  const NeuralRuntime runtime = StartNeuralRuntime();
  EXPECT_EQ(runtime.num_threads, static_cast<int>(std::thread::hardware_concurrency()));
  EXPECT_THAT(runtime.torch_version, ::testing::StartsWith("1."));
}

TEST(NeuralRuntime, UsesAsManyThreadsAsTold) { EXPECT_EQ(StartNeuralRuntime(1).num_threads, 1); }

TEST(NeuralRuntime, RefusesNegativeThreads) { EXPECT_THROW(StartNeuralRuntime(-1), std::invalid_argument); }

TEST(NeuralRuntime, TextNamesVersionThreadsAndWarnings) {
  NeuralRuntime runtime;
  runtime.torch_version = "9.8.7";
  runtime.num_cores = 6;
  runtime.num_threads = 5;
  runtime.blas_path = "/lib/some/libblas.so";
  runtime.warnings = {"too slow"};
  EXPECT_EQ(ToText(runtime),
            "LibTorch 9.8.7\nthreads  5 of 6 cores\nBLAS     /lib/some/libblas.so\nwarning: too slow\n");
}

TEST(BlasAdvice, SpeaksUpAboutAMisjudgedProcessor) {
  EXPECT_THAT(BlasAdvice("/usr/lib/libopenblas.so.0", "Prescott", true, true), HasSubstr("OPENBLAS_CORETYPE=SkylakeX"));
  EXPECT_THAT(BlasAdvice("/usr/lib/libopenblas.so.0", "Prescott", true, false), HasSubstr("OPENBLAS_CORETYPE=Haswell"));
}

TEST(BlasAdvice, IsSilentWhenTheProcessorWasRecognised) {
  EXPECT_EQ(BlasAdvice("/usr/lib/libopenblas.so.0", "SkylakeX", true, true), "");
  EXPECT_EQ(BlasAdvice("/usr/lib/libopenblas.so.0", "Zen", true, false), "");
  EXPECT_EQ(BlasAdvice("/usr/lib/libopenblas.so.0", "Prescott", false, false), "") << "an old processor is what it is";
}

TEST(BlasAdvice, NamesAFasterLibrary) {
  EXPECT_THAT(BlasAdvice("/usr/lib/x86_64-linux-gnu/blas/libblas.so.3.11.0", "", true, true),
              HasSubstr("reference BLAS"));
  EXPECT_THAT(BlasAdvice("/usr/lib/x86_64-linux-gnu/atlas/libblas.so.3.10.3", "", true, true), HasSubstr("ATLAS"));
  EXPECT_EQ(BlasAdvice("/usr/lib/x86_64-linux-gnu/blis-openmp/libblas.so.4", "", true, true), "");
}

TEST(NeuralRuntime, ACardThatIsNotThereIsSaid) {
  EXPECT_THROW(UseNeuralDevice("gpu"), std::invalid_argument);
  if (torch::cuda::is_available()) GTEST_SKIP() << "there is a CUDA card";
  try {
    UseNeuralDevice("cuda");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no CUDA card"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace bodyloom::runtime_test
