// SPDX-License-Identifier: Apache-2.0
/// The runtime of LibTorch: version, threads, and the matrix library behind it, with a warning where that one is slow.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

struct NeuralRuntime {
  std::string torch_version;  ///< "1.13.1"
  int num_cores = 0;          ///< cores this process may use
  int num_threads = 0;        ///< threads LibTorch uses inside one operation
  std::string blas_path;      ///< shared object that provides sgemm_, links resolved; empty when linked statically
  std::string blas_core;      ///< the processor OpenBLAS takes this one for; empty for other libraries
  std::vector<std::string> warnings;
};

/// Lets LibTorch use `num_threads` threads (0: every core this process may use; LibTorch itself starts with one on some
/// machines) and reports what it runs on. Call once, before any tensor work. Throws std::invalid_argument when
/// num_threads is negative.
NeuralRuntime StartNeuralRuntime(int num_threads = 0);

/// Renderers and trainers made from now on live on "cpu" or "cuda" (the first card), all of a process on the same.
/// Throws std::invalid_argument for another name, std::runtime_error when there is no such device here.
void UseNeuralDevice(const std::string& device);

/// Why matrix products will be slow with this library on this processor and what to do, or "" when there is nothing to
/// say. Measured on an AVX-512 processor, 2048² sgemm on two threads: reference BLAS 6 GFLOP/s, ATLAS 35, OpenBLAS that
/// takes the processor for a "Prescott" 77, the same told that it is a SkylakeX 412.
std::string BlasAdvice(const std::string& blas_path, const std::string& blas_core, bool cpu_has_avx2,
                       bool cpu_has_avx512);

/// One fact a line, warnings last.
std::string ToText(const NeuralRuntime& runtime);

}  // namespace bodyloom
